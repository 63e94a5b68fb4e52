// Interface of a family of shape functions S_i to the passes (core/step). Kernels are templates over it; a
// run chooses one (core/step/make_passes.cpp), so families that are not chosen cost nothing.
//
//   site, node_block    how bricks take particles, and the nodes that a brick keeps for them
//   Place               location of the used lanes of a block of eight particles: found once per pass
//   Scatter<fields>     adds m S, m v S and V sigma grad S of particles to a brick's Sums<fields>, one by one
//                       or a block at once
//   Sums<fields>        sums over a brick's particles; finish() adds them to its nodes' contributions;
//                       optional: replace() puts them in their place
//   Field               the nodal motion of a brick as its particles read it: take_motion() for the velocity
//                       and its increment, take_strain() for the strain velocity; like finish() for the nodes
//                       of a mask alone, if there is one
//   Interpolation       sum_i S_i u_i of the velocity or its increment at a block's particles
//   gradient            sum_i u_i (x) grad S_i of the strain velocity, into rows 0..8 (order of Mat3),
//                       columns at .. at + 7
//   cell_divergence     mean of div u over the cell of each particle, times `factor` (volume update `cell`)
//   columns             the columns that its particles need beyond the mechanics
//   deform              optional: the particles' domains follow the velocity gradient
//   Sample              optional: strain and motion of a block's particles from one reading of the nodes
//   settle              optional: domains that Sample has carried along become those of the next step
//   first_of_domain, columns_of_domain   optional: those of them that locating a particle reads
//   nodes_per_axis      the nodes of a particle along an axis
//   lowest_of           optional: the lowest of a particle's nodes in its brick's node block
//   for_each_node       f(node, S_i, grad S_i) for one particle: for
//                       infrequent terms
//   for_each_weight     optional: the same without the gradient, where that costs much
//   momentum_block      optional: the nodes that momentum and mass reach, where forces reach more
//   needs_cells         optional: whether BrickFrame::cells must be there
//   needs_lighter_cells optional: whether it must be there with CellsAround::beside_lighter, in scenes whose
//                       materials differ much in density; null in others
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
  { S::site } -> std::convertible_to<Site>;
  { S::node_block } -> std::convertible_to<NodeBlockShape>;
  { S::columns() } -> std::same_as<ColumnSet>;
  typename S::template Scatter<mapped::momentum_mass_force>;
  typename S::template Sums<mapped::momentum_mass_force>;
  typename S::Field;
  typename S::Place;
  requires std::constructible_from<typename S::Place, const BrickFrame&, const ColumnLayout&, const double*,
                                   int>;
  typename S::Interpolation;
  requires std::constructible_from<typename S::Interpolation, const typename S::Place&, const double*>;
};

/// Whether the shape functions need to know which cells hold particles.
template <class S>
inline constexpr bool needs_cells = requires {
  requires S::needs_cells;
};

/// Whether particles beside much lighter ones act differently.
template <class S>
inline constexpr bool needs_lighter_cells = requires {
  requires S::needs_lighter_cells;
};

/// The nodes that the momentum and mass of a brick's particles reach.
template <class S>
inline constexpr NodeBlockShape momentum_block = [] {
  if constexpr (requires { S::momentum_block; }) return S::momentum_block;
  return S::node_block;
}();

/// f(node, S_i) for one particle.
template <ShapePolicy S, class F>
void for_each_weight(const typename S::Place& place, int lane, const Vec3<double>& inverse_cell, F f) {
  if constexpr (requires { S::for_each_weight(place, lane, f); })
    S::for_each_weight(place, lane, f);
  else
    S::for_each_node(place, lane, inverse_cell,
                     [&](int node, double shape, const Vec3<double>&) { f(node, shape); });
}

/// Values that the particles of a block map to the grid, by lane.
struct MappedRows {
  alignas(64) double mass[block_lanes];
  alignas(64) double momentum[3][block_lanes];
  alignas(64) double stress[6][block_lanes];  ///< V sigma: xx, yy, zz, xy, yz, xz
};

/// Whether a brick's sums replace the nodes' contributions or are added to them.
enum class Onto { nothing, contributions };

/// Adds the first `used` particles of a block to a brick's sums.
template <class Scatter, class Place, class Rows>
[[gnu::always_inline]] inline void add_particles(Scatter& running, const BrickFrame& frame,
                                                 const Place& place, int used, const Rows& rows,
                                                 double* records) {
  if constexpr (requires { running.add_block(frame, place, used, rows, records); }) {
    running.add_block(frame, place, used, rows, records);
  } else {
    for (int i = 0; i < used; ++i) running.add(frame, place, i, rows, records);
  }
}

}  // namespace mpm::core
