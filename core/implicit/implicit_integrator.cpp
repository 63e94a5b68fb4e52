#include "core/implicit/implicit_integrator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/contact/contact_points.hpp"
#include "core/particle_range.hpp"
#include "core/step/speeds.hpp"
#include "core/step/stepper.hpp"

namespace mpm::core {

namespace {

/// Steps with fewer iterations are easy: the next one may be longer.
constexpr int easy = 8;
constexpr double growth = 1.5;
/// A quasi-static run's steps, and a dynamic step over the largest explicit one, where the input names none.
constexpr double default_load_steps = 20, default_ratio = 20;
/// Nodes with less than CellStabilisation::hardly_any of the volume of a cell around them may belong to a
/// fragment that nothing holds. They get a stiffness of their own, of this part of the material's: so little
/// that it bears no weight over the way of a step, and enough for the matrix not to be singular.
constexpr double ground = 1e-10;
/// Friction has settled where it changes by less than this part of what it may be; and how often a step is
/// solved for that.
constexpr double settled_friction = 1e-3;
/// The stiffness of a cell in shear over that in compression, about.
constexpr double shear_share = 0.25;
constexpr int many_frictions = 10, most_frictions = 40;
/// Forces of this strain are rounding errors: a body without loads is in equilibrium.
constexpr double rounding = 1e-13;
/// The smallest step over the given one, where the input names none.
constexpr double default_smallest = 1.0 / 1024;

double length_of(const ImplicitInput& input, const Model& model) {
  if (input.time_step) return *input.time_step;
  const double explicit_step = default_ratio * model.clock.first_critical_dt;
  const bool by_loads = input.quasistatic() || !std::isfinite(explicit_step);
  const double length = by_loads ? model.scene->solution.end_time / default_load_steps : explicit_step;
  return std::max(std::min(length, input.max_step.value_or(length)), input.min_step.value_or(0));
}

}  // namespace

ImplicitIntegrator::ImplicitIntegrator(Model& model, Communication& communication, NewtonSolver& solver)
    : model_(model),
      ranks_(communication.reductions),
      halo_(communication.halo),
      solver_(solver),
      input_(model.scene->solution.implicit.value_or(ImplicitInput{})),
      cells_(make_cells_in_use(model, communication.halo)),
      rigid_(make_rigid_bodies(model, communication.reductions)),
      passes_(make_implicit_passes(model, rigid_.get(), fields_)),
      unknowns_(model, communication, fields_),
      stabilisation_(model, fields_),
      lags_(TimeRule::lags(input_)) {
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
    moves_bodies_ |= passes_->loads().motion(b).kind == BodyMotion::Kind::prescribed &&
                     (!rigid_ || rigid_->of_body(b) < 0);
  const double h = model.grid->geometry().smallest_cell();
  for (const Body& body : model.bodies) {
    const double c = body.model->initial_sound_speed();
    held_diagonal_ = std::max(held_diagonal_, body.model->reference_density() * c * c * h);
  }
  if (!(held_diagonal_ > 0)) held_diagonal_ = 1;
  contact_ = make_implicit_contact(model, rigid_.get(), unknowns_);
}

const char* ImplicitIntegrator::name_of_solution() const {
  return input_.linearised() ? "linear system" : "Newton's method";
}

std::vector<Phase> ImplicitIntegrator::phases() {
  std::vector<Phase> step;
  // First: every exchange sends what there is in each of these fields.
  if (contact_) step.push_back({"velocity fields of components", [this] { find_fields(); }});
  if (cells_) {
    step.push_back({"cells in use", [this] { cells_->find(); }});
    step.push_back({"exchange cells", [this] { cells_->finish_exchange(); }});
  }
  step.push_back({"particles to grid", [this] { prepare(); }});
  step.push_back({name_of_solution(), [this] { solve(); }});
  step.push_back({"grid to particles", [this] { move(); }});
  return step;
}

double ImplicitIntegrator::next_step(const Clock& clock) const {
  const double length = length_of(input_, model_);
  return clock.next_dt > 0 ? std::min(clock.next_dt, input_.max_step.value_or(length)) : length;
}

/// Components that may meet have fields of their own.
void ImplicitIntegrator::find_fields() {
  model_.grid->set_components(components_by_slot(*model_.grid, halo_));
}

void ImplicitIntegrator::find_contacts() {
  std::vector<double> mass;
  for (const NodeState& at : state_) mass.push_back(at.mass);
  contact_->find_nodes(*passes_, mass);
}

void ImplicitIntegrator::distribute(std::span<const double> u) {
  unknowns_.distribute(u, displacements_);
  if (contact_) contact_->take_displacements();
}

/// Masses, velocities, external forces and the forces at the start of the step.
void ImplicitIntegrator::prepare() {
  const double dt = model_.clock.dt;
  rule_ = TimeRule::of(input_, dt);
  fields_.find(*model_.grid);
  passes_->begin_step(dt, rule_.dynamic() ? 0.5 : 1.0);
  if (contact_) contact_->begin_step(passes_->loads(), dt);
  passes_->map_start();
  unknowns_.exchange(mapped::implicit_start);
  const std::vector<double> sums = unknowns_.number();
  unknowns_.hold_walls();
  state_.assign(unknowns_.own(), {});
  passes_->map_motion();
  unknowns_.exchange(mapped::implicit_motion);
  stabilisation_.find_cells(unknowns_);
  const GridGeometry& g = model_.grid->geometry();
  const double cell_volume = g.cell_volume();
  unknowns_.for_each_own([&](std::size_t i, const double* sum) {
    const double volume = sum[node_field::volume.first] / cell_volume;
    constexpr double hardly_any = CellStabilisation::hardly_any;
    if (!(volume > 0 && volume < hardly_any)) return;
    const double modulus = sum[node_field::modulus.first] / sum[node_field::volume.first];
    state_[i].ground = ground * (1 - volume / hardly_any) * modulus * g.smallest_cell();
  });
  if (moves_bodies_) unknowns_.hold_moved(dt);
  if (moves_bodies_ && rule_.dynamic()) {
    passes_->map_drive();
    unknowns_.exchange(mapped::implicit_lag);
    unknowns_.for_each_own([&](std::size_t i, const double* sum) {
      for (int a = 0; a < 3; ++a)
        if (moved(i, a)) state_[i].drive[a] = sum[a] / unknowns_.moved_volume()[i];
    });
  }
  const double cutoff = model_.grid->geometry().mass_cutoff;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    NodeState& at = state_[i];
    const double* sum = sums.data() + node_doubles * i;
    at.mass = sum[3];
    for (int a = 0; a < 3; ++a) {
      at.velocity[a] = at.mass > cutoff ? sum[a] / at.mass : 0;
      at.external[a] = sum[4 + a];
    }
    // Where the free motion is unknown, cells and ties alone hold the node.
    if (rule_.dynamic() && !(at.mass > cutoff)) at.ground = 0;
  }
  if (contact_) find_contacts();
  if (lags_) {
    passes_->map_lag();
    unknowns_.exchange(mapped::implicit_lag);
    unknowns_.for_each_own([&](std::size_t i, const double* sum) {
      NodeState& at = state_[i];
      for (int a = 0; a < 3; ++a) at.lag[a] = at.mass > cutoff ? sum[a] / at.mass : 0;
    });
  }
  const std::vector<double> at_rest(3 * state_.size(), 0.0);
  distribute(at_rest);
  passes_->map_forces(displacements_);
  unknowns_.exchange(mapped::implicit_force);
  const double damping = model_.scene->solution.damping;
  unknowns_.for_each_own([&](std::size_t i, const double* sum) {
    NodeState& at = state_[i];
    for (int a = 0; a < 3; ++a)
      at.force[a] = at.external[a] + sum[4 + a] - damping * at.mass * at.velocity[a];
  });
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

bool ImplicitIntegrator::map_forces(std::span<const double> u) {
  distribute(u);
  const bool usable = passes_->map_forces(displacements_);
  stabilisation_.add_forces(displacements_);
  unknowns_.exchange(mapped::implicit_force);
  return usable;
}

double ImplicitIntegrator::look_ahead(std::span<const double> u) {
  // Of a cell: so small that the forces are linear, and large against rounding.
  constexpr double small = 1e-5, there = 1e-12;
  if (!moves_bodies_ || input_.matrix_free) return 0;
  const double h = model_.grid->geometry().smallest_cell();
  double farthest = 0;
  for (std::size_t i = 0; i < state_.size(); ++i)
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
      if (held(i, static_cast<int>(k - 3 * i)))
        farthest = std::max(farthest, std::abs(unknowns_.held_displacements()[k] - u[k]));
  farthest = ranks_.largest(farthest);
  if (!(farthest > there * h)) return 0;
  const double part = std::min(1.0, small * h / farthest);
  ahead_.assign(u.begin(), u.end());
  for (std::size_t i = 0; i < state_.size(); ++i)
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
      if (held(i, static_cast<int>(k - 3 * i)))
        ahead_[k] += part * (unknowns_.held_displacements()[k] - u[k]);
  return part;
}

bool ImplicitIntegrator::residual(std::span<const double> u, std::span<double> r) {
  const double part = look_ahead(u);
  if (part > 0) {
    map_forces(ahead_);
    find_contact_forces();
    unknowns_.for_each_own([&](std::size_t i, const double* sum) {
      for (int a = 0; a < 3; ++a)
        state_[i].ahead[a] = -(sum[4 + a] + (1 + rule_.carry) * state_[i].contact[a]) / part;
    });
  }
  const bool usable = map_forces(u);
  find_contact_forces();
  const double damping = model_.scene->solution.damping;
  ExactSum squares;
  unknowns_.for_each_own([&](std::size_t i, const double* sum) {
    NodeState& at = state_[i];
    double size = sum[7];
    for (int a = 0; a < 3; ++a) {
      const std::size_t k = 3 * i + static_cast<std::size_t>(a);
      const double inertia =
          at.mass * (rule_.inertia * u[k] - rule_.start * at.velocity[a] - rule_.recall * at.lag[a]);
      const double drag =
          damping * (at.mass * (rule_.gain * u[k] + rule_.keep * at.velocity[a] + rule_.push * at.lag[a]) +
                     rule_.push * at.force[a]);
      at.reaction[a] = inertia + drag + at.ground * (u[k] - free_motion(at, a)) - rule_.carry * at.force[a] -
                       at.external[a] - (1 + rule_.carry) * at.contact[a] - sum[4 + a];
      size += std::abs(inertia) + std::abs(at.external[a]) + std::abs(at.contact[a]);
      if (held(i, a)) {
        r[k] = held_diagonal_ * (u[k] - unknowns_.held_displacements()[k]);
        size += std::abs(r[k]);
        continue;
      }
      r[k] = at.reaction[a];
      if (!(part > 0)) continue;
      const double led = at.ahead[a] + (sum[4 + a] + (1 + rule_.carry) * at.contact[a]) / part;
      r[k] += led;
      size += std::abs(led);
    }
    squares.add(size * size);
  });
  ranks_.sum(std::span(&squares, 1));
  force_scale_ = std::sqrt(squares.value());
  return !ranks_.any(!usable);
}

void ImplicitIntegrator::find_contact_forces() {
  if (!contact_) return;
  for (NodeState& at : state_) std::fill_n(at.contact, 3, 0.0);
  contact_->for_each_force([&](std::size_t i, const Vec3<double>& force) {
    for (int a = 0; a < 3; ++a) state_[i].contact[a] += force[a];
  });
}

void ImplicitIntegrator::jacobian(std::span<const double> u, BlockMatrix& matrix) {
  distribute(u);
  passes_->add_tangent(&displacements_, unknowns_, matrix);
  stabilisation_.add_tangent(unknowns_, true, matrix);
  if (contact_) contact_->add_tangent(1 + rule_.carry, true, matrix);
  const double per_mass = rule_.inertia + model_.scene->solution.damping * rule_.gain;
  for (std::size_t i = 0; i < state_.size(); ++i) {
    double diagonal[9] = {};
    for (int a = 0; a < 3; ++a)
      diagonal[4 * a] = held(i, a) ? held_diagonal_ : per_mass * state_[i].mass + state_[i].ground;
    const std::int64_t number = unknowns_.first() + static_cast<std::int64_t>(i);
    matrix.add(std::span(&number, 1), diagonal);
  }
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

/// Solves again with the friction that the last solution allows, until it no longer changes.
void ImplicitIntegrator::settle_friction(std::span<double> u, const NewtonOptions& options,
                                         NewtonReport& report) {
  double relaxation = shear_share, last = 0;
  for (int i = 0; report.converged; ++i) {
    distribute(u);
    ImplicitContact::Changes mine = contact_->find_friction(relaxation);
    ExactSum sums[2] = {mine.change, mine.most};
    ranks_.sum(std::span(sums));
    const double change = sums[0].value();
    if (change <= settled_friction * sums[1].value()) return contact_->keep_friction();
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
    const NewtonReport next = solve_once(u, options);
    report.converged = next.converged;
    report.reason = next.reason;
    report.linear_iterations += next.linear_iterations;
    report.iterations = std::max(report.iterations, next.iterations);  // of a solution
    for (std::size_t n = 1; n < next.norms.size(); ++n) report.norms.push_back(next.norms[n]);
  }
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
    if (contact_ && contact_->rubs()) settle_friction(u, options, report);
    const std::string why = objection(report, u);
    const double dt = model_.clock.dt;
    const std::string norms = fmt::format("{:.2e}", fmt::join(report.norms, " "));
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

/// The forces are those of the end of the step, or where it is dynamic the means over it; damping counts
/// among them.
void ImplicitIntegrator::find_reactions() {
  map_forces(solution_);
  find_contact_forces();
  const double dt = model_.clock.dt, damping = model_.scene->solution.damping;
  std::vector<double> impulses(solution_.size());
  unknowns_.for_each_own([&](std::size_t i, const double* sum) {
    NodeState& at = state_[i];
    for (int a = 0; a < 3; ++a) {
      if (!moved(i, a)) continue;
      const std::size_t k = 3 * i + static_cast<std::size_t>(a);
      const double at_end = at.external[a] + sum[4 + a];
      at.impulse[a] = -dt * (at_end + at.contact[a]);
      if (rule_.dynamic()) {
        const double drag = damping * at.mass * solution_[k] / dt,
                     force = (rule_.carry * at.force[a] + at_end - drag) / (1 + rule_.carry);
        at.impulse[a] = at.mass * at.drive[a] - dt * (force + at.contact[a]);
      }
      impulses[k] = at.impulse[a] / unknowns_.moved_volume()[i];
    }
  });
  AlignedDoubles records;
  unknowns_.distribute(impulses, records);
  passes_->add_reactions(records);
}

void ImplicitIntegrator::move() {
  if (moves_bodies_) find_reactions();
  // The last residual of a line search need not be that of the solution.
  distribute(solution_);
  find_contact_forces();
  const double cutoff = model_.grid->geometry().mass_cutoff;
  std::vector<double> gained(solution_.size()), lag_gained(lags_ ? solution_.size() : 0);
  for (std::size_t i = 0; i < state_.size(); ++i) {
    const NodeState& at = state_[i];
    const bool touches = at.contact[0] != 0 || at.contact[1] != 0 || at.contact[2] != 0;
    double work = 0;
    for (int a = 0; a < 3; ++a) {
      const std::size_t k = 3 * i + static_cast<std::size_t>(a);
      const double u = solution_[k], force = at.mass > cutoff ? (at.force[a] + at.contact[a]) / at.mass : 0;
      work += at.external[a] * u;
      if (rule_.dynamic()) {
        if (moved(i, a)) work += at.impulse[a] * u / model_.clock.dt;
      } else if (held(i, a) || !touches) {
        // From equilibrium to equilibrium loads and reactions change in proportion: the work of their means.
        work += 0.5 * ((held(i, a) ? at.reaction[a] : 0.0) - at.force[a]) * u;
      }
      const double v = held(i, a)
                           ? u / model_.clock.dt
                           : rule_.gain * u + rule_.keep * at.velocity[a] + rule_.push * (force + at.lag[a]);
      // As in explicit steps, a wall acts on the particles through their stress alone; so does a body of
      // prescribed motion, in whose frame it is a wall.
      const bool on_wall = held(i, a) && !moved(i, a);
      if (at.mass > cutoff && !on_wall) gained[k] = moved(i, a) ? at.drive[a] : v - at.velocity[a];
      if (lags_ && at.mass > cutoff && !on_wall) {
        const bool led = held(i, a) || touches;
        const double at_end = rule_.force_at_end(u, at.velocity[a], force, at.lag[a]);
        const double lag = led ? 0 : rule_.fresh * (at_end - force) - rule_.fade * at.lag[a];
        lag_gained[k] = (lag - at.lag[a]) / model_.clock.dt;
      }
      work -= 0.5 * model_.scene->solution.damping * at.mass * (at.velocity[a] + v) * u;
    }
    if (work != 0) of_nodes_.work.add(work);
  }
  if (contact_) stop_contacts(gained);
  if (rule_.dynamic()) unknowns_.distribute(gained, velocities_);
  if (lags_) unknowns_.distribute(lag_gained, lag_increments_);
  passes_->move_particles(displacements_, rule_.dynamic() ? &velocities_ : nullptr,
                          lags_ ? &lag_increments_ : nullptr);
  if (contact_) contact_->end_step(of_nodes_);
}

/// What contact does to the velocities at the end of the step; and the forces of the step.
void ImplicitIntegrator::stop_contacts(std::span<double> gained) {
  if (!rule_.dynamic()) {
    std::vector<Vec3<double>> start;
    for (const NodeState& at : state_) start.push_back({at.force[0], at.force[1], at.force[2]});
    return contact_->find_start(start);
  }
  std::vector<double> velocity(gained.begin(), gained.end());
  for (std::size_t i = 0; i < state_.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) velocity[3 * i + a] += state_[i].velocity[a];
  contact_->stop(velocity, model_.grid->geometry().mass_cutoff,
                 [&](std::size_t i, const Vec3<double>& change) {
                   for (int a = 0; a < 3; ++a) gained[3 * i + static_cast<std::size_t>(a)] += change[a];
                 });
}

double ImplicitIntegrator::stable_step(const StepStatistics& statistics) const {
  return critical_step(*model_.grid, statistics.fastest);
}

StepStatistics ImplicitIntegrator::take_statistics() {
  StepStatistics all = passes_->take_statistics();
  all.work += of_nodes_.work;
  all.contact += of_nodes_.contact;
  of_nodes_ = {};
  return all;
}

}  // namespace mpm::core
