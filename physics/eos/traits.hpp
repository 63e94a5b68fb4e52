// Properties of an equation of state for the strength model and the material.
#pragma once

#include <optional>
#include <string_view>

#include "core/particles/columns.hpp"

namespace mpm::physics {

struct EosTraits {
  std::string_view name;                 ///< in the input; empty where the input does not name it
  bool has_tangent = false;              ///< `has_tangent` (physics/material/instance.hpp)
  core::ColumnSet columns;               ///< of its state
  std::optional<double> crush_pressure;  ///< stress, where pores begin to close; unset if the law has none
  bool solid_has_sound_speed = false;    ///< C0 is that of the solid in a porous material
};

}  // namespace mpm::physics
