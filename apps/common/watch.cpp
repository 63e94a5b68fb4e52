#include "apps/common/watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/has_shape.hpp"
#include "core/particle_range.hpp"
#include "core/step/finite.hpp"
#include "core/step/offending_particle.hpp"

namespace mpm::apps {
namespace {

/// What to try where the energy drifts.
std::string remedies(const core::Scene& scene) {
  std::string words;
  const core::SolutionInput& solution = scene.solution;
  if (solution.integration == core::Integration::explicit_dynamics) {
    const bool to_sgmp = scene.grid.shape == core::ShapeFunction::linear && core::has_shape("SGMP");
    if (to_sgmp) words = "try Grid shape=\"SGMP\"";
    if (solution.scheme != core::Scheme::usavg && !core::may_change_scheme(scene))
      words += fmt::format("{} Solution algorithm=\"USAVG\"", to_sgmp ? ", or" : "try");
    if (!words.empty()) words += "; ";
  }
  return words + "docs/stability.md lists remedies";
}

}  // namespace

Watch::Watch(const core::Scene& scene, double time) : warn_(scene.solution.warn), scene_(scene) {
  const auto note = [&](const auto& points, const std::string& body, const char* load) {
    if (!points.empty() && points.back().time >= time)
      load_ends_.emplace(points.back().time, fmt::format("{} of body \"{}\"", load, body));
  };
  core::for_each_active_body(scene, [&](int, const core::BodyInput& body) {
    if (body.prescribed_acceleration)
      note(body.prescribed_acceleration->points, body.name, "PrescribedAcceleration");
    for (const core::SurfaceLoad& load : body.surface_loads) note(load.points, body.name, "Traction");
  });
}

void Watch::after_step(const core::Model& model, const core::Stepper::Incidents& mine,
                       core::Reductions& ranks, io::Log& log) {
  for (; !load_ends_.empty() && load_ends_.begin()->first < model.clock.time;
       load_ends_.erase(load_ends_.begin())) {
    log.warn("time {:.6g}: the last Coefficient of {} has passed: its load is zero from now on",
             model.clock.time, load_ends_.begin()->second);
  }
  if (scene_.solution.energy_fraction) check_energy(model, ranks);
  if (!warn_.negative_internal_energy && !warn_.negative_volume && !warn_.outside_grid) return;
  std::int64_t counts[3] = {warn_.negative_internal_energy ? mine.events.negative_energy : 0,
                            warn_.negative_volume ? mine.events.negative_volume : 0,
                            warn_.outside_grid ? mine.left_grid : 0};
  ranks.sum(std::span<std::int64_t>(counts));
  for (int i = 0; i < 3; ++i) {
    Kind& kind = kinds_[i];
    kind.incidents += counts[i];
    const bool all_named = kind.named.size() == core::OffendingParticles::most;
    if (counts[i] == 0 || all_named) continue;
    warn(kind, counts[i],
         core::first_of_all(ranks, i == 0   ? mine.negative
                                   : i == 1 ? mine.vanishing
                                            : mine.first_left),
         model, log);
  }
}

/// `first`: of all ranks.
void Watch::warn(Kind& kind, std::int64_t count, const core::OffendingParticles& first,
                 const core::Model& model, io::Log& log) const {
  const std::string when = fmt::format("step {}, time {:.6g}: ", model.clock.step, model.clock.time);
  if (warn_.level == core::WarnInput::Level::per_particle) {
    for (const auto& [identity, words] : first.words()) {
      if (kind.named.size() == core::OffendingParticles::most || !kind.named.insert(identity).second)
        continue;
      log.warn("{}{} {}", when, words, kind.words);
      if (kind.named.size() == core::OffendingParticles::most)
        log.warn("{} particles {} have been named: further ones are only counted",
                 core::OffendingParticles::most, kind.words);
    }
    return;
  }
  std::string text = fmt::format("{}{} particle(s) {}", when, count, kind.words);
  if (!first.empty()) text += "; the first: " + first.words().begin()->second;
  if (warn_.level == core::WarnInput::Level::stop) throw core::NumericalFailure(text);
  log.warn("{}", text);
}

double Watch::mean_drift() const {
  double sum = 0;
  for (const double drift : drifts_) sum += drift;
  return drifts_.empty() ? 0 : sum / static_cast<double>(drifts_.size());
}

void Watch::note_balance(const core::Clock& clock, const core::EnergyBalance& balance, io::Log& log) {
  last_step_ = clock.step;
  last_drift_ = balance.relative_drift;
  began_with_energy_ = balance.initial_share > 0.5;
  if (clock.step < (is_implicit() ? 1 : first_judged_step)) return;
  drifts_.push_back(balance.relative_drift);
  if (drifts_.size() > judged_rows) drifts_.pop_front();
  const double mean = mean_drift();
  if (drifts_.size() < judged_rows || !(std::abs(mean) > std::abs(largest_mean_drift_))) return;
  if (std::abs(mean) > notable_drift && std::abs(largest_mean_drift_) <= notable_drift) {
    log.warn(
        "step {}, time {:.6g}: the error of the energy balance is {:.3g} % in the mean over {} rows, more "
        "than {:.3g} %: the results may be wrong; {}",
        clock.step, clock.time, 100 * mean, judged_rows, 100 * notable_drift, remedies(scene_));
  }
  largest_mean_drift_ = mean;
}

/// Whether the run had fewer steps than the others are judged by, and a notable drift.
bool Watch::drifted_early() const {
  if (is_implicit() || last_step_ == 0 || last_step_ >= first_judged_step) return false;
  const double of_fall =
      std::max(notable_drift_of_short_run, notable_steps_of_drift / static_cast<double>(last_step_));
  return std::abs(last_drift_) > (began_with_energy_ ? notable_drift : of_fall);
}

std::string Watch::words_of_drift() const {
  if (drifted_early())
    return fmt::format(
        "the error of the energy balance was {:.3g} % at step {}, the last: the results may be wrong; {}",
        100 * last_drift_, last_step_, remedies(scene_));
  const double last = mean_drift();
  const double worst = std::abs(last) > std::abs(largest_mean_drift_) ? last : largest_mean_drift_;
  if (!(std::abs(worst) > notable_drift)) return {};
  return fmt::format("the error of the energy balance was up to {:.3g} %", 100 * worst);
}

void Watch::conclude(io::Log& log) const {
  const std::string drift = words_of_drift();
  if (!drift.empty()) log.warn("{}", drift);
  if (warn_.level != core::WarnInput::Level::per_particle) return;
  for (const Kind& kind : kinds_) {
    if (kind.incidents > 0)
      log.say("counted    {} particle(s) {}, summed over the steps; {} named above", kind.incidents,
              kind.words, kind.named.size());
  }
}

void Watch::check_energy(const core::Model& model, core::Reductions& ranks) const {
  const core::Totals totals = core::compute_energy_totals(model, ranks);
  core::require_finite(model, std::array{totals.kinetic, totals.internal, totals.external_work}, ranks);
  const double drift = core::energy_balance(totals, model.initial_energy).relative_drift;
  if (std::abs(drift) <= *scene_.solution.energy_fraction) return;
  throw core::NumericalFailure(
      fmt::format("step {}, time {:.6g}: the relative error of the total energy is {:.3g}, more than "
                  "EnergyFraction {:.3g}",
                  model.clock.step, model.clock.time, drift, *scene_.solution.energy_fraction));
}

bool Watch::near_boundary(const core::Model& model, core::Reductions& ranks) const {
  if (!scene_.solution.near_boundary_stop) return false;
  const core::GridGeometry& g = model.grid->geometry();
  // An implicit step may throw particles out from farther inside; explicit ones that are gone have left
  // through other faces.
  bool near = scene_.solution.integration == core::Integration::implicit && model.ledger.left_grid > 0;
  for (const core::ConstParticleBlock& block : core::blocks_of(model)) {
    for (const core::ConstParticle p : block) {
      const core::Vec3<double> x = p.vector(core::Column::position_x);
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const std::int64_t cell = g.cell_index(x[axis], axis);
        near = near || (cell == 0 && g.boundary[2 * a] == core::Boundary::free) ||
               (cell == g.cells[a] - 1 && g.boundary[2 * a + 1] == core::Boundary::free);
      }
    }
  }
  return ranks.any(near);
}

}  // namespace mpm::apps
