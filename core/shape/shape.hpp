// Interface of a family of shape functions S_i to the passes (core/step). Kernels are templates over it; a
// run chooses one (core/step/make_passes.cpp), so families that are not chosen cost nothing.
//
//   node_block          the nodes that a brick keeps for its particles
//   Place               location of a block of eight particles: found once per pass
//   Scatter<fields>     sums of m S, m v S and V sigma grad S over particles, added to the brick's nodes
//   interpolate         sum_i S_i u_i of three node components at the block's particles
//   gradient            sum_i u_i (x) grad S_i of three node components
//   cell_divergence     mean of div u over the cell of each particle (volume update `cell`)
//   for_each_node       f(node, offset from the lowest node, S_i, grad S_i) for one particle: infrequent
//   terms
//
// Kernels identify a node by its number in the brick's node block and read records of node_doubles.
#pragma once

#include <concepts>

#include "core/grid/node_fields.hpp"
#include "core/particles/columns.hpp"
#include "core/shape/brick_frame.hpp"

namespace mpm::core {

template <class S>
concept ShapePolicy = requires(const BrickFrame& frame, const ColumnLayout& layout, const double* block,
                               const typename S::Place& place) {
  { S::node_block } -> std::convertible_to<NodeBlockShape>;
  typename S::template Scatter<mapped::momentum_mass_force>;
  typename S::Place;
  requires std::constructible_from<typename S::Place, const BrickFrame&, const ColumnLayout&, const double*>;
  typename S::Interpolation;
  requires std::constructible_from<typename S::Interpolation, const typename S::Place&, const double*>;
};

/// Values that the particles of a block map to the grid, by lane.
struct MappedRows {
  alignas(64) double mass[block_lanes];
  alignas(64) double momentum[3][block_lanes];
  alignas(64) double stress[6][block_lanes];  ///< V sigma: xx, yy, zz, xy, yz, xz
};

/// A node of a particle's support, relative to the lowest one.
struct NodeOffset {
  int along[3];
};

}  // namespace mpm::core
