#include "core/step/scheme_change.hpp"

#include <algorithm>
#include <cmath>

#include "core/step/conduction.hpp"
#include "core/step/passes.hpp"
#include "core/step/totals.hpp"
#include "core/step/wave_limit.hpp"

namespace mpm::core {

namespace {

void use_scheme(Model& model, Scheme scheme) {
  model.scheme = scheme;
  model.options.tension_weight = tension_weight(*model.scene, scheme);
  model.grid->set_arrays(node_arrays_of(*model.scene, scheme, conducts_heat(model)));
}

}  // namespace

bool may_change_scheme(const Scene& scene) {
  const SolutionInput& solution = scene.solution;
  const bool gains_by_contact = scene.contact.enable && scene.contact.method != ContactInput::Method::pan;
  return solution.automatic_scheme && solution.integration == Integration::explicit_dynamics &&
         solution.transfer == Transfer::flip && solution.flip_fraction == 1 &&
         solution.mass == MassMatrix::lumped && !gains_by_contact;
}

std::optional<double> drift_beyond_tolerance(const Model& model, Reductions& ranks) {
  const std::int64_t step = model.clock.step;
  const bool looks = step >= first_look && (step <= first_steps || step % balance_interval == 0);
  if (model.scheme != Scheme::musl || !looks) return {};
  const EnergyBalance balance = energy_balance(compute_energy_totals(model, ranks), model.initial_energy);
  const bool falls = balance.initial_share <= 0.5;
  if (falls && step <= first_steps) return {};
  const double of_fall = falls ? tolerated_steps_of_fall / static_cast<double>(step) : 0.0;
  if (!(std::abs(balance.relative_drift) > std::max(tolerated_drift, of_fall))) return {};
  return balance.relative_drift;
}

void change_scheme(Model& model, Scheme scheme) {
  // h / (c/k + |v|) falls by no more than the ratio of the limits k.
  const double shorter = std::min(1.0, wave_limit(*model.scene, scheme) / wave_limit(model));
  model.clock.critical_dt *= shorter;
  model.clock.first_critical_dt *= shorter;
  model.clock.scheme_since = model.clock.step;
  use_scheme(model, scheme);
}

void continue_scheme(Model& model) {
  if (model.clock.scheme_since == 0) return;
  if (may_change_scheme(*model.scene))
    use_scheme(model, Scheme::usavg);
  else
    model.clock.scheme_since = 0;
}

}  // namespace mpm::core
