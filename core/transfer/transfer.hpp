// Velocity transfer between particles and grid: the momentum that a particle maps, and its update from the
// new nodal velocities. Kernels are templates over a transfer as they are over the shape functions; a run
// chooses one (core/step/make_passes.cpp).
//
//   columns             the columns its particles need beyond the mechanics
//   momentum            rows of mass and momentum that a block maps
//   update_velocities   the particles' velocities from the nodal motion
#pragma once

#include "core/shape/shape.hpp"

namespace mpm::core {

template <class T>
concept TransferPolicy = requires(const ColumnLayout& layout, const double* block, MappedRows& rows) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::columns() } -> std::same_as<ColumnSet>;
  T::momentum(layout, block, rows);
};

}  // namespace mpm::core
