// One material for mpm_point, from an input file or by its name in the library, with overrides of single
// values. The input may lack Component, Grid and Solution.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/catalogue.hpp"
#include "core/scene/material.hpp"
#include "core/scene/scene.hpp"
#include "core/units/units.hpp"

namespace mpm::io {

/// Source of the material and the values to change.
struct MaterialRequest {
  std::string material;  ///< its name; empty where the input has only one
  /// "Yield0=120", "StrengthModel.Yield0=120", "Yield0=120 MPa", "ReferenceDensity=8.9e-3"
  std::vector<std::string> settings;
};

struct MaterialChoice {
  core::MaterialInput material;
  std::vector<core::DetonationItem> detonations;
  int volume_update = 0;                  ///< of Solution / Volume, where there is one
  std::optional<core::UnitSystem> units;  ///< if the input states them
};

/// All throw core::InputErrors.
MaterialChoice read_material(const std::filesystem::path& job, const core::Catalogue& catalogue,
                             const MaterialRequest& request);
MaterialChoice parse_material(std::string_view bytes, const std::filesystem::path& file,
                              const core::Catalogue& catalogue, const MaterialRequest& request);
/// `names` as in Material / library, `units` as in Material / units.
MaterialChoice library_material(std::string_view names, std::string_view units,
                                const core::Catalogue& catalogue, std::vector<std::string> settings = {});

}  // namespace mpm::io
