// Velocity transfer between particles and grid: the momentum that a particle maps, and its update from the
// new nodal velocities. Kernels are templates over a transfer as they are over the shape functions; a run
// chooses one (core/step/make_passes.cpp).
//
//   columns             the columns its particles need beyond the mechanics
//   Rows                what a block maps: MappedRows, or AffineRows
//   momentum            rows of mass and momentum that a block maps
//   update_velocities   the particles' velocities from the nodal motion
//   share_of_nodes      the part of these that the nodes' velocities are, not those before and increments
#pragma once

#include "core/scene/solution.hpp"
#include "core/shape/shape.hpp"

namespace mpm::core {

/// A velocity that is linear in space: the momentum at the lowest node of each particle's support, and its
/// increase from node to node along the axes, [component][axis].
struct AffineRows : MappedRows {
  alignas(64) double increase[3][3][block_lanes];
};

/// What a transfer knows of the step.
struct TransferStep {
  double courant = 0;  ///< the step over the time in which a wave crosses a cell
};

template <class T>
concept TransferPolicy = requires(const T& transfer, const TransferStep& step) {
  { transfer.share_of_nodes(step) } -> std::convertible_to<double>;
  { T::name } -> std::convertible_to<std::string_view>;
  { T::columns() } -> std::same_as<ColumnSet>;
  typename T::Rows;
  requires std::constructible_from<T, const SolutionInput&>;
};

}  // namespace mpm::core
