// Bricks: blocks of 4 x 4 x 4 cells of the background grid. Only bricks with particles exist.
//
// A brick owns a copy of every node that its particles touch: 5 x 5 x 5 with linear shape functions, more by
// `halo` on each side with wider ones. Nodes on the faces exist in every brick that shares them; all copies
// are summed from the same contributions in the same order, so they agree to the last bit without being
// exchanged.
#pragma once

#include <array>
#include <cmath>
#include <compare>
#include <cstdint>

#include "core/scene/grid.hpp"
#include "core/tensor/tensor.hpp"

namespace mpm::core {

inline constexpr int brick_cells = 4;

/// Brick (x, y, z) holds cells 4x .. 4x+3 along x and so on; 0 <= component < 2^21.
struct BrickCoord {
  std::int32_t x = 0, y = 0, z = 0;
  auto operator<=>(const BrickCoord&) const = default;
  friend BrickCoord operator+(BrickCoord a, BrickCoord b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend BrickCoord operator-(BrickCoord a, BrickCoord b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};

/// One number per brick, ordered by z, then y, then x; coordinates outside the grid have keys of their own.
using BrickKey = std::uint64_t;
constexpr BrickKey key_of(BrickCoord b) {
  constexpr std::uint64_t mask = (1u << 21) - 1;
  return ((static_cast<std::uint64_t>(b.z) & mask) << 42) | ((static_cast<std::uint64_t>(b.y) & mask) << 21) |
         (static_cast<std::uint64_t>(b.x) & mask);
}
constexpr BrickCoord brick_of_key(BrickKey k) {
  constexpr std::uint64_t mask = (1u << 21) - 1;
  return {static_cast<std::int32_t>(k & mask), static_cast<std::int32_t>((k >> 21) & mask),
          static_cast<std::int32_t>((k >> 42) & mask)};
}

/// The 27 offsets of a brick's neighbourhood, in the order in which contributions are summed; 13 is itself.
inline constexpr int neighbourhood = 27;
inline constexpr int self_index = 13;
constexpr BrickCoord neighbour_offset(int n) { return {n % 3 - 1, (n / 3) % 3 - 1, n / 9 - 1}; }

/// The regular background grid: where nodes are, and what its faces do.
struct GridGeometry {
  Vec3<double> origin{};  ///< lower corner, length
  Vec3<double> cell{};    ///< cell edges, length
  Vec3<double> inverse_cell{};
  std::array<std::int64_t, 3> cells{};  ///< along each axis; nodes are one more
  std::array<Boundary, 6> boundary{};   ///< x lower, x upper, y lower, ...
  double mass_cutoff = 0;               ///< mass below which a node is left out

  double smallest_cell() const { return std::fmin(cell.x, std::fmin(cell.y, cell.z)); }
  double cell_volume() const { return cell.x * cell.y * cell.z; }

  /// Position in cells from the origin. The kernels subtract their brick's first cell from it, which may
  /// round differently within one ulp of a face: they clamp, and a particle there may live in either brick.
  template <class T>
  static T scaled(T x, double origin, double inverse_cell) {
    return (x - T(origin)) * T(inverse_cell);
  }
  /// Cell along `axis`; a particle exactly on the upper face belongs to the last cell.
  std::int64_t cell_index(double x, int axis) const {
    const double s = scaled(x, origin[axis], inverse_cell[axis]);
    const double c = std::floor(s);
    const auto n = static_cast<double>(cells[static_cast<std::size_t>(axis)]);
    return static_cast<std::int64_t>(c == n && s == n ? c - 1 : c);
  }
  bool contains(const Vec3<double>& x) const {
    for (int a = 0; a < 3; ++a) {
      const double s = scaled(x[a], origin[a], inverse_cell[a]);
      if (!(s >= 0 && s <= static_cast<double>(cells[static_cast<std::size_t>(a)]))) return false;
    }
    return true;
  }
  BrickCoord brick_at(const Vec3<double>& x) const {
    return {static_cast<std::int32_t>(cell_index(x.x, 0) / brick_cells),
            static_cast<std::int32_t>(cell_index(x.y, 1) / brick_cells),
            static_cast<std::int32_t>(cell_index(x.z, 2) / brick_cells)};
  }
  /// Highest cell along `axis` that a particle of this brick can be in, counted from the brick's first.
  int last_cell(BrickCoord b, int axis) const {
    const std::int64_t first = std::int64_t{brick_cells} * (axis == 0 ? b.x : axis == 1 ? b.y : b.z);
    const std::int64_t left = cells[static_cast<std::size_t>(axis)] - 1 - first;
    return static_cast<int>(left < brick_cells - 1 ? left : brick_cells - 1);
  }
};

/// Widest halo of nodes. With two layers, bricks two apart would hold the same nodes, and the 27 of a
/// neighbourhood would not be all that a node's sum needs.
inline constexpr int most_halo = 1;

/// Nodes of one brick's array. Node (i, j, k) counts from the brick's lowest node, -halo <= i < side - halo.
struct NodeBlockShape {
  int halo = 0;
  constexpr int side() const { return brick_cells + 1 + 2 * halo; }
  constexpr int nodes() const { return side() * side() * side(); }
  int index(int i, int j, int k) const { return (i + halo) + side() * ((j + halo) + side() * (k + halo)); }
};

/// A scheme maps to the nodes twice per step at most, and the first sums are still wanted after the second
/// map: so there are two arrays. Records of the first: momentum 3, mass, force 3, (free); of the second:
/// momentum 3, mass.
enum class NodeArray { first, second };
inline constexpr int node_doubles = 8;
constexpr int record_doubles(NodeArray of) {
  return of == NodeArray::first ? node_doubles : node_doubles / 2;
}

}  // namespace mpm::core
