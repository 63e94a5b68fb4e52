// Trilinear shape functions as the kernels see them: where a block's particles lie in their brick, and the
// value or gradient of a nodal field there (thesis 2-17, 2-20).
#pragma once

#include <algorithm>
#include <cstring>

#include "core/grid/brick.hpp"
#include "core/particles/columns.hpp"

namespace mpm::core {

/// One brick in the coordinates in which its particles are located.
struct BrickFrame {
  Vec3<double> origin, inverse_cell;
  Vec3<double> first_cell;  ///< of the brick, counted from the grid's origin
  Vec3<double> last_cell;   ///< highest cell that a particle can be in, counted from the brick's first
  int side = 0, halo = 0;

  BrickFrame(const GridGeometry& g, const NodeBlockShape& shape, BrickCoord b)
      : origin(g.origin),
        inverse_cell(g.inverse_cell),
        first_cell{double(brick_cells * b.x), double(brick_cells * b.y), double(brick_cells * b.z)},
        last_cell{double(g.last_cell(b, 0)), double(g.last_cell(b, 1)), double(g.last_cell(b, 2))},
        side(shape.side()),
        halo(shape.halo) {}

  int node_of_cell(double i, double j, double k) const {
    return (static_cast<int>(i) + halo) +
           side * ((static_cast<int>(j) + halo) + side * (static_cast<int>(k) + halo));
  }
};

/// Particles in lanes: fraction of the cell's edge from its lower corner, and the cell's lowest node.
template <class T>
struct Located {
  T fx, fy, fz;
  int node[LaneTraits<T>::width];
};

/// `x`, `y`, `z`: columns of a block from the lane on. Lanes out of use are clamped into the brick.
template <class T>
inline Located<T> locate(const BrickFrame& f, const double* x, const double* y, const double* z) {
  const T sx = GridGeometry::scaled(load<T>(x), f.origin.x, f.inverse_cell.x) - T(f.first_cell.x);
  const T sy = GridGeometry::scaled(load<T>(y), f.origin.y, f.inverse_cell.y) - T(f.first_cell.y);
  const T sz = GridGeometry::scaled(load<T>(z), f.origin.z, f.inverse_cell.z) - T(f.first_cell.z);
  // max(s, 0) turns not-a-number into 0, so that an index is always one.
  const T cx = min(max(floor(sx), T(0.0)), T(f.last_cell.x));
  const T cy = min(max(floor(sy), T(0.0)), T(f.last_cell.y));
  const T cz = min(max(floor(sz), T(0.0)), T(f.last_cell.z));
  Located<T> p{sx - cx, sy - cy, sz - cz, {}};
  constexpr int width = LaneTraits<T>::width;
  double node[width];
  store(node, cx + T(double(f.side)) * (cy + T(double(f.side)) * cz));
  const int base = f.halo * (1 + f.side * (1 + f.side));
  for (int i = 0; i < width; ++i) p.node[i] = static_cast<int>(node[i]) + base;
  return p;
}

/// Where the particles of a block lie: located once for everything that a pass does with them.
struct BlockPlace {
  alignas(64) double f[3][block_lanes];  ///< fractions of the cell's edges
  int node[block_lanes];

  BlockPlace() = default;
  BlockPlace(const BrickFrame& frame, const ColumnLayout& layout, const double* block) {
    find(frame, layout, block);
  }
  void find(const BrickFrame& frame, const ColumnLayout& layout, const double* block) {
    const double* x = block + layout.offset(Column::position_x);
    for (int l = 0; l < block_lanes; l += real_width) {
      const auto p = locate<Real>(frame, x + l, x + block_lanes + l, x + 2 * block_lanes + l);
      store(f[0] + l, p.fx);
      store(f[1] + l, p.fy);
      store(f[2] + l, p.fz);
      for (int i = 0; i < real_width; ++i) node[l + i] = p.node[i];
    }
  }
};

/// Node number `n` = i + 2 j + 4 k of a cell, counted from its lowest node. Of bricks without a halo, as
/// these functions have them: so the compiler knows every distance.
constexpr int corner_node(int n) {
  constexpr int side = brick_cells + 1;
  return (n & 1) + side * (((n >> 1) & 1) + side * (n >> 2));
}

/// f(corner, node, S, gradient of S) for the corners i + 2 j + 4 k of the cell in which the particle of a
/// lane lies: for what is too rare to be written in lanes.
template <class F>
void for_each_corner(const BlockPlace& place, int lane, const Vec3<double>& inverse_cell, F f) {
  const double fraction[3] = {place.f[0][lane], place.f[1][lane], place.f[2][lane]};
  for (int n = 0; n < 8; ++n) {
    const int bit[3] = {n & 1, (n >> 1) & 1, n >> 2};
    double w[3], slope[3];
    for (int a = 0; a < 3; ++a) {
      w[a] = bit[a] == 1 ? fraction[a] : 1 - fraction[a];
      slope[a] = (bit[a] == 1 ? 1 : -1) * inverse_cell[a];
    }
    f(n, place.node[lane] + corner_node(n), w[0] * w[1] * w[2],
      Vec3<double>{slope[0] * w[1] * w[2], w[0] * slope[1] * w[2], w[0] * w[1] * slope[2]});
  }
}

/// f(lowest node, lanes) for each cell in which particles of the block lie, with the lanes that do.
template <class F>
inline void for_each_cell(const BlockPlace& place, F f) {
  using Mask = LaneMask<block_lanes>;
  typedef int Nodes __attribute__((vector_size(block_lanes * sizeof(int))));
  Nodes nodes;
  std::memcpy(&nodes, place.node, sizeof nodes);
  const auto wide = __builtin_convertvector(nodes, Mask::vector);
  for (unsigned left = (1u << block_lanes) - 1; left != 0;) {
    const int node = place.node[__builtin_ctz(left)];
    const Mask here{wide == std::int64_t{node}};
    left &= ~bits(here);
    f(node, here);
  }
}

}  // namespace mpm::core
