// Trilinear shape functions (thesis 2-17, 2-20): S_i = product over the axes of 1 - |x - x_i|/h on the eight
// nodes of the particle's cell.
//
// Grid to particles: particles in the vector lanes; each distinct cell among the eight particles is visited
// once. Particles to grid: the eight nodes of a cell in the lanes; each particle adds to ten vectors
// (momentum, mass, V sigma), which are converted to node records and written only when the cell changes.
// Particles are stored in approximate cell order, so this happens about once in eight. Shown by
// tests/core/shape/linear_test.cpp and, against a plain loop, tests/core/step.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/shape/shape.hpp"
#include "core/simd/transpose.hpp"

namespace mpm::core {

/// Particles in lanes: position within the cell as fractions of its edges, and the cell's lowest node.
template <class T>
struct LocatedInCells {
  T fx, fy, fz;
  int node[LaneTraits<T>::width];
};

/// `x`, `y`, `z`: columns of a block from the lane on. Unused lanes are clamped into the brick.
template <class T>
inline LocatedInCells<T> locate_in_cells(const BrickFrame& f, const double* x, const double* y,
                                         const double* z) {
  const T sx = GridGeometry::scaled(load<T>(x), f.origin.x, f.inverse_cell.x) - T(f.first_cell.x);
  const T sy = GridGeometry::scaled(load<T>(y), f.origin.y, f.inverse_cell.y) - T(f.first_cell.y);
  const T sz = GridGeometry::scaled(load<T>(z), f.origin.z, f.inverse_cell.z) - T(f.first_cell.z);
  // max(s, 0) maps NaN to 0, so that the index is always valid.
  const T cx = min(max(floor(sx), T(0.0)), T(f.last_cell.x));
  const T cy = min(max(floor(sy), T(0.0)), T(f.last_cell.y));
  const T cz = min(max(floor(sz), T(0.0)), T(f.last_cell.z));
  LocatedInCells<T> p{sx - cx, sy - cy, sz - cz, {}};
  constexpr int width = LaneTraits<T>::width;
  double node[width];
  store(node, cx + T(double(f.side)) * (cy + T(double(f.side)) * cz));
  const int base = f.halo * (1 + f.side * (1 + f.side));
  for (int i = 0; i < width; ++i) p.node[i] = static_cast<int>(node[i]) + base;
  return p;
}

/// Position of a block's particles within their cells.
struct LinearPlace {
  alignas(64) double f[3][block_lanes];  ///< fractions of the cell's edges
  int node[block_lanes];

  LinearPlace() = default;
  LinearPlace(const BrickFrame& frame, const ColumnLayout& layout, const double* block) {
    find(frame, layout, block);
  }
  void find(const BrickFrame& frame, const ColumnLayout& layout, const double* block) {
    const double* x = block + layout.offset(Column::position_x);
    for (int l = 0; l < block_lanes; l += real_width) {
      const auto p = locate_in_cells<Real>(frame, x + l, x + block_lanes + l, x + 2 * block_lanes + l);
      store(f[0] + l, p.fx);
      store(f[1] + l, p.fy);
      store(f[2] + l, p.fz);
      for (int i = 0; i < real_width; ++i) node[l + i] = p.node[i];
    }
  }
};

/// Node number `n` = i + 2 j + 4 k of a cell, relative to its lowest node. These functions use bricks without
/// a halo, so that all strides are compile-time constants.
constexpr int corner_node(int n) {
  constexpr int side = brick_cells + 1;
  return (n & 1) + side * (((n >> 1) & 1) + side * (n >> 2));
}

/// f(lowest node, lanes) for each cell that holds particles of the block, with their lanes.
template <class F>
inline void for_each_cell(const LinearPlace& place, F f) {
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

namespace linear {
using Nodes = Lanes<8>;

/// A node's weight along an axis is 1 - f or f; this is its slope.
inline Nodes sign_x() { return Nodes::vector{-1, 1, -1, 1, -1, 1, -1, 1}; }
inline Nodes sign_y() { return Nodes::vector{-1, -1, 1, 1, -1, -1, 1, 1}; }
inline Nodes sign_z() { return Nodes::vector{-1, -1, -1, -1, 1, 1, 1, 1}; }

/// The weight of the upper node is f, of the lower 1 - f.
inline Nodes one_x() { return Nodes::vector{1, 0, 1, 0, 1, 0, 1, 0}; }
inline Nodes one_y() { return Nodes::vector{1, 1, 0, 0, 1, 1, 0, 0}; }
inline Nodes one_z() { return Nodes::vector{1, 1, 1, 1, 0, 0, 0, 0}; }

/// Each node of an edge along an axis gets the sum of the two.
inline Nodes along_x(Nodes a) { return a.v + __builtin_shufflevector(a.v, a.v, 1, 0, 3, 2, 5, 4, 7, 6); }
inline Nodes along_y(Nodes a) { return a.v + __builtin_shufflevector(a.v, a.v, 2, 3, 0, 1, 6, 7, 4, 5); }
inline Nodes along_z(Nodes a) { return a.v + __builtin_shufflevector(a.v, a.v, 4, 5, 6, 7, 0, 1, 2, 3); }
}  // namespace linear

/// Sums over the particles of one cell, node i + 2 j + 4 k in lane i + 2 j + 4 k. The force on a node is
/// minus the sum of V sigma times the weight's gradient. A gradient component is a sign over the cell's edge
/// times the weights along the other two axes, and that product is the sum of the weights of the edge's two
/// nodes. So V sigma is summed with the weights themselves, and a flush converts the sums to forces.
template <NodeFields what>
struct LinearScatter {
  linear::Nodes px, py, pz, m;
  linear::Nodes xx, yy, zz, xy, yz, xz;  ///< V sigma times the weights
  int node = -1;

  void clear() {
    px = py = pz = m = linear::Nodes(0.0);
    xx = yy = zz = xy = yz = xz = linear::Nodes(0.0);
  }

  /// Particle `i` of the block.
  [[gnu::always_inline]] void add(const BrickFrame& frame, const LinearPlace& place, int i,
                                  const MappedRows& rows, double* contributions) {
    using N = linear::Nodes;
    if (place.node[i] != node) {
      flush(frame, contributions);
      clear();
      node = place.node[i];
    }
    const N wx = linear::one_x() + linear::sign_x() * N(place.f[0][i]),
            wy = linear::one_y() + linear::sign_y() * N(place.f[1][i]),
            wz = linear::one_z() + linear::sign_z() * N(place.f[2][i]);
    const N w = wx * wy * wz;
    if constexpr (maps_momentum(what)) {
      if constexpr (maps_mass(what)) m += w * N(rows.mass[i]);
      px += w * N(rows.momentum[0][i]);
      py += w * N(rows.momentum[1][i]);
      pz += w * N(rows.momentum[2][i]);
    }
    if constexpr (maps_force(what)) {
      xx += w * N(rows.stress[0][i]);
      yy += w * N(rows.stress[1][i]);
      zz += w * N(rows.stress[2][i]);
      xy += w * N(rows.stress[3][i]);
      yz += w * N(rows.stress[4][i]);
      xz += w * N(rows.stress[5][i]);
    }
  }

  /// Adds the cell's sums to the node records of the brick.
  [[gnu::always_inline]] void flush(const BrickFrame& frame, double* contributions) {
    using N = linear::Nodes;
    if (node < 0) return;
    N r[8] = {px, py, pz, m, N(0.0), N(0.0), N(0.0), N(0.0)};
    if constexpr (maps_force(what)) {
      using namespace linear;
      const N gx = sign_x() * N(-frame.inverse_cell.x), gy = sign_y() * N(-frame.inverse_cell.y),
              gz = sign_z() * N(-frame.inverse_cell.z);
      r[4] = gx * along_x(xx) + gy * along_y(xy) + gz * along_z(xz);
      r[5] = gx * along_x(xy) + gy * along_y(yy) + gz * along_z(yz);
      r[6] = gx * along_x(xz) + gy * along_y(yz) + gz * along_z(zz);
    }
    constexpr int width = record_doubles(what.array);
    using Record = Lanes<width>;
    double* lowest = contributions + width * node;
    if constexpr (width == 8) {
      transpose(r);
      for (int n = 0; n < 8; ++n) {
        double* at = lowest + width * corner_node(n);
        store(at, load<Record>(at) + r[n]);
      }
    } else {
      transpose_half(r);
      for (int n = 0; n < 8; ++n) {
        double* at = lowest + width * corner_node(n);
        store(at, load<Record>(at) + half_of(r[n / 2], n % 2));
      }
    }
  }
};

/// Interpolates three consecutive components of the node records, from `nodes` on, to the block's particles.
struct LinearInterpolation {
  using R = Lanes<8>;
  R value[3];
  LinearInterpolation(const LinearPlace& place, const double* nodes) : value{0.0, 0.0, 0.0} {
    const R x = load<R>(place.f[0]), y = load<R>(place.f[1]), z = load<R>(place.f[2]);
    const R one(1.0), xy = x * y, low = one - z;
    const R face[4] = {one - x - y + xy, x - xy, y - xy, xy};
    R weight[8];
    for (int i = 0; i < 4; ++i) weight[i] = face[i] * low, weight[4 + i] = face[i] * z;
    for_each_cell(place, [&](int node, auto here) {
      const double* lowest = nodes + node_doubles * node;
      for (int i = 0; i < 3; ++i) {
        R sum = weight[0] * R(lowest[i]);
        for (int n = 1; n < 8; ++n) sum += weight[n] * R(lowest[node_doubles * corner_node(n) + i]);
        value[i] = select(here, sum, value[i]);
      }
    });
  }
};

struct Linear {
  static constexpr std::string_view name = "linear";
  static constexpr NodeBlockShape node_block{0};
  using Place = LinearPlace;
  using Interpolation = LinearInterpolation;
  template <NodeFields what>
  using Scatter = LinearScatter<what>;

  /// Gradient of three components of the node records, from `nodes` on, into rows 0..8 (order of Mat3),
  /// columns `at` .. `at` + 7.
  template <class Rows>
  static void gradient(const BrickFrame& frame, const Place& place, const double* nodes, Rows& rows, int at) {
    using R = Lanes<8>;
    const R x = load<R>(place.f[0]), y = load<R>(place.f[1]), z = load<R>(place.f[2]);
    R gradient[9] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for_each_cell(place, [&](int node, auto here) {
      const double* lowest = nodes + node_doubles * node;
      for (int i = 0; i < 3; ++i) {
        const auto v = [&](int n) { return R(lowest[node_doubles * corner_node(n) + i]); };
        // Differences along x on the four edges, and the values at x; then the same along y and z.
        R d[4], u[4];
        for (int e = 0; e < 4; ++e) {
          d[e] = v(2 * e + 1) - v(2 * e);
          u[e] = v(2 * e) + x * d[e];
        }
        const R lower = u[1] - u[0], upper = u[3] - u[2];
        const R d_lower = d[0] + y * (d[1] - d[0]), d_upper = d[2] + y * (d[3] - d[2]);
        R* const g = gradient + 3 * i;
        g[0] = select(here, d_lower + z * (d_upper - d_lower), g[0]);
        g[1] = select(here, lower + z * (upper - lower), g[1]);
        g[2] = select(here, (u[2] + y * upper) - (u[0] + y * lower), g[2]);
      }
    });
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) store(rows[3 * i + j] + at, gradient[3 * i + j] * R(frame.inverse_cell[j]));
    }
  }

  /// Mean divergence of three components of the node records, from `nodes` on, over the cells that hold the
  /// block's particles, from the mean differences along their edges; times `factor`.
  template <class Row>
  static void cell_divergence(const BrickFrame& frame, const Place& place, const double* nodes, double factor,
                              Row& row, int at) {
    for_each_cell(place, [&](int node, auto here) {
      double divergence = 0;
      for (int a = 0; a < 3; ++a) {
        double difference = 0;
        for (int n = 0; n < 8; ++n) {
          const double v = nodes[node_doubles * (node + corner_node(n)) + a];
          difference += (n >> a & 1) != 0 ? v : -v;
        }
        divergence += 0.25 * frame.inverse_cell[a] * difference;
      }
      store(row + at, select(here, Lanes<8>(divergence * factor), load<Lanes<8>>(row + at)));
    });
  }

  /// f(node, offset, S, gradient of S) for the nodes of the cell that holds the particle of a lane: for terms
  /// too infrequent to vectorise.
  template <class F>
  static void for_each_node(const Place& place, int lane, const Vec3<double>& inverse_cell, F f) {
    const double fraction[3] = {place.f[0][lane], place.f[1][lane], place.f[2][lane]};
    for (int n = 0; n < 8; ++n) {
      const NodeOffset offset{{n & 1, (n >> 1) & 1, n >> 2}};
      double w[3], slope[3];
      for (int a = 0; a < 3; ++a) {
        w[a] = offset.along[a] == 1 ? fraction[a] : 1 - fraction[a];
        slope[a] = (offset.along[a] == 1 ? 1 : -1) * inverse_cell[a];
      }
      f(place.node[lane] + corner_node(n), offset, w[0] * w[1] * w[2],
        Vec3<double>{slope[0] * w[1] * w[2], w[0] * slope[1] * w[2], w[0] * w[1] * slope[2]});
    }
  }
};
static_assert(ShapePolicy<Linear>);

}  // namespace mpm::core
