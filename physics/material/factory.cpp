// From the input's names and numbers to a material. Ranges were checked when the file was read; here only
// what several elements together forbid.

#include "physics/laws.hpp"
#include "physics/material/material.hpp"

namespace mpm::physics {

namespace {

/// What stands for the pressure where the input gives no equation of state.
ElasticBulk elastic_bulk(const StrengthModel& strength, const CommonParameters& common,
                         const core::MaterialInput& input) {
  const double bulk = std::visit(
      [&](const auto& law) -> double {
        if constexpr (requires { law.bulk; }) return law.bulk;
        if constexpr (Burns<std::decay_t<decltype(law)>>) return 0;  // what burns is an equation of products
        return common.young / (3 * (1 - 2 * common.poisson));
      },
      strength);
  if (!(bulk > 0)) {
    throw core::InputErrors(input.strength.source, "StrengthModel",
                            input.strength.type + " has no pressure of its own: add an EquationOfState");
  }
  return {bulk};
}

EquationOfState make_eos(const core::MaterialInput& input, const StrengthModel& strength,
                         const CommonParameters& common) {
  if (!input.eos) {
    return std::visit(
        [&](const auto& law) -> EquationOfState {
          if constexpr (requires { law.own_eos(); }) return law.own_eos();
          if constexpr (SetsPressure<std::decay_t<decltype(law)>>) return StrengthPressure{law.bulk};
          return elastic_bulk(strength, common, input);
        },
        strength);
  }
  const bool own_pressure = std::visit(
      [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        return SetsPressure<Law> || requires { requires Law::own_pressure; };
      },
      strength);
  if (own_pressure) {
    throw core::InputErrors(
        input.eos->source, "EquationOfState",
        input.strength.type + " computes its pressure itself: remove the EquationOfState");
  }
  return make_law<EquationOfState>(*input.eos, "EquationOfState", input.reference_density);
}

/// Tells the strength model of the equation of state beside it, where it asks.
void couple(StrengthModel& strength, const EquationOfState& equation, const core::MaterialInput& input) {
  const std::string fault = std::visit(
      [](auto& law, const auto& eos) -> std::string {
        if constexpr (requires { law.couple(eos); }) return law.couple(eos);
        return {};
      },
      strength, equation);
  if (!fault.empty()) throw core::InputErrors(input.strength.source, "StrengthModel", fault);
}

/// Hands the places of lighting to an explosive.
void light(StrengthModel& strength, const core::MaterialInput& input,
           const std::vector<core::DetonationItem>& detonations) {
  auto* const explosive = std::get_if<HighExpBurn>(&strength);
  if (explosive == nullptr) return;
  explosive->sources = detonations;
  if (explosive->inert()) {
    throw core::InputErrors(input.strength.source, "StrengthModel",
                            "HighExpBurn with beta 2 burns only where it is lit: add a Detonation");
  }
}

void check_conduction(const core::MaterialInput& input, const CommonParameters& common) {
  if (common.conductivity > 0 && !(common.specific_heat > 0)) {
    throw core::InputErrors(input.strength.source, "StrengthModel",
                            "CoefficientOfThermalConductivity needs SpecHeat");
  }
}

/// Whether the equation's pressure depends on the energy, and so on heat.
bool depends_on_energy(const EquationOfState& equation) {
  return std::visit(
      [](const auto& eos) {
        bool depends = false;
        for (const double mu : {-0.1, 0.0, 0.1}) {
          EosPoint<double> point{};
          point.compression = mu;
          point.relative_volume = 1 / (1 + mu);
          if constexpr (requires { eos.line(point); }) depends = depends || eos.line(point).b != 0;
        }
        return depends;
      },
      equation);
}

void check_expansion(const core::MaterialInput& input, const Material::Laws& laws) {
  if (laws.common.temperature_coefficient == 0) return;
  const auto fault = [&](const std::string& text) {
    throw core::InputErrors(input.strength.source, "StrengthModel", text);
  };
  if (!(laws.common.specific_heat > 0)) fault("TemperatureCoefficient needs SpecHeat");
  const bool sets_pressure = std::visit(
      [](const auto& law) {
        return requires { requires std::decay_t<decltype(law)>::sets_pressure; };
      },
      laws.strength);
  if (sets_pressure) {
    fault(input.strength.type + " computes its pressure itself, without TemperatureCoefficient: remove it");
  }
  if (depends_on_energy(laws.eos)) {
    fault("TemperatureCoefficient must be 0 with " + input.eos->type +
          ", whose pressure already grows with the energy of heating");
  }
}

}  // namespace

std::unique_ptr<core::ConstitutiveModel> make_material(const core::MaterialInput& input,
                                                       const std::vector<core::DetonationItem>& detonations) {
  Material::Laws laws;
  laws.name = input.name;
  laws.reference_density = input.reference_density;
  read_parameters(laws.common, input.strength);
  check_conduction(input, laws.common);
  laws.strength = make_law<StrengthModel>(input.strength, "StrengthModel", input.reference_density);
  light(laws.strength, input, detonations);
  laws.eos = make_eos(input, laws.strength, laws.common);
  couple(laws.strength, laws.eos, input);
  if (input.eos) read_parameters(laws.common_eos, *input.eos);
  check_expansion(input, laws);
  laws.random_failure = input.random_failure;
  std::visit(
      [&](const auto& eos) {
        if constexpr (requires { eos.solid_has_sound_speed(); }) {
          if (eos.solid_has_sound_speed()) laws.common_eos.c0 = 0;  // not that of the porous material
        }
      },
      laws.eos);
  for (const core::FailureInput& failure : input.failures) {
    laws.failures.push_back(
        {make_law<FailureModel>(failure, "FailureModel", input.reference_density), failure.erosion});
  }
  return std::make_unique<Material>(std::move(laws));
}

std::vector<std::unique_ptr<core::ConstitutiveModel>> make_materials(const core::Scene& scene) {
  std::vector<std::unique_ptr<core::ConstitutiveModel>> materials;
  core::Complaints wrong;
  for (const core::MaterialInput& input : scene.materials)
    wrong.collect([&] { materials.push_back(make_material(input, scene.detonations)); });
  wrong.raise_if_any();
  return materials;
}

}  // namespace mpm::physics
