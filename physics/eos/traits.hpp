// Properties of an equation of state for the strength model and the material.
#pragma once

#include <optional>

#include "core/particles/columns.hpp"

namespace mpm::physics {

struct EosTraits {
  core::ColumnSet columns;               ///< of its state
  std::optional<double> crush_pressure;  ///< stress, where pores begin to close; unset if the law has none
  bool solid_has_sound_speed = false;    ///< C0 is that of the solid in a porous material
};

}  // namespace mpm::physics
