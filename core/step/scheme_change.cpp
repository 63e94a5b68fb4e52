#include "core/step/scheme_change.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/component_contact.hpp"
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

bool has_free_rigid_bodies(const Scene& scene) {
  bool found = false;
  for_each_active_body(scene, [&](int, const BodyInput& body) {
    found = found || (is_rigid(scene.materials[body.material]) && !is_driven(body));
  });
  return found;
}

}  // namespace

bool may_change_scheme(const Scene& scene) {
  const SolutionInput& solution = scene.solution;
  if (!solution.automatic_scheme || solution.integration != Integration::explicit_dynamics ||
      solution.transfer != Transfer::flip || solution.flip_fraction != 1 ||
      solution.mass != MassMatrix::lumped)
    return false;
  const bool gains_by_contact = scene.contact.enable && (scene.contact.method != ContactInput::Method::pan ||
                                                         has_free_rigid_bodies(scene));
  const bool is_booked =
      !scene.grid.has_face(Boundary::nonreflecting) && !solution.volume.min && !solution.volume.max;
  return !gains_by_contact && is_booked;
}

std::optional<double> drift_beyond_tolerance(Model& model, Reductions& ranks) {
  Clock& clock = model.clock;
  const std::int64_t step = clock.step;
  const bool first = step <= first_steps;
  if (model.scheme != Scheme::musl || step < first_look || (!first && step % balance_interval != 0))
    return {};
  const EnergyBalance balance = energy_balance(compute_energy_totals(model, ranks), model.initial_energy);
  clock.looks.scale = std::max(clock.looks.scale, balance.scale);
  if (!(clock.looks.scale > 0)) return {};
  const double drift = balance.relative_drift * balance.scale / clock.looks.scale;
  const double before = std::exchange(clock.looks.last, drift);
  const bool falls = std::abs(model.initial_energy) <= 0.5 * clock.looks.scale;
  if (falls && step < first_look_of_fall) return {};
  // In the first steps the look before has to say the same.
  double certain = std::abs(drift);
  if (first) certain = before * drift > 0 ? std::min(certain, std::abs(before)) : 0;
  if (step == long_run) clock.looks.early = drift;
  const bool grows = step > long_run && std::abs(drift - clock.looks.early) > tolerated_growth;
  if (!(certain > tolerated_drift || grows)) return {};
  return drift;
}

void change_scheme(Model& model, Scheme scheme) {
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
