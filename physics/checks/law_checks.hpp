// Properties that every law must have, as tests that also apply to external laws (mpm_point --test): each
// drives a sample of the law, a material with values, along smooth paths through stretch, shear and spin,
// without a grid. None depends on a law's name. tests/physics runs them over a sample of every law of the
// lists; tests/hygiene/consumer over external laws.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/body.hpp"
#include "core/scene/material.hpp"
#include "physics/registry.hpp"

namespace mpm::physics {

struct LawSample {
  core::MaterialInput input;
  std::vector<core::DetonationItem> detonations;
  double strain = 0.02;  ///< largest strain of a path: beyond yield where the law yields
  double duration =
      2e-5;  ///< of a path, in the sample's unit of time; strain rates are about strain/duration
  double cell_size = 1e-3;  ///< length of the artificial viscosity, in the sample's unit of length
};

struct LawCheck {
  std::string_view name;       ///< one word
  std::string_view statement;  ///< the property
  /// The violations, one sentence each. Throws core::InputErrors where the sample's values are rejected.
  std::vector<std::string> (*failures)(const LawSample& sample, const Registry& registry);
};

std::span<const LawCheck> law_checks();
/// Throws std::logic_error if no check has this name.
const LawCheck& law_check(std::string_view name);

/// The sample in other units, by the dimensions of the laws' own tables.
core::MaterialInput in_units(const core::MaterialInput& input, const core::Catalogue& catalogue,
                             double per_length, double per_mass, double per_time);

}  // namespace mpm::physics
