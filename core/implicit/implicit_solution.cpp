// How an implicit step is solved: Newton's method, friction and faces that settle, steps that are cut, and
// what is said where there is no equilibrium.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/implicit/implicit_integrator.hpp"
#include "core/particle_range.hpp"
#include "core/step/stepper.hpp"

namespace mpm::core {

namespace {

/// Steps with fewer iterations are easy: the next one may be longer.
constexpr int easy = 8;
constexpr double growth = 1.5;
/// A quasi-static run's steps, and a dynamic step over the largest explicit one, where the input names none.
constexpr double default_load_steps = 20, default_ratio = 20;
/// The smallest step over the given one, where the input names none.
constexpr double default_smallest = 1.0 / 1024;
/// Forces of this strain are rounding errors: a body without loads is in equilibrium.
constexpr double rounding = 1e-13;
/// Friction has settled where it changes by less than this part of what it may be; and how often a step is
/// solved for that.
constexpr double settled_friction = 1e-3;
constexpr int many_frictions = 10, most_frictions = 40;
/// The stiffness of a cell in shear over that in compression, about.
constexpr double shear_share = 0.25;
/// Solutions for what bodies enter each other at faces end where the last one has left more than this part of
/// it, or after so many.
constexpr double slow = 0.2;
constexpr int most_violations = 4;

/// Between the residuals of two solutions of a step.
constexpr double next_solution = -1;

std::string norms_in_words(std::span<const double> norms) {
  std::string words;
  for (const double norm : norms) {
    if (!words.empty()) words += ' ';
    words += norm == next_solution ? "|" : fmt::format("{:.2e}", norm);
  }
  return words;
}

double length_of(const ImplicitInput& input, const Model& model) {
  if (input.time_step) return *input.time_step;
  const double explicit_step = default_ratio * model.clock.first_critical_dt;
  const bool by_loads = input.quasistatic() || !std::isfinite(explicit_step);
  const double length = by_loads ? model.scene->solution.end_time / default_load_steps : explicit_step;
  return std::max(std::min(length, input.max_step.value_or(length)), input.min_step.value_or(0));
}

}  // namespace

const char* ImplicitIntegrator::name_of_solution() const {
  return input_.linearised() ? "linear system" : "Newton's method";
}

double ImplicitIntegrator::next_step(const Clock& clock) const {
  const double length = length_of(input_, model_);
  return clock.next_dt > 0 ? std::min(clock.next_dt, input_.max_step.value_or(length)) : length;
}

/// Nodes go on with their velocity; those of a linearised step begin at their place, where it is linearised.
/// What walls hold is there, and with products by differences of residuals everything that is held.
std::vector<double> ImplicitIntegrator::first_guess(bool at_rest) const {
  std::vector<double> u(3 * state_.size());
  for (std::size_t i = 0; i < state_.size(); ++i) {
    for (int a = 0; a < 3; ++a) {
      const std::size_t at = 3 * i + static_cast<std::size_t>(a);
      const double to = unknowns_.held_displacements()[at];
      if (held(i, a) && (to == 0 || input_.matrix_free))
        u[at] = to;
      else
        u[at] = at_rest ? 0 : free_motion(state_[i], a);
    }
  }
  return u;
}

bool ImplicitIntegrator::overstrains(std::span<const double> u) {
  if (ranks_.any(!map_forces(u))) return true;
  StepMotion motion = passes_->motion_of(displacements_);
  motion.combine(ranks_);
  return motion.overstrains();
}

std::string ImplicitIntegrator::objection(const NewtonReport& report, std::span<const double> u) {
  if (!report.converged) return report.reason;
  distribute(u);
  StepMotion motion = passes_->motion_of(displacements_);
  motion.combine(ranks_);
  std::vector<std::string> names;
  for (const Body& body : model_.bodies) names.push_back(body.name);
  return motion.objection(names);
}

NewtonReport ImplicitIntegrator::solve_once(std::span<double> u, const NewtonOptions& options) {
  const NewtonReport report = solver_.solve(*this, u, options);
  ++solves_;
  total_.iterations += report.iterations;
  total_.linear_iterations += report.linear_iterations;
  total_.structure_seconds += report.structure_seconds;
  total_.residual_seconds += report.residual_seconds;
  total_.jacobian_seconds += report.jacobian_seconds;
  total_.setup_seconds += report.setup_seconds;
  total_.linear_seconds += report.linear_seconds;
  return report;
}

void ImplicitIntegrator::solve_again(std::span<double> u, const NewtonOptions& options,
                                     NewtonReport& report) {
  const NewtonReport next = solve_once(u, options);
  report.converged = next.converged;
  report.reason = next.reason;
  report.linear_iterations += next.linear_iterations;
  report.iterations = std::max(report.iterations, next.iterations);  // of a solution
  report.norms.push_back(next_solution);
  report.norms.insert(report.norms.end(), next.norms.begin(), next.norms.end());
}

/// Solves again with the friction that the last solution allows, until it no longer changes.
void ImplicitIntegrator::settle_friction(std::span<double> u, const NewtonOptions& options,
                                         NewtonReport& report) {
  double relaxation = shear_share, last = 0;
  for (int i = 0; report.converged; ++i) {
    distribute(u);
    ContactSpring::Changes mine;
    contact_->find_friction(relaxation, mine);
    if (faces_) faces_->find_friction(displacements_, relaxation, mine);
    ExactSum sums[2] = {mine.change, mine.most};
    ranks_.sum(std::span(sums));
    const double change = sums[0].value();
    if (change <= settled_friction * sums[1].value()) return;
    // Softer bodies than a cell of the material overshoot; and what goes to and fro settles by ever less.
    if (i > 1 && change > last) relaxation *= 0.5;
    if (i > many_frictions) relaxation *= 0.8;
    last = change;
    if (i == most_frictions) {
      report.converged = false;
      report.reason = "friction does not settle";
      return;
    }
    contact_->take_friction();
    if (faces_) faces_->take_friction();
    solve_again(u, options, report);
  }
}

/// Solves again from the forces that the last solution has at faces, until bodies hardly enter each other
/// there; and with friction.
void ImplicitIntegrator::settle_contact(std::span<double> u, const NewtonOptions& options,
                                        NewtonReport& report) {
  const bool rubs = contact_ && contact_->rubs();
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0;; ++i) {
    if (rubs) settle_friction(u, options, report);
    if (!report.converged) return;
    if (!faces_) break;
    distribute(u);
    const double violation = faces_->violation(displacements_);
    if (violation <= BodyFaces::most_violation || violation > slow * last || i == most_violations) break;
    last = violation;
    faces_->take_forces(displacements_);
    solve_again(u, options, report);
  }
  if (rubs) contact_->keep_friction();
}

void ImplicitIntegrator::solve() {
  const double length = length_of(input_, model_);
  const double no_force = rounding * held_diagonal_ * model_.grid->geometry().smallest_cell();
  const NewtonOptions options{input_.relative_tolerance, input_.absolute_tolerance.value_or(no_force),
                              input_.max_newton, input_.matrix_free, input_.linearised()};
  const double planned = next_step(model_.clock), first = model_.clock.dt;  // which EndTime may have cut
  const double smallest = input_.min_step.value_or(default_smallest * length);
  std::string cuts;
  bool at_rest = input_.linearised();
  for (;;) {
    std::vector<double> u = first_guess(at_rest);
    NewtonReport report = solve_once(u, options);
    if (faces_ || (contact_ && contact_->rubs())) settle_contact(u, options, report);
    const std::string why = objection(report, u);
    const double dt = model_.clock.dt;
    const std::string norms = norms_in_words(report.norms);
    if (why.empty()) {
      solution_ = std::move(u);
      words_ =
          fmt::format("step {}: time {:.6g}, length {:.4g}; {} unknowns; residual {}; {} linear iterations{}",
                      model_.clock.step + 1, model_.clock.time + dt, dt, 3 * unknowns_.all(), norms,
                      report.linear_iterations, cuts);
      double& next = model_.clock.next_dt;
      next = report.iterations <= easy ? std::min(dt * growth, input_.max_step.value_or(length)) : dt;
      if (dt == first && dt < planned) next = planned;
      return;
    }
    ++rejected_;
    if (!at_rest && rule_.dynamic() && overstrains(first_guess(false))) {
      cuts += fmt::format("; begun again at rest: {} (residual {})", why, norms);
      at_rest = true;
    } else {
      const double shorter = std::max(0.5 * dt, smallest);
      if (!(shorter < dt)) fail(why + ", residual " + norms, u);
      cuts += fmt::format("; shortened from {:.4g}: {} (residual {})", dt, why, norms);
      at_rest = input_.linearised();
      model_.clock.dt = shorter;
    }
    prepare();
  }
}

std::string ImplicitIntegrator::words_of_run() const {
  if (solves_ == 0) return {};
  return fmt::format("{}; {} Newton iterations and {} linear ones in {} solutions, {} of them rejected",
                     solver_.description(), total_.iterations, total_.linear_iterations, solves_, rejected_);
}

std::vector<PartOfPhase> ImplicitIntegrator::parts() const {
  const std::string phase = name_of_solution();
  return {{phase, "structure of the matrix", total_.structure_seconds},
          {phase, "residuals", total_.residual_seconds},
          {phase, "Jacobians", total_.jacobian_seconds},
          {phase, "preconditioner or factors", total_.setup_seconds},
          {phase, "linear systems", total_.linear_seconds}};
}

/// " of bodies a, b": those with particles within a cell and a half of a place. Collective.
std::string ImplicitIntegrator::bodies_around(const std::array<double, 3>& place) {
  constexpr double reach = 1.5;
  const GridGeometry& g = model_.grid->geometry();
  std::vector<double> none(model_.bodies.size(), 1.0);
  for (const ConstParticleBlock& block : blocks_of(std::as_const(model_))) {
    for (const ConstParticle p : block) {
      const Vec3<double> x = p.vector(Column::position_x);
      bool near = true;
      for (std::size_t a = 0; a < 3; ++a)
        near &= std::abs(x[static_cast<int>(a)] - place[a]) <= reach * g.cell[static_cast<int>(a)];
      if (near) none[static_cast<std::size_t>(block.body)] = 0;
    }
  }
  ranks_.minimum(none);
  std::vector<std::string> names;
  for (std::size_t b = 0; b < none.size(); ++b)
    if (none[b] == 0) names.push_back(fmt::format("\"{}\"", model_.bodies[b].name));
  if (names.empty()) return {};
  return fmt::format(" of {} {}", names.size() == 1 ? "body" : "bodies", fmt::join(names, ", "));
}

/// Names the node of the largest residual of the last iteration, at `u`, and the bodies with particles around
/// it.
void ImplicitIntegrator::fail(const std::string& why, std::span<const double> u) {
  std::vector<double> r(u.size());
  residual(u, r);
  double largest = 0;
  std::size_t at = 0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    if (!(std::abs(r[k]) > largest)) continue;
    largest = std::abs(r[k]);
    at = k / 3;
  }
  const double of_all = ranks_.largest(largest);
  const bool mine = largest > 0 && largest == of_all;
  const int from = static_cast<int>(ranks_.smallest(mine ? ranks_.rank() : ranks_.size()));
  std::array<double, 3> place;
  place.fill(std::numeric_limits<double>::infinity());
  if (from == ranks_.rank()) std::copy_n(unknowns_.coordinates().data() + 3 * at, 3, place.begin());
  ranks_.minimum(place);
  const std::string where = from == ranks_.size() ? "unknown"
                                                  : fmt::format("({:.6g}, {:.6g}, {:.6g}){}", place[0],
                                                                place[1], place[2], bodies_around(place));
  throw NumericalFailure(
      fmt::format(
          "step {}, time {:.9g}: no equilibrium with the smallest step, {:.4g}: {}; the largest "
          "residual force, "
          "{:.4g}, is at node {}. The state at the start of the step is kept. Use a smaller "
          "Implicit@min_step, "
          "load more slowly, or use a larger rtol{}",
          model_.clock.step + 1, model_.clock.time, model_.clock.dt, why, of_all, where,
          rule_.dynamic()
              ? ""
              : ". Quasi-static steps have none where nothing holds a body against its loads, or where "
                "these exceed what its material bears"),
      true);
}

}  // namespace mpm::core
