// Assignment of bricks to ranks: boxes of the grid, parts of the graph of bricks, or segments of a
// space-filling curve. No communication here, and no result depends on the decomposition, only the load
// balance.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/communication/brick_directory.hpp"
#include "core/grid/brick.hpp"

namespace mpm::parallel {

/// Nodes that a brick's node block shares with that of its neighbour `offset` away: 25, 5 or 1 without halo.
int shared_nodes(const core::NodeBlockShape& shape, core::BrickCoord offset);

/// A box of bricks, cut into equal boxes. Bricks outside belong to the nearest box.
class UniformBoxes {
 public:
  UniformBoxes(core::BrickCoord low, std::array<std::int32_t, 3> extent, std::array<int, 3> parts)
      : low_(low), extent_(extent), parts_(parts) {}
  /// Rank of the box; boxes are numbered along x first, then y, then z.
  int owner(core::BrickCoord b) const;
  const std::array<int, 3>& parts() const { return parts_; }

 private:
  core::BrickCoord low_;
  std::array<std::int32_t, 3> extent_;  ///< in bricks
  std::array<int, 3> parts_;
};

/// The whole background grid, including empty parts.
UniformBoxes boxes_of_grid(const core::GridGeometry& geometry, std::array<int, 3> parts);
/// The bounding box of these bricks, cut into one box per rank with the smallest area of the cuts.
UniformBoxes boxes_of_bricks(std::span<const core::BrickCount> bricks, int ranks);

/// Owner of every brick: of the proposals by METIS (recursive bisection and k-way) and by a curve, the one
/// with the fewest nodes shared between ranks among those that give no rank more than `tolerance` times its
/// share of the particles; if there is none, the best balanced one. With no more bricks than ranks, the
/// curve's. Each brick must occur once.
std::vector<std::int32_t> split_graph(std::span<const core::BrickCount> bricks,
                                      const core::NodeBlockShape& shape, int ranks, double tolerance);
/// Owner of every brick along Morton's curve, cut into segments of nearly equal numbers of particles.
std::vector<std::int32_t> split_curve(std::span<const core::BrickCount> bricks, int ranks);

}  // namespace mpm::parallel
