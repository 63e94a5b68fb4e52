// The rules of materials: parameters that a law ignores, and failure that cannot happen.

#include <algorithm>
#include <string>

#include "core/contact/component_contact.hpp"
#include "io/input/idle_places.hpp"

namespace mpm::io {

namespace {

using Place = SettingPlace;
using Random = core::RandomFailureInput;

const Random& random(const Place& at) { return at.material->random_failure; }

bool is_law(const Place& at, std::string_view type) { return at.strength().type == type; }

bool unused_material(const Place& at) {
  const auto number = static_cast<std::size_t>(at.material - at.scene.materials.data());
  return !any_body(at.scene, [&](const core::BodyInput& body) { return body.material == number; });
}

bool any_given(const core::LawInput& law, std::initializer_list<std::string_view> names) {
  return std::ranges::any_of(names, [&](std::string_view name) { return law.value_or(name, 0) != 0; });
}

/// Whether the law accumulates damage at which its particles fail.
bool has_failing_damage(const core::LawInput& law) {
  return law.type == "Gurson" || (law.type == "DFFoam" && law.value_or("vole", 0) > 0) ||
         (law.type == "JohnsonCook" && any_given(law, {"D1", "D2", "D3", "D4", "D5"}));
}

/// As physics::Material: failing damage, erosion, or a tension at which particles fail.
bool fails_by_itself(const core::LawInput& law) {
  return has_failing_damage(law) ||
         (law.type == "HolmquistJohnsonCook" &&
          any_given(law, {"DamageToFail", "ErosionByDamage", "TensileFailure", "ErosionByPressure"}));
}

bool has_damage(const Place& at) { return io::has_damage(at.strength()); }
bool can_fail(const Place& at) { return io::can_fail(*at.material); }

bool failed_type_is_not(const Place& at, int type) { return at.strength().value_or("FailedType", 0) != type; }

/// Nothing reads FailureDamageThreshold.
bool no_damage_rule(const Place& at) {
  return (contact_is_off(at) || !at.scene.contact.failed_to_component) &&
         at.strength().value_or("DamageToFail", 0) == 0;
}

bool all_zero(const Place& at) {
  return at.node.word("type") != "none" &&
         std::ranges::all_of(at.node.spec().attributes, [&](const AttributeSpec& row) {
           return row.type != ValueType::real || !row.applies_to(at.node.type()) ||
                  at.node.real(row.name) == 0;
         });
}

bool eos_gives_stiffness(const Place& at) {
  return is_law(at, "HighExpBurn") || (is_law(at, "Null") && at.material->eos);
}
/// Contact weighs the normals of bodies by Young.
bool stiffness_is_a_weight(const Place& at) {
  return at.scene.contact.enable && at.scene.contact.automatic_weights && !regression(at);
}

/// The step does not follow the speed of sound.
bool step_is_unestimated(const Place& at) {
  return steps_are_implicit(at) || at.scene.solution.time_step.specified > 0;
}

}  // namespace

bool has_plastic_strain(std::string_view strength_type) {
  constexpr std::string_view without[] = {"IsoElastic", "CauchyElastic", "Elastic_1D",
                                          "Null",       "HighExpBurn",   "MooneyRivlin",
                                          "NeoHookean", "Corotated",     "Rigid"};
  return std::ranges::find(without, strength_type) == std::end(without);
}

bool has_damage(const core::LawInput& law) {
  return has_failing_damage(law) || law.type == "HolmquistJohnsonCook" || law.type == "RHT" ||
         law.type == "JH2";
}

bool can_fail(const core::MaterialInput& material) {
  return std::ranges::any_of(material.failures,
                             [&](const core::FailureInput& failure) {
                               return failure.type != "PlaStrain" ||
                                      has_plastic_strain(material.strength.type);
                             }) ||
         fails_by_itself(material.strength);
}

std::vector<IdleRule> idle_rules_of_materials() {
  return {
      {"Material", {}, unused_material, "no body is made of this material"},
      {"Material/StrengthModel",
       {"TensileCutoff"},
       [](const Place& at) { return failed_type_is_not(at, 2); },
       "used only with FailedType=\"2\""},
      {"Material/StrengthModel",
       {"FailedType", "FailViscosity"},
       [](const Place& at) { return !can_fail(at); },
       "applies only to failed particles, and this material cannot fail"},
      {"Material/StrengthModel",
       {"FailureDamageThreshold"},
       no_damage_rule,
       "used only with Contact failure_to_component=\"1\", or with DamageToFail=\"1\" of "
       "HolmquistJohnsonCook"},
      {"Material/StrengthModel",
       {"mu"},
       [](const Place& at) { return is_law(at, "Null") && at.strength().value_or("ck", 0) > 0; },
       "with ck the viscosity is that of the power law alone"},
      {"Material/StrengthModel",
       {"nn"},
       [](const Place& at) { return is_law(at, "Null") && !(at.strength().value_or("ck", 0) > 0); },
       "the exponent of the power law, which ck switches on"},
      {"Material/StrengthModel",
       {"match"},
       [](const Place& at) { return is_law(at, "DruckerPrager") && !at.strength().has("phi"); },
       "used only with phi, c and psi"},
      {"Material/StrengthModel",
       {"Gauss_f0"},
       [](const Place& at) { return is_law(at, "Gurson") && at.strength().value_or("Gauss_sn", 0) == 0; },
       "without a scatter Gauss_sn every particle starts with f0"},
      {"Material/StrengthModel",
       {"VarSoundspeed"},
       [](const Place& at) { return !core::is_rigid(*at.material) && step_is_unestimated(at); },
       "the speed of sound does not decide the step"},
      {"Material/StrengthModel",
       {"PlasticWorkCoefficient"},
       [](const Place& at) { return !at.strength().has("SpecHeat"); },
       "requires SpecHeat, which is not given"},
      {"Material/StrengthModel",
       {"roomt"},
       [](const Place& at) { return !at.strength().has("SpecHeat"); },
       "there is no temperature without SpecHeat"},
      {"Material/StrengthModel",
       {"SpecHeat"},
       [](const Place& at) {
         return at.node.spec().attribute("PlasticWorkCoefficient", at.node.type()) == nullptr &&
                at.strength().value_or("TemperatureCoefficient", 0) == 0 &&
                at.strength().value_or("CoefficientOfThermalConductivity", 0) == 0;
       },
       "nothing heats this material"},
      {"Material/StrengthModel",
       {"*"},
       [](const Place& at) { return core::is_rigid(*at.material) && !stiffness_is_a_weight(at); },
       "a rigid body has neither stress nor heat"},
      {"Material/StrengthModel",
       {"*", "Young"},
       [](const Place& at) { return core::is_rigid(*at.material) && stiffness_is_a_weight(at); },
       "a rigid body has neither stress nor heat"},
      {"Material/StrengthModel",
       {"Young", "Poisson"},
       [](const Place& at) { return eos_gives_stiffness(at) && !stiffness_is_a_weight(at); },
       "the equation of state determines the stiffness"},
      {"Material/StrengthModel",
       {"Poisson"},
       [](const Place& at) { return eos_gives_stiffness(at) && stiffness_is_a_weight(at); },
       "the equation of state determines the stiffness"},
      {"Material/StrengthModel",
       {"Young"},
       [](const Place& at) { return is_law(at, "MooneyRivlin"); },
       "Mr_A2, Mr_B2 and Poisson determine the stiffness"},
      {"Material/StrengthModel",
       {"limiter"},
       [](const Place& at) {
         return !core::is_rigid(*at.material) && at.strength().value_or("bq1", 0) == 0 &&
                at.strength().value_or("bq2", 0) == 0;
       },
       "bq1 and bq2 are 0: there is no artificial viscosity to limit"},
      {"Material/StrengthModel",
       {"limiter"},
       [](const Place& at) { return !core::is_rigid(*at.material) && steps_are_implicit(at); },
       "implicit steps have no artificial viscosity"},
      {"Material/StrengthModel",
       {"bq1", "bq2"},
       [](const Place& at) { return !core::is_rigid(*at.material) && steps_are_implicit(at); },
       "implicit steps have no artificial viscosity"},
      {"Material/EquationOfState",
       {"c0", "c1", "c2", "c3", "c4", "c5", "c6"},
       [](const Place& at) { return at.node.type() == "PAlpha" && at.eos("EOSID") != 1; },
       "used only with EOSID=\"1\""},
      {"Material/EquationOfState",
       {"A1", "A2", "A3", "B0", "B1", "T1", "T2"},
       [](const Place& at) { return at.node.type() == "PAlpha" && at.eos("EOSID") != 2; },
       "used only with EOSID=\"2\""},
      {"Material/EquationOfState",
       {"S1", "gamma0", "simplified"},
       [](const Place& at) { return at.node.type() == "PAlpha" && at.eos("EOSID") != 3; },
       "used only with EOSID=\"3\""},
      {"Material/FailureModel",
       {"Erosion"},
       [](const Place& at) { return at.node.type() == "none"; },
       "type none has no criterion"},
      {"Material/FailureModel", {}, all_zero, "all its bounds are 0, which switches it off"},
      {"Material/FailureModel",
       {},
       [](const Place& at) {
         return at.node.type() == "PlaStrain" && !has_plastic_strain(at.strength().type);
       },
       "this StrengthModel has no plastic strain"},
      {"Material/RandomFailure",
       {"*"},
       [](const Place& at) { return !random(at).enable; },
       "RandomFailure is off"},
      {"Material/RandomFailure",
       {"enable"},
       [](const Place& at) { return random(at).distribution == Random::Distribution::constant; },
       "FailDistribution 0 gives every particle the same thresholds"},
      {"Material/RandomFailure",
       {"enable"},
       [](const Place& at) {
         return random(at).distribution != Random::Distribution::constant && !can_fail(at) &&
                !(random(at).random_damage && has_damage(at));
       },
       "this material cannot fail"},
      {"Material/RandomFailure",
       {"GaussMean", "GaussStd"},
       [](const Place& at) {
         return random(at).enable && random(at).distribution != Random::Distribution::gauss;
       },
       "used only with FailDistribution=\"1\""},
      {"Material/RandomFailure",
       {"WeibMed", "WeibMod", "WeibRefVol", "WeibPartVol"},
       [](const Place& at) {
         return random(at).enable && random(at).distribution != Random::Distribution::weibull;
       },
       "used only with FailDistribution=\"2\""},
      {"Material/RandomFailure",
       {"DamageRandom"},
       [](const Place& at) { return random(at).enable && !has_damage(at); },
       "the law of this material has no damage"},
  };
}

}  // namespace mpm::io
