// Shape functions that are products over the axes of functions with n = 3 or 4 nodes each: B-splines, GIMP.
//
//   S_i(x) = a(x) b(y) c(z),   grad S_i = (a' b c, a b' c, a b c')
//
// Along supplies the functions of one axis: static constexpr int nodes; bool has_size, whether they depend on
// the size of the particle's domain; and, in cells, particles in the lanes,
//   evaluate(position in the site, [half-size,] values[nodes], slopes[nodes])
// Three nodes per axis are those around the nearest node: bricks take particles by node; four are those
// around the particle's cell. Either way a particle's lowest node has the number of its site in the node
// block.
//
// Particles to grid: one particle at a time, a node's record in the lanes; sums over the axes are nested, so
// that a node costs two multiply-adds of eight lanes. Grid to particles: particles in the lanes, each
// distinct site among the eight visited once.
#pragma once

#include <cstdint>

#include "core/shape/linear.hpp"

namespace mpm::core {

/// A block's particles: values and slopes (1/length) on their nodes along each axis.
template <class Along>
struct SeparablePlace {
  static constexpr int n = Along::nodes;
  static constexpr int side = brick_cells + n - 1;
  alignas(64) double value[3][n][block_lanes];
  alignas(64) double slope[3][n][block_lanes];
  alignas(64) double position[3][block_lanes];  ///< within the site, 0 to 1
  int node[block_lanes];                        ///< the lowest one's number

  SeparablePlace() = default;
  SeparablePlace(const BrickFrame& frame, const ColumnLayout& layout, const double* block, int used) {
    find(frame, layout, block, used);
  }
  void find(const BrickFrame& frame, const ColumnLayout& layout, const double* block, int) {
    const double* x = block + layout.offset(Column::position_x);
    for (int l = 0; l < block_lanes; l += real_width) {
      const auto p = locate_in_sites<Real, side>(frame, x + l, x + block_lanes + l, x + 2 * block_lanes + l);
      const Real within[3] = {p.fx, p.fy, p.fz};
      for (int a = 0; a < 3; ++a) {
        Real values[n], slopes[n];
        if constexpr (Along::has_size) {
          const double* half = block + layout.offset(next(Column::half_size_x, a));
          Along::evaluate(within[a], load<Real>(half + l) * Real(frame.inverse_cell[a]), values, slopes);
        } else {
          Along::evaluate(within[a], values, slopes);
        }
        store(position[a] + l, within[a]);
        for (int i = 0; i < n; ++i) {
          store(value[a][i] + l, values[i]);
          store(slope[a][i] + l, slopes[i] * Real(frame.inverse_cell[a]));
        }
      }
      for (int i = 0; i < real_width; ++i) node[l + i] = p.node[i];
    }
  }
};

namespace separable {

/// x in the lower four lanes, y in the upper ones.
inline Lanes<8> halves(double x, double y) { return Lanes<8>::vector{x, x, x, x, y, y, y, y}; }

}  // namespace separable

template <NodeFields what, class Along>
struct SeparableScatter {
  void clear() {}
  void flush(const BrickFrame&, double*) {}

  /// Particle `i` of the block; Rows: MappedRows or AffineRows.
  template <class Rows>
  [[gnu::always_inline]] void add(const BrickFrame&, const SeparablePlace<Along>& place, int i,
                                  const Rows& rows, double* contributions) {
    constexpr bool affine = maps_momentum(what) && requires { rows.increase; };
    constexpr int n = Along::nodes, side = SeparablePlace<Along>::side;
    constexpr int width = record_doubles(what.array);
    double* lowest = contributions + width * place.node[i];
    const auto& w = place.value;
    const auto& d = place.slope;
    if constexpr (maps_force(what)) {
      using R = Lanes<8>;
      using V = R::vector;
      const auto s = [&](int c) { return -rows.stress[c][i]; };
      // (p m | -V sigma_z), and the other rows of -V sigma in the place of the force.
      R mapped = V{0, 0, 0, 0, s(5), s(4), s(2), 0};
      if constexpr (maps_momentum(what))
        mapped = V{
            rows.momentum[0][i], rows.momentum[1][i], rows.momentum[2][i], rows.mass[i], s(5), s(4), s(2), 0};
      const R y_stress = V{0, 0, 0, 0, s(3), s(1), s(4), 0}, x_stress = V{0, 0, 0, 0, s(0), s(3), s(5), 0};
      R increase[3];
      if constexpr (affine) {
        for (int b = 0; b < 3; ++b)
          increase[b] =
              V{rows.increase[0][b][i], rows.increase[1][b][i], rows.increase[2][b][i], 0, 0, 0, 0, 0};
      }
      R wy[n], dy[n];
      for (int j = 0; j < n; ++j) wy[j] = R(w[1][j][i]), dy[j] = R(d[1][j][i]);
      for (int k = 0; k < n; ++k) {
        const double wz = w[2][k][i];
        R u = mapped * separable::halves(wz, d[2][k][i]);
        const R v = y_stress * R(wz), x = x_stress * R(wz);
        for (int j = 0; j < n; ++j) {
          R p = u * wy[j] + v * dy[j];
          const R q = x * wy[j];
          double* at = lowest + width * side * (j + side * k);
          for (int m = 0; m < n; ++m, at += width) {
            store(at, (load<R>(at) + p * R(w[0][m][i])) + q * R(d[0][m][i]));
            if constexpr (affine) p += increase[0] * R(wz) * wy[j];
          }
          if constexpr (affine) u += increase[1] * R(wz);
        }
        if constexpr (affine) mapped += increase[2];
      }
    } else {
      using H = Lanes<4>;
      H mapped = H::vector{rows.momentum[0][i], rows.momentum[1][i], rows.momentum[2][i],
                           maps_mass(what) ? rows.mass[i] : 0.0};
      H increase[3];
      if constexpr (affine) {
        for (int b = 0; b < 3; ++b)
          increase[b] = H::vector{rows.increase[0][b][i], rows.increase[1][b][i], rows.increase[2][b][i], 0};
      }
      for (int k = 0; k < n; ++k) {
        H u = mapped * H(w[2][k][i]);
        for (int j = 0; j < n; ++j) {
          H p = u * H(w[1][j][i]);
          double* at = lowest + width * side * (j + side * k);
          for (int m = 0; m < n; ++m, at += width) {
            store(at, load<H>(at) + p * H(w[0][m][i]));
            if constexpr (affine) p += increase[0] * H(w[2][k][i]) * H(w[1][j][i]);
          }
          if constexpr (affine) u += increase[1] * H(w[2][k][i]);
        }
        if constexpr (affine) mapped += increase[2];
      }
    }
  }
};

template <class Along>
struct SeparableInterpolation {
  using R = Lanes<8>;
  R value[3];
  SeparableInterpolation(const SeparablePlace<Along>& place, const double* nodes) : value{0.0, 0.0, 0.0} {
    constexpr int n = Along::nodes, side = SeparablePlace<Along>::side;
    const auto w = [&](int axis, int i) { return load<R>(place.value[axis][i]); };
    for_each_cell(place, [&](int node, auto here) {
      const double* lowest = nodes + node_doubles * node;
      R sum[3] = {0.0, 0.0, 0.0};
      for (int k = 0; k < n; ++k) {
        R plane[3] = {0.0, 0.0, 0.0};
        for (int j = 0; j < n; ++j) {
          const double* at = lowest + node_doubles * side * (j + side * k);
          for (int c = 0; c < 3; ++c) {
            R row = w(0, 0) * R(at[c]);
            for (int i = 1; i < n; ++i) row += w(0, i) * R(at[node_doubles * i + c]);
            plane[c] += w(1, j) * row;
          }
        }
        for (int c = 0; c < 3; ++c) sum[c] += w(2, k) * plane[c];
      }
      for (int c = 0; c < 3; ++c) value[c] = select(here, sum[c], value[c]);
    });
  }
};

/// The columns of a particle's domain, for BlockPrefetch.
template <bool has_size>
struct SizeColumns {};
template <>
struct SizeColumns<true> {
  static constexpr Column first_of_domain = Column::half_size_x;
  static constexpr int columns_of_domain = 3;
};

/// A policy (shape.hpp) but for its name.
template <class Along>
struct Separable : SizeColumns<Along::has_size> {
  static constexpr int nodes_per_axis = Along::nodes;
  static_assert(nodes_per_axis == 3 || nodes_per_axis == 4);
  static constexpr Site site = nodes_per_axis == 3 ? Site::node : Site::cell;
  static constexpr NodeBlockShape node_block{1, nodes_per_axis == 3 ? 0 : 1};
  static ColumnSet columns() {
    ColumnSet set;
    if constexpr (Along::has_size) set.add_range(Separable::first_of_domain, Separable::columns_of_domain);
    return set;
  }
  using Place = SeparablePlace<Along>;
  using Interpolation = SeparableInterpolation<Along>;
  template <NodeFields what>
  using Scatter = SeparableScatter<what, Along>;
  template <NodeFields what>
  using Sums = Linear::Sums<what>;
  using Field = Linear::Field;

  template <class Rows>
  static void gradient(const BrickFrame&, const Place& place, const Field& field, Rows& rows, int at) {
    Lanes<8> value[3], gradient[9];
    sums(place, place.slope, field.nodes + Motion::strain_velocity_at, value, gradient);
    for (int i = 0; i < 9; ++i) store(rows[i] + at, gradient[i]);
  }

  // For affine transfers.

  /// Distance of a block's particles from their lowest node along an axis, in cells.
  static Lanes<8> from_lowest_node(const Place& place, int axis) {
    return load<Lanes<8>>(place.position[axis]) + Lanes<8>(nodes_per_axis == 3 ? 0.5 : 1.0);
  }
  /// sum S_i v_i, and sum v_i (x) grad S_i in the order of Mat3.
  static void velocity_and_gradient(const Place& place, const Field& field, Lanes<8>* value,
                                    Lanes<8>* gradient) {
    sums(place, place.slope, field.velocity(), value, gradient);
  }
  /// sum S_i v_i, and B D^-1 (core/transfer/affine.hpp).
  static void velocity_and_moments(const BrickFrame& frame, const Place& place, const Field& field,
                                   Lanes<8>* value, Lanes<8>* moments) {
    using R = Lanes<8>;
    constexpr int n = nodes_per_axis;
    alignas(64) double factor[3][n][block_lanes];
    for (int a = 0; a < 3; ++a) {
      R distance = -from_lowest_node(place, a), first[n], second(0.0);
      for (int i = 0; i < n; ++i, distance += R(1.0)) {
        first[i] = load<R>(place.value[a][i]) * distance;
        second += first[i] * distance;
      }
      const R scale = R(frame.inverse_cell[a]) / second;
      for (int i = 0; i < n; ++i) store(factor[a][i], first[i] * scale);
    }
    sums(place, factor, field.velocity(), value, moments);
  }

  static void cell_divergence(const BrickFrame& frame, const Place& place, const Field& field, double factor,
                              double* row, int at) {
    constexpr int side = Place::side;
    for (int l = 0; l < block_lanes; ++l) {
      int lowest = place.node[l];
      const int stride[3] = {1, side, side * side};
      for (int a = 0; a < 3; ++a)
        lowest += stride[a] * (site == Site::cell || place.position[a][l] >= 0.5 ? 1 : 0);
      row[at + l] = factor * mean_divergence<node_block>(
                                 frame, field.nodes + node_doubles * lowest + Motion::strain_velocity_at);
    }
  }

  static int lowest_of(const Place& place, int lane) { return place.node[lane]; }
  template <class F>
  static void for_each_node(const Place& place, int lane, const Vec3<double>&, F f) {
    constexpr int n = nodes_per_axis, side = Place::side;
    const auto w = [&](int axis, int i) { return place.value[axis][i][lane]; };
    const auto d = [&](int axis, int i) { return place.slope[axis][i][lane]; };
    for (int k = 0; k < n; ++k) {
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          f(place.node[lane] + i + side * (j + side * k), w(0, i) * w(1, j) * w(2, k),
            Vec3<double>{d(0, i) * w(1, j) * w(2, k), w(0, i) * d(1, j) * w(2, k),
                         w(0, i) * w(1, j) * d(2, k)});
        }
      }
    }
  }

 private:
  /// Sums over the nodes of three components u of their records, from `nodes` on: S_i u_i, and u_i times
  /// (a' b c, a b' c, a b c') with the factors a', b', c' given.
  [[gnu::always_inline]] static void sums(const Place& place,
                                          const double (&factor)[3][nodes_per_axis][block_lanes],
                                          const double* nodes, Lanes<8>* value, Lanes<8>* gradient) {
    using R = Lanes<8>;
    constexpr int n = nodes_per_axis, side = Place::side;
    const auto w = [&](int axis, int i) { return load<R>(place.value[axis][i]); };
    const auto d = [&](int axis, int i) { return load<R>(factor[axis][i]); };
    for (int c = 0; c < 3; ++c) value[c] = R(0.0);
    for (int i = 0; i < 9; ++i) gradient[i] = R(0.0);
    for_each_cell(place, [&](int node, auto here) {
      const double* lowest = nodes + node_doubles * node;
      for (int c = 0; c < 3; ++c) {
        R u(0.0), gx(0.0), gy(0.0), gz(0.0);
        for (int k = 0; k < n; ++k) {
          R x(0.0), y(0.0), z(0.0);
          for (int j = 0; j < n; ++j) {
            const double* at = lowest + node_doubles * side * (j + side * k) + c;
            R row = w(0, 0) * R(at[0]), slope = d(0, 0) * R(at[0]);
            for (int i = 1; i < n; ++i) {
              row += w(0, i) * R(at[node_doubles * i]);
              slope += d(0, i) * R(at[node_doubles * i]);
            }
            x += w(1, j) * slope;
            y += d(1, j) * row;
            z += w(1, j) * row;
          }
          u += w(2, k) * z;
          gx += w(2, k) * x;
          gy += w(2, k) * y;
          gz += d(2, k) * z;
        }
        R* const g = gradient + 3 * c;
        value[c] = select(here, u, value[c]);
        g[0] = select(here, gx, g[0]);
        g[1] = select(here, gy, g[1]);
        g[2] = select(here, gz, g[2]);
      }
    });
  }
};

}  // namespace mpm::core
