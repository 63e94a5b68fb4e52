// Trilinear shape functions as the kernels see them: where a block's particles lie in their brick, and the
// value or gradient of a nodal field there (thesis 2-17, 2-20).
#pragma once

#include <algorithm>

#include "core/grid/brick.hpp"

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

/// The eight nodes of a cell, counted from its lowest: number i + 2 j + 4 k.
struct CellCorners {
  int node[8];
  int offset[8];  ///< in doubles, for node records of node_doubles
  explicit CellCorners(int side) {
    for (int n = 0; n < 8; ++n) {
      node[n] = (n & 1) + side * (((n >> 1) & 1) + side * (n >> 2));
      offset[n] = node_doubles * node[n];
    }
  }
};

/// The eight corner values of one component, with the differences along x.
struct CornerValues {
  double a00, a10, a01, a11, d00, d10, d01, d11;  // indices: j, k
  CornerValues(const double* lowest, const CellCorners& c)
      : a00(lowest[c.offset[0]]),
        a10(lowest[c.offset[2]]),
        a01(lowest[c.offset[4]]),
        a11(lowest[c.offset[6]]),
        d00(lowest[c.offset[1]] - a00),
        d10(lowest[c.offset[3]] - a10),
        d01(lowest[c.offset[5]] - a01),
        d11(lowest[c.offset[7]] - a11) {}
};

template <class T>
inline T interpolate(const CornerValues& n, const Located<T>& p) {
  const T a0 = T(n.a00) + p.fx * T(n.d00), a1 = T(n.a10) + p.fx * T(n.d10);
  const T a2 = T(n.a01) + p.fx * T(n.d01), a3 = T(n.a11) + p.fx * T(n.d11);
  const T b0 = a0 + p.fy * (a1 - a0), b1 = a2 + p.fy * (a3 - a2);
  return b0 + p.fz * (b1 - b0);
}

/// Gradient with respect to the scaled coordinates (per cell, not per length).
template <class T>
inline Vec3<T> scaled_gradient(const CornerValues& n, const Located<T>& p) {
  const T a0 = T(n.a00) + p.fx * T(n.d00), a1 = T(n.a10) + p.fx * T(n.d10);
  const T a2 = T(n.a01) + p.fx * T(n.d01), a3 = T(n.a11) + p.fx * T(n.d11);
  const T y0 = a1 - a0, y1 = a3 - a2;
  const T b0 = a0 + p.fy * y0, b1 = a2 + p.fy * y1;
  const T x0 = T(n.d00) + p.fy * T(n.d10 - n.d00), x1 = T(n.d01) + p.fy * T(n.d11 - n.d01);
  return {x0 + p.fz * (x1 - x0), y0 + p.fz * (y1 - y0), b1 - b0};
}

/// f(node, mask) once for every distinct cell among the lanes: mask tells the lanes that lie in it.
template <class T, class F>
inline void for_each_cell(const Located<T>& p, F f) {
  constexpr int width = LaneTraits<T>::width;
  if constexpr (width == 1) {
    f(p.node[0], true);
  } else {
    double node[width];
    for (int i = 0; i < width; ++i) node[i] = p.node[i];
    const T nodes = load<T>(node);
    unsigned pending = (1u << width) - 1;
    while (pending != 0) {
      const int n = p.node[__builtin_ctz(pending)];
      unsigned here = 0;
      for (int i = 0; i < width; ++i) here |= static_cast<unsigned>(p.node[i] == n) << i;
      f(n, nodes == T(double(n)));
      pending &= ~here;
    }
  }
}

}  // namespace mpm::core
