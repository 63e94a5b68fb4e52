// Creates a material from the input's names and values. Ranges were checked when the file was read; here only
// the combinations of several elements are checked.

#include "physics/eos/elastic_bulk.hpp"
#include "physics/material/material.hpp"
#include "physics/registry.hpp"

namespace mpm::physics {

namespace {

/// The pressure law where the input gives no equation of state.
std::unique_ptr<EosLaw> elastic_bulk(const StrengthTraits& strength, const CommonParameters& common,
                                     const core::MaterialInput& input) {
  double bulk = common.young / (3 * (1 - 2 * common.poisson));
  if (strength.compression_burn) bulk = 0;  // burning material needs an equation of products
  if (strength.bulk) bulk = *strength.bulk;
  if (!(bulk > 0)) {
    throw core::InputErrors(input.strength.source, "StrengthModel",
                            input.strength.type + " has no pressure of its own: add an EquationOfState");
  }
  return std::make_unique<EosOf<ElasticBulk>>(ElasticBulk{bulk});
}

std::unique_ptr<EosLaw> make_eos(const core::MaterialInput& input, const StrengthLaw& strength,
                                 const CommonParameters& common, const Registry& registry) {
  const StrengthTraits traits = strength.traits();
  if (!input.eos) {
    if (auto own = strength.own_eos()) return own;
    if (traits.sets_pressure)
      return std::make_unique<EosOf<StrengthPressure>>(StrengthPressure{*traits.bulk});
    return elastic_bulk(traits, common, input);
  }
  if (traits.own_pressure) {
    throw core::InputErrors(
        input.eos->source, "EquationOfState",
        input.strength.type + " computes its pressure itself: remove the EquationOfState");
  }
  return registry.make_eos(*input.eos, input.reference_density);
}

/// Rejects the material if the strength model reports a fault.
void refuse(const std::string& fault, const core::MaterialInput& input) {
  if (!fault.empty()) throw core::InputErrors(input.strength.source, "StrengthModel", fault);
}

void check_conduction(const core::MaterialInput& input, const CommonParameters& common) {
  if (common.conductivity > 0 && !(common.specific_heat > 0)) {
    throw core::InputErrors(input.strength.source, "StrengthModel",
                            "CoefficientOfThermalConductivity needs SpecHeat");
  }
}

void check_expansion(const core::MaterialInput& input, const Material::Laws& laws) {
  if (laws.common.temperature_coefficient == 0) return;
  const auto fault = [&](const std::string& text) {
    throw core::InputErrors(input.strength.source, "StrengthModel", text);
  };
  if (!(laws.common.specific_heat > 0)) fault("TemperatureCoefficient needs SpecHeat");
  if (laws.strength->traits().sets_pressure) {
    fault(input.strength.type + " computes its pressure itself, without TemperatureCoefficient: remove it");
  }
  if (laws.eos->depends_on_energy()) {
    fault("TemperatureCoefficient must be 0 with " + input.eos->type +
          ", whose pressure already grows with the energy of heating");
  }
}

}  // namespace

std::unique_ptr<Material> make_material(const core::MaterialInput& input,
                                        const std::vector<core::DetonationItem>& detonations,
                                        const Registry& registry) {
  Material::Laws laws;
  laws.name = input.name;
  laws.reference_density = input.reference_density;
  read_parameters(laws.common, input.strength);
  check_conduction(input, laws.common);
  laws.strength = registry.make_strength(input.strength, input.reference_density);
  refuse(laws.strength->light(detonations), input);
  laws.eos = make_eos(input, *laws.strength, laws.common, registry);
  refuse(laws.strength->couple(laws.eos->traits()), input);
  if (input.eos) read_parameters(laws.common_eos, *input.eos);
  check_expansion(input, laws);
  laws.random_failure = input.random_failure;
  laws.limiter = input.limiter;
  if (laws.eos->traits().solid_has_sound_speed) laws.common_eos.c0 = 0;  // not that of the porous material
  for (const core::FailureInput& failure : input.failures)
    laws.failures.push_back({registry.make_failure(failure, input.reference_density), failure.erosion});
  return std::make_unique<Material>(std::move(laws));
}

std::unique_ptr<Material> make_material(const core::MaterialInput& input,
                                        const std::vector<core::DetonationItem>& detonations) {
  return make_material(input, detonations, built_in_laws());
}

std::vector<std::unique_ptr<core::ConstitutiveModel>> make_materials(const core::Scene& scene,
                                                                     const Registry& registry) {
  std::vector<std::unique_ptr<core::ConstitutiveModel>> materials;
  core::ErrorList wrong;
  for (const core::MaterialInput& input : scene.materials)
    wrong.collect([&] { materials.push_back(make_material(input, scene.detonations, registry)); });
  wrong.raise_if_any();
  return materials;
}

std::vector<std::unique_ptr<core::ConstitutiveModel>> make_materials(const core::Scene& scene) {
  return make_materials(scene, built_in_laws());
}

}  // namespace mpm::physics
