// Bricks: blocks of 4 x 4 x 4 cells of the background grid. Only bricks with particles exist.
//
// A brick owns a copy of every node that its particles touch: 5 x 5 x 5 with linear shape functions, more
// with wider ones. Every brick that shares a node has a copy; all copies are summed from the same
// contributions in the same order, so they agree bit for bit without being exchanged.
//
// Shape functions of two or four nodes per axis are polynomials within a cell; those of three nodes per axis
// are so around a node, half a cell to each side. A brick therefore holds the particles of 4 x 4 x 4 sites,
// which are cells for the former and the surroundings of nodes for the latter: 6 x 6 x 6 nodes instead of
// 7 x 7 x 7, and 1000 contributions per sum instead of 2197.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>

#include "core/scene/grid.hpp"
#include "core/tensor/tensor.hpp"

namespace mpm::core {

inline constexpr int brick_cells = 4;

/// What a brick's particles have in common.
enum class Site { cell, node };

/// Brick (x, y, z) of level 0 holds sites 4x .. 4x+3 along x and so on; 0 <= component < 2^21. The cells of a
/// brick of level n > 0 are smaller by 2^n; no run creates such bricks yet.
struct BrickCoord {
  std::int32_t x = 0, y = 0, z = 0;
  std::int32_t level = 0;
  auto operator<=>(const BrickCoord&) const = default;
  friend BrickCoord operator+(BrickCoord a, BrickCoord b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z, a.level + b.level};
  }
  friend BrickCoord operator-(BrickCoord a, BrickCoord b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z, a.level - b.level};
  }
};

/// One number per brick, ordered by z, then y, then x; coordinates outside the grid have distinct keys. Level
/// 0 has 21 bits per axis. In finer levels the highest bit is set, the level follows in three bits, and 20
/// bits per axis remain.
using BrickKey = std::uint64_t;
inline constexpr int most_brick_levels = 8;  ///< levels are numbered 0 .. 7
constexpr BrickKey key_of(BrickCoord b) {
  const int bits = b.level == 0 ? 21 : 20;
  const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  const BrickKey place = ((static_cast<std::uint64_t>(b.z) & mask) << 2 * bits) |
                         ((static_cast<std::uint64_t>(b.y) & mask) << bits) |
                         (static_cast<std::uint64_t>(b.x) & mask);
  return b.level == 0 ? place
                      : place | std::uint64_t{1} << 63 | (static_cast<std::uint64_t>(b.level) & 7) << 60;
}
constexpr BrickCoord brick_of_key(BrickKey k) {
  const bool fine = (k >> 63) != 0;
  const int bits = fine ? 20 : 21;
  const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  return {static_cast<std::int32_t>(k & mask), static_cast<std::int32_t>((k >> bits) & mask),
          static_cast<std::int32_t>((k >> 2 * bits) & mask),
          fine ? static_cast<std::int32_t>(k >> 60 & 7) : 0};
}

/// The 27 offsets of a brick's neighbourhood, in the order in which contributions are summed; 13 is itself.
inline constexpr int neighbourhood = 27;
inline constexpr int self_index = 13, lower_x_index = 12;
constexpr BrickCoord neighbour_offset(int n) { return {n % 3 - 1, (n / 3) % 3 - 1, n / 9 - 1}; }

/// The regular background grid: position of the nodes and boundary conditions on its faces.
struct GridGeometry {
  Vec3<double> origin{};  ///< lower corner, length
  Vec3<double> cell{};    ///< cell edges, length
  Vec3<double> inverse_cell{};
  std::array<std::int64_t, 3> cells{};  ///< along each axis; one node more
  std::array<Boundary, 6> boundary{};   ///< x lower, x upper, y lower, ...
  double mass_cutoff = 0;               ///< nodes of smaller mass are ignored
  Site site = Site::cell;

  double smallest_cell() const { return std::fmin(cell.x, std::fmin(cell.y, cell.z)); }
  double cell_volume() const { return cell.x * cell.y * cell.z; }

  /// Position in cells from the origin. The kernels subtract their brick's first site from it, which may
  /// round differently within one ulp of a face: they clamp, and a particle there may be in either brick.
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
  /// Of node (i, j, k) of a brick (NodeBlockShape).
  Vec3<double> node_place(BrickCoord b, const std::array<int, 3>& node) const {
    const double along[3] = {double(std::int64_t{brick_cells} * b.x + node[0]),
                             double(std::int64_t{brick_cells} * b.y + node[1]),
                             double(std::int64_t{brick_cells} * b.z + node[2])};
    return {origin.x + along[0] * cell.x, origin.y + along[1] * cell.y, origin.z + along[2] * cell.z};
  }
  bool contains(const Vec3<double>& x) const {
    for (int a = 0; a < 3; ++a) {
      const double s = scaled(x[a], origin[a], inverse_cell[a]);
      if (!(s >= 0 && s <= static_cast<double>(cells[static_cast<std::size_t>(a)]))) return false;
    }
    return true;
  }
  /// Sites along `axis`; around a node on the grid's faces, only half a site is inside.
  std::int64_t sites(int axis) const {
    return cells[static_cast<std::size_t>(axis)] + (site == Site::node ? 1 : 0);
  }
  /// Where the first site begins, in cells from the origin.
  double first_site() const { return site == Site::node ? -0.5 : 0; }
  /// The cell of a particle, or the node nearest to it.
  std::int64_t site_index(double x, int axis) const {
    if (site == Site::cell) return cell_index(x, axis);
    return static_cast<std::int64_t>(std::floor(scaled(x, origin[axis], inverse_cell[axis]) + 0.5));
  }
  BrickCoord brick_at(const Vec3<double>& x) const {
    return {static_cast<std::int32_t>(site_index(x.x, 0) / brick_cells),
            static_cast<std::int32_t>(site_index(x.y, 1) / brick_cells),
            static_cast<std::int32_t>(site_index(x.z, 2) / brick_cells)};
  }
  /// Highest site along `axis` of this brick's particles, counted from the brick's first.
  int last_site(BrickCoord b, int axis) const {
    const std::int64_t first = std::int64_t{brick_cells} * (axis == 0 ? b.x : axis == 1 ? b.y : b.z);
    const std::int64_t left = sites(axis) - 1 - first;
    return static_cast<int>(left < brick_cells - 1 ? left : brick_cells - 1);
  }
};

/// Most layers of nodes on a side of a brick's own. With two, bricks two apart would share nodes, and the sum
/// over the 27 bricks of a neighbourhood would be incomplete.
inline constexpr int most_layers = 1;

/// Node block of one brick. Node (i, j, k) counts from the lowest node of the brick's first cell, or from the
/// node of its first site: lowest() <= i <= highest().
struct NodeBlockShape {
  int below = 0, above = 0;  ///< layers beyond nodes 0 and brick_cells
  constexpr int lowest() const { return -below; }
  constexpr int highest() const { return brick_cells + above; }
  constexpr int side() const { return brick_cells + 1 + below + above; }
  constexpr int nodes() const { return side() * side() * side(); }
  constexpr int index(int i, int j, int k) const {
    return (i + below) + side() * ((j + below) + side() * (k + below));
  }
  /// (i, j, k) of the node with this index.
  constexpr std::array<int, 3> node(int index) const {
    return {index % side() - below, index / side() % side() - below, index / (side() * side()) - below};
  }
  constexpr bool operator==(const NodeBlockShape&) const = default;
};

/// Some nodes of a block, row by row along x; a row has at most eight.
class NodeMask {
 public:
  /// Those with numbers lowest + i + side (j + side k); i, j, k < n.
  void add(const NodeBlockShape& shape, int lowest, int n) {
    const int side = shape.side(), row = lowest / side;
    const auto bits = static_cast<std::uint8_t>(((1 << n) - 1) << lowest % side);
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j) rows_[static_cast<std::size_t>(row + j + side * k)] |= bits;
  }
  /// Whether it has nodes (i, j, k) for any i.
  bool has_row(const NodeBlockShape& shape, int j, int k) const {
    return rows_[static_cast<std::size_t>(j + shape.below + shape.side() * (k + shape.below))] != 0;
  }
  /// f(first, count) for consecutive nodes.
  template <class F>
  void for_each(const NodeBlockShape& shape, F f) const {
    const int side = shape.side();
    for (int row = 0; row < side * side; ++row) {
      for (unsigned left = rows_[static_cast<std::size_t>(row)]; left != 0;) {
        const int first = std::countr_zero(left), count = std::countr_one(left >> first);
        f(row * side + first, count);
        left &= ~0u << (first + count);
      }
    }
  }

  /// f(i, j, k) with the lowest node of every cell of which it has all nodes.
  template <class F>
  void for_each_cell(const NodeBlockShape& shape, F f) const {
    const auto row = [&](int j, int k) -> unsigned {
      return rows_[static_cast<std::size_t>(j + shape.below + shape.side() * (k + shape.below))];
    };
    for (int k = shape.lowest(); k < shape.highest(); ++k) {
      for (int j = shape.lowest(); j < shape.highest(); ++j) {
        unsigned left = row(j, k) & row(j + 1, k) & row(j, k + 1) & row(j + 1, k + 1);
        for (left &= left >> 1; left != 0; left &= left - 1) f(shape.lowest() + std::countr_zero(left), j, k);
      }
    }
  }

 private:
  static constexpr int widest = NodeBlockShape{most_layers, most_layers}.side();
  static_assert(widest <= 8);
  std::array<std::uint8_t, widest * widest> rows_{};
};

/// Nodes of a block: of a smaller block in it, or `some`.
struct NodeSelection {
  NodeBlockShape of, part;
  const NodeMask* some = nullptr;
  int nodes() const { return part.nodes(); }  ///< at most
  /// f(first, count) for consecutive nodes: rows along x, or all at once.
  template <class F>
  void for_each(F f) const {
    if (some != nullptr) return some->for_each(of, f);
    if (part == of) return f(0, of.nodes());
    for (int k = part.lowest(); k <= part.highest(); ++k)
      for (int j = part.lowest(); j <= part.highest(); ++j) f(of.index(part.lowest(), j, k), part.side());
  }
};

}  // namespace mpm::core
