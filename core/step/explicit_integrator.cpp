// The explicit step: each scheme is the list of its phases in order of execution (thesis 2.2.2).
#include "core/step/explicit_integrator.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "core/built.hpp"
#include "core/implicit/implicit_integrator.hpp"
#include "core/step/speeds.hpp"
#include "core/step/strain_limit.hpp"
#include "core/transfer/corrected.hpp"

namespace mpm::core {

std::vector<Phase> ExplicitIntegrator::phases() {
  Passes& pass = *passes_;
  Conduction& heat = *heat_;
  std::vector<Phase> step;
  const auto then = [&](std::string name, std::function<void()> run) {
    step.push_back({std::move(name), std::move(run)});
  };
  const bool moves_bodies = rigid_ && rigid_->any_free();
  const auto find_rigid_motion = [&] {
    if (moves_bodies) then("motion of rigid bodies", [&] { pass.find_rigid_motion(); });
  };
  // XPIC and FMPM, before the particles take velocities.
  const int orders = orders_of(model_.scene->solution);
  const auto correct_velocities = [&] {
    for (int order = 2; order <= orders; ++order) {
      then(fmt::format("correct velocities, order {}", order),
           [&, order] { pass.correct_velocities(order); });
      then(fmt::format("exchange, order {}", order), [&] { pass.finish_correction(); });
    }
    if (moves_bodies && is_corrected(model_.scene->solution.transfer))
      then("motion of rigid bodies, corrected", [&] { pass.correct_rigid_motion(); });
  };

  const bool solves = model_.scene->solution.mass == MassMatrix::consistent;
  const auto solve = [&](std::string name, Passes::MassSystem system) {
    if (solves) then("consistent mass, " + std::move(name), [&, system] { pass.solve_mass(system); });
  };

  const auto limit = [&] {
    if (strain_may_jump(model_)) then("limit strain", [&] { limit_strain(); });
  };

  const auto forces_at_start = [&] {
    if (!pass.needs_forces_at_start()) return;
    then("old forces to grid", [&] { pass.map_forces_at_start(); });
    then("exchange old forces", [&] { pass.finish_exchange(); });
  };

  // First: every exchange sends what there is in each of these fields.
  if (model_.scene->contact.enable) then("velocity fields of components", [&] { pass.find_fields(ranks_); });

  if (cells_) {
    then("cells in use", [&] { cells_->find(); });
    then("exchange cells", [&] { cells_->finish_exchange(); });
  }

  if (heat.any()) {
    then("heat to grid", [&] { heat.map_heat(); });
    then("exchange heat", [&] { heat.finish_exchange(); });
    then("heat flux to grid", [&] { heat.map_flux(heat_dt_); });
    then("exchange flux", [&] { heat.finish_exchange(); });
    then("heat to particles", [&] { heat.update_temperatures(heat_dt_); });
  }

  if (model_.scene->contact.enable) {
    then("surfaces to grid", [&] { pass.map_surfaces(); });
    then("exchange surfaces", [&] { pass.finish_exchange(); });
    then("normals", [&] { pass.find_meetings(); });
    if (model_.scene->contact.measures_gaps()) {
      then("gaps to grid", [&] { pass.map_reach(); });
      then("exchange gaps", [&] { pass.finish_exchange(); });
      then("pairs that touch", [&] { pass.drop_distant_pairs(); });
    }
  }

  switch (model_.scheme) {
    case Scheme::musl:
      then("particles to grid", [&] { pass.map_momentum_mass_force(); });
      then("exchange", [&] { pass.finish_exchange(); });
      limit();
      find_rigid_motion();
      correct_velocities();
      if (pass.loads().any()) solve("velocities", Passes::MassSystem::velocity_at_end);
      solve("increments", Passes::MassSystem::increment);
      then("velocities, and back to grid", [&] { pass.update_velocities_and_map_back(); });
      then("exchange again", [&] { pass.finish_exchange(); });
      solve("new velocities", Passes::MassSystem::new_velocity);
      then("stress and motion", [&] { pass.update_stress_and_move(); });
      break;
    case Scheme::usf:
      then("particles to grid", [&] { pass.map_momentum_mass(); });
      then("exchange", [&] { pass.finish_exchange(); });
      forces_at_start();
      limit();
      solve("velocities", Passes::MassSystem::velocity_at_start);
      then("stress, and forces to grid", [&] { pass.update_stress_and_map_forces(); });
      then("exchange again", [&] { pass.finish_exchange(); });
      find_rigid_motion();
      correct_velocities();
      solve("increments", Passes::MassSystem::increment);
      then("velocities and motion", [&] { pass.update_velocities_and_move(); });
      break;
    case Scheme::usavg:
      then("particles to grid", [&] { pass.map_momentum_mass(); });
      then("exchange", [&] { pass.finish_exchange(); });
      forces_at_start();
      limit();
      solve("velocities", Passes::MassSystem::velocity_at_start);
      then("stress, second half, and forces to grid", [&] { pass.update_stress_and_map_forces(); });
      then("exchange forces", [&] { pass.finish_exchange(); });
      find_rigid_motion();
      correct_velocities();
      if (pass.loads().any()) solve("velocities at end", Passes::MassSystem::velocity_at_end);
      solve("increments", Passes::MassSystem::increment);
      then("velocities, and back to grid", [&] { pass.update_velocities_and_map_back(); });
      then("exchange again", [&] { pass.finish_exchange(); });
      solve("new velocities", Passes::MassSystem::new_velocity);
      then("stress, first half, and motion", [&] { pass.update_stress_and_move(); });
      break;
    case Scheme::usl:
      if (solves) throw std::logic_error("USL with the consistent mass matrix");
      then("particles to grid", [&] { pass.map_momentum_mass_force(); });
      then("exchange", [&] { pass.finish_exchange(); });
      limit();
      find_rigid_motion();
      correct_velocities();
      then("stress, velocities and motion", [&] { pass.update_all(); });
      break;
  }
  if (rigid_) then("rigid bodies", [&] { pass.move_rigid_bodies(); });
  return step;
}

ExplicitIntegrator::ExplicitIntegrator(Model& model, Communication& communication)
    : model_(model),
      ranks_(communication.reductions),
      cells_(make_cells_in_use(model, communication.halo)),
      heat_(make_conduction(model, communication.halo)),
      rigid_(make_rigid_bodies(model, communication)),
      passes_(make_passes(model, communication.halo, rigid_.get())) {}

void ExplicitIntegrator::begin_step(double dt) {
  Clock& clock = model_.clock;
  lag_before_ = clock.lag;
  strain_lag_before_ = clock.strain_lag;
  heat_dt_ = std::max(dt - clock.heat_lead, 0.0);
  clock.heat_lead = std::max(clock.heat_lead - dt, 0.0);
  passes_->begin_step(set_length(dt));
}

StepLength ExplicitIntegrator::set_length(double dt) {
  Clock& clock = model_.clock;
  if (clock.step == 0) clock.first_lag = lag_before_ = 0.5 * dt;
  // USF strains with the velocities of the step before, over this one's length: it must advance them by it,
  // too.
  if (model_.scheme == Scheme::usf) {
    clock.lag = clock.first_lag = 0.5 * dt;
    return {.dt = dt, .velocity_dt = dt, .lag = clock.lag};
  }
  const bool last = clock.time + dt >= model_.scene->solution.end_time;
  StepLength length = step_length(dt, lag_before_, clock.first_lag, last);
  const bool halves = model_.scheme == Scheme::usavg;
  length.strain_lag = halves ? strain_lag_before_ : 0.0;
  clock.strain_lag = halves ? 0.5 * dt : 0.0;
  clock.lag = length.lag;
  return length;
}

/// Heat has been conducted over the step as it was chosen; the next steps conduct it for less.
void ExplicitIntegrator::limit_strain() {
  double& dt = model_.clock.dt;
  const double limited =
      limited_step(dt, ranks_.largest(passes_->largest_strain_rate(strain_rate_limit(dt))));
  if (limited == dt) return;
  model_.clock.heat_lead += dt - limited;
  dt = limited;
  passes_->shorten_step(set_length(dt));
}

double ExplicitIntegrator::next_step(const Clock& clock) const {
  const TimeStepInput& how = model_.scene->solution.time_step;
  if (how.specified > 0) return how.specified;
  const double factor =
      passes_->loads().nonreflecting() ? std::min(how.factor, Loads::nonreflecting_factor) : how.factor;
  // What a load moves within its first step has no speed yet, by which the critical step is known.
  const double stable =
      factor * std::min(how.constant ? clock.first_critical_dt : clock.critical_dt, fall_time(model_));
  return rigid_ ? std::min(stable, rigid_->longest_step(passes_->loads())) : stable;
}

double ExplicitIntegrator::stable_step(const StepStatistics& statistics) const {
  return std::min(critical_step(*model_.grid, statistics.fastest), conduction_step(model_));
}

std::unique_ptr<Integrator> make_integrator(Model& model, Communication& communication) {
  if (model.scene->solution.integration == Integration::implicit) {
    if (communication.newton == nullptr) throw std::logic_error("an implicit scene without a solver");
    if constexpr (built_implicit)
      return std::make_unique<ImplicitIntegrator>(model, communication, *communication.newton);
  }
  return std::make_unique<ExplicitIntegrator>(model, communication);
}

}  // namespace mpm::core
