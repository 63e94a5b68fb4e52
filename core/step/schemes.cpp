// The explicit step on one page: each scheme is the list of its phases, in the order in which they run
// (thesis 2.2.2). The names stand in the log's timing table, in the summary and in the benchmarks.
#include "core/step/stepper.hpp"

namespace mpm::core {

std::vector<Phase> phases_of(Stepper& s, Scheme scheme) {
  Passes& pass = s.passes_;
  using enum Mapped;

  std::vector<Phase> step{{"choose time step", [&] { s.choose_time_step(); }}};
  const auto then = [&](const char* name, std::function<void()> run) {
    step.push_back({name, std::move(run)});
  };

  if (Conduction& heat = s.conduction_; heat.any()) {
    then("heat to grid", [&heat] { heat.map_heat(); });
    then("exchange heat", [&heat] { heat.finish_exchange(); });
    then("heat flux to grid", [&heat] { heat.map_flux(); });
    then("exchange flux", [&heat] { heat.finish_exchange(); });
    then("heat to particles", [&s, &heat] { heat.warm(s.model_.clock.dt); });
  }

  switch (scheme) {
    case Scheme::musl:
      then("particles to grid", [&] { pass.map_to_grid<momentum_mass_force>(); });
      then("exchange", [&] { pass.finish_exchange(); });
      then("velocities, and back to grid", [&] { pass.update_velocities_and_map_back(); });
      then("exchange again", [&] { pass.finish_exchange(); });
      then("stress and motion", [&] { pass.update_stress_and_move(); });
      break;
    case Scheme::usf:
      then("particles to grid", [&] { pass.map_to_grid<momentum_mass>(); });
      then("exchange", [&] { pass.finish_exchange(); });
      then("stress, and forces to grid", [&] { pass.update_stress_and_map_forces(); });
      then("exchange again", [&] { pass.finish_exchange(); });
      then("velocities and motion", [&] { pass.update_velocities_and_move(); });
      break;
    case Scheme::usl:
      then("particles to grid", [&] { pass.map_to_grid<momentum_mass_force>(); });
      then("exchange", [&] { pass.finish_exchange(); });
      then("stress, velocities and motion", [&] { pass.update_all(); });
      break;
  }

  then("collect leavers", [&] { s.migration_.collect(pass.leavers()); });
  then("agree", [&] { s.agree(); });
  then("migrate", [&] { s.migration_.deliver(s.claim_); });
  then("tidy", [&s] {
    if (s.model_.clock.step % Stepper::tidy_interval == 0) s.migration_.tidy();
  });
  return step;
}

}  // namespace mpm::core
