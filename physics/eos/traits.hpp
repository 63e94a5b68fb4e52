// What an equation of state says of itself to the strength model beside it, and to the material.
#pragma once

#include <optional>

#include "core/particles/columns.hpp"

namespace mpm::physics {

struct EosTraits {
  core::ColumnSet columns;               ///< of its state
  std::optional<double> crush_pressure;  ///< stress, where pores begin to close; none: the law has none
  bool solid_has_sound_speed = false;    ///< C0 is that of the solid in a porous material
};

}  // namespace mpm::physics
