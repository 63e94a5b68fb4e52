#include "physics/checks/law_checks.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

#include "core/units/units.hpp"
#include "physics/checks/checker.hpp"

namespace mpm::physics {

namespace {

constexpr std::array<LawCheck, 15> all{{
    {"instances", "the instances for one number and for vectors agree to round-off", checks::instances_agree},
    {"rest", "without strain there is no stress", checks::rest_stays},
    {"restart", "a restart from the columns alone continues bitwise identically", checks::restarts},
    {"units", "the results are the same in SI and in mm-g-ms", checks::units_agree},
    {"neighbours", "the result of a particle does not depend on its lane or its neighbours",
     checks::neighbours_do_not_matter},
    {"undeclared", "columns that are not declared are neither read nor written", checks::columns_suffice},
    {"declared", "columns that are declared are used", checks::columns_are_used},
    {"yield", "each plastic step ends on the yield surface, each other one below it",
     checks::ends_on_yield_surface},
    {"dissipation", "plastic flow and viscous flow never release energy", checks::dissipates},
    {"convergence", "the stress converges with first order or better as the step is refined",
     checks::converges},
    {"objectivity", "ten superposed rotations rotate the stress and change nothing else", checks::objective},
    {"energy", "internal energy is the work of all stresses", checks::energy_balances},
    {"wave", "the wave speed is that of the stiffest tangent, or above", checks::wave_speed_bounds_tangent},
    {"tangent", "the tangent, where the law has one, is the derivative of the stress",
     checks::tangent_is_derivative},
    {"pure", "the tangent changes nothing, and depends on no neighbour", checks::tangent_is_pure},
}};

}  // namespace

std::span<const LawCheck> law_checks() { return all; }

const LawCheck& law_check(std::string_view name) {
  const auto found = std::ranges::find(all, name, &LawCheck::name);
  if (found == all.end()) throw std::logic_error("no check of the laws is called " + std::string(name));
  return *found;
}

core::MaterialInput in_units(const core::MaterialInput& input, const core::Catalogue& catalogue,
                             double per_length, double per_mass, double per_time) {
  const auto factor = [&](const core::Dimension& d) {
    return std::pow(per_length, d.length) * std::pow(per_mass, d.mass) * std::pow(per_time, d.time);
  };
  const auto convert = [&](core::LawInput& law, const std::vector<core::TypeInfo>& types,
                           const std::vector<core::ParameterInfo>& common) {
    const core::ParameterValues before = law.values;
    const core::ExponentOf exponent = [&](std::string_view name) -> std::optional<double> {
      const auto found = before.find(name);
      return found == before.end() ? 1.0 : found->second;
    };
    const auto apply = [&](const std::vector<core::ParameterInfo>& table) {
      for (const core::ParameterInfo& p : table) {
        const auto value = before.find(p.name);
        if (value != before.end())
          law.values[std::string(p.name)] =
              value->second * factor(core::parse_dimension(p.dimension, exponent));
      }
    };
    apply(common);
    for (const core::TypeInfo& type : types) {
      if (type.name == law.type) apply(type.parameters);
    }
  };
  core::MaterialInput converted = input;
  converted.reference_density *= per_mass / std::pow(per_length, 3);
  convert(converted.strength, catalogue.strength, catalogue.common_strength);
  if (converted.eos) convert(*converted.eos, catalogue.eos, catalogue.common_eos);
  for (core::FailureInput& failure : converted.failures) convert(failure, catalogue.failure, {});
  return converted;
}

}  // namespace mpm::physics
