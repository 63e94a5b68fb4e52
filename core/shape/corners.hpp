// Shape functions through the corners x_c of a particle's domain (CPDI: Sadeghirad, Brannon and Burghardt,
// IJNME 86 (2011) 1435): with N_i the trilinear functions,
//   S_i = sum_c s_c N_i(x_c),   grad S_i = sum_c w_c N_i(x_c)
// Domain supplies its columns, first_column and their number, and, in cells from the particle, the corners of
// a block's particles and the weights,
//   evaluate(frame, layout, block, corners[3][8], CornerWeights)
// (cpdi.hpp). The corners are at most a cell from the particle along each axis, so a particle reaches the
// 4 x 4 x 4 nodes around its cell.
//
// Particles to grid: one particle at a time, corner by corner, a node's record in the lanes. Two sums take
// turns: the corners of a particle share nodes, and an addition would wait for the one before. Grid to
// particles: the records of the nodes are interpolated to the corners in the same way, all components at
// once, and are transposed to particles in the lanes, where the weights combine them.
#pragma once

#include "core/shape/hexahedron.hpp"
#include "core/shape/linear.hpp"

namespace mpm::core {

inline constexpr NodeBlockShape corner_nodes{1, 1};

template <class Domain>
struct CornerPlace {
  static constexpr int side = corner_nodes.side();
  alignas(64) double f[corners][3][block_lanes];  ///< of the corners, within their cells
  alignas(64) double value[corners][block_lanes];
  alignas(64) double slope[corners][3][block_lanes];
  alignas(64) int node[corners][block_lanes];  ///< lowest of the corners' cells
  int lowest[block_lanes];                     ///< of the particle's 4 x 4 x 4

  CornerPlace() = default;
  CornerPlace(const BrickFrame& frame, const ColumnLayout& layout, const double* block) {
    find(frame, layout, block);
  }
  void find(const BrickFrame& frame, const ColumnLayout& layout, const double* block) {
    using R = Lanes<8>;
    typedef int Ints __attribute__((vector_size(block_lanes * sizeof(int))));
    const double* x = block + layout.offset(Column::position_x);
    const auto p = locate_in_sites<R, side>(frame, x, x + block_lanes, x + 2 * block_lanes);
    const R within[3] = {p.fx, p.fy, p.fz};
    R at[3][corners];
    CornerWeights<R> weights;
    Domain::evaluate(frame, layout, block, at, weights);
    std::memcpy(lowest, p.node, sizeof lowest);
    Ints first;
    std::memcpy(&first, lowest, sizeof first);
    for (int c = 0; c < corners; ++c) {
      R number(0.0);
      for (int a = 2; a >= 0; --a) {
        const R s = within[a] + at[a][c];
        // Unused lanes may hold anything; a NaN becomes the lower bound.
        const R cell = min(max(floor(s), R(-1.0)), R(1.0));
        store(f[c][a], s - cell);
        store(slope[c][a], weights.slope[a][c] * R(frame.inverse_cell[a]));
        number = number * R(double(side)) + (cell + R(1.0));
      }
      store(value[c], weights.value[c]);
      const Ints numbers = first + __builtin_convertvector(number.v, Ints);
      std::memcpy(node[c], &numbers, sizeof numbers);
    }
  }

  /// Of the particle's cell.
  int lowest_of_cell(int lane) const { return lowest[lane] + corner_nodes.index(0, 0, 0); }
};

namespace corner {

/// Number of the n-th node of a cell, relative to the lowest.
constexpr int cell_node(int n) {
  return (n & 1) + corner_nodes.side() * ((n >> 1 & 1) + corner_nodes.side() * (n >> 2));
}

/// The records that the nodes of corner `c`'s cell have from `nodes` on, interpolated to the corner.
template <class T, class Place>
[[gnu::always_inline]] inline T interpolated(const double* nodes, const Place& place, int c, int lane) {
  const T x(place.f[c][0][lane]), y(place.f[c][1][lane]), z(place.f[c][2][lane]);
  const double* lowest = nodes + node_doubles * place.node[c][lane];
  T edge[4];
  for (int e = 0; e < 4; ++e) {
    const T low = load<T>(lowest + node_doubles * cell_node(2 * e));
    edge[e] = low + x * (load<T>(lowest + node_doubles * cell_node(2 * e + 1)) - low);
  }
  const T lower = edge[0] + y * (edge[1] - edge[0]), upper = edge[2] + y * (edge[3] - edge[2]);
  return lower + z * (upper - lower);
}

/// Adds a corner's `record` to the records of `width` doubles of its cell's nodes.
template <int width, class T, class Place>
[[gnu::always_inline]] inline void add(T record, const Place& place, int c, int lane, double* records) {
  const T x(place.f[c][0][lane]), y(place.f[c][1][lane]), z(place.f[c][2][lane]);
  double* lowest = records + width * place.node[c][lane];
  const T upper = z * record;
  for (const int k : {0, 1}) {
    const T plane = k == 0 ? record - upper : upper, far = y * plane;
    for (const int j : {0, 1}) {
      const T row = j == 0 ? plane - far : far, right = x * row;
      double* left_at = lowest + width * cell_node(2 * j + 4 * k);
      store(left_at, load<T>(left_at) + (row - right));
      store(left_at + width, load<T>(left_at + width) + right);
    }
  }
}

}  // namespace corner

template <NodeFields what, class Place>
struct CornerScatter {
  void clear() {}
  void flush(const BrickFrame&, double*) {}

  /// Particle `i` of the block.
  [[gnu::always_inline]] void add(const BrickFrame&, const Place& place, int i, const MappedRows& rows,
                                  double* sums) {
    constexpr int width = record_doubles(what.array), doubles = width * corner_nodes.nodes();
    if constexpr (maps_force(what)) {
      using R = Lanes<8>;
      using V = R::vector;
      const auto s = [&](int n) { return -rows.stress[n][i]; };
      const R x_stress = V{0, 0, 0, 0, s(0), s(3), s(5), 0}, y_stress = V{0, 0, 0, 0, s(3), s(1), s(4), 0},
              z_stress = V{0, 0, 0, 0, s(5), s(4), s(2), 0};
      R motion(0.0);
      if constexpr (maps_momentum(what))
        motion = V{rows.momentum[0][i], rows.momentum[1][i], rows.momentum[2][i], rows.mass[i], 0, 0, 0, 0};
      for (int c = 0; c < corners; ++c) {
        R record = x_stress * R(place.slope[c][0][i]) + y_stress * R(place.slope[c][1][i]) +
                   z_stress * R(place.slope[c][2][i]);
        if constexpr (maps_momentum(what)) record += motion * R(place.value[c][i]);
        corner::add<width>(record, place, c, i, sums + c % 2 * doubles);
      }
    } else {
      using H = Lanes<4>;
      const H motion = H::vector{rows.momentum[0][i], rows.momentum[1][i], rows.momentum[2][i],
                                 maps_mass(what) ? rows.mass[i] : 0.0};
      for (int c = 0; c < corners; ++c)
        corner::add<width>(motion * H(place.value[c][i]), place, c, i, sums + c % 2 * doubles);
    }
  }
};

/// sum S_i u_i of three components of the records from `nodes` on.
template <class Place>
struct CornerInterpolation {
  using R = Lanes<8>;
  using H = Lanes<4>;
  R value[3];
  CornerInterpolation(const Place& place, const double* nodes) {
    alignas(64) double row[3][block_lanes];
    for (int i = 0; i < block_lanes; ++i) {
      H sum(0.0);
      for (int c = 0; c < corners; ++c)
        sum += H(place.value[c][i]) * corner::interpolated<H>(nodes, place, c, i);
      for (int a = 0; a < 3; ++a) row[a][i] = sum[a];
    }
    for (int a = 0; a < 3; ++a) value[a] = load<R>(row[a]);
  }
};

/// The motion of the corners of a block's particles, and what the particles take of it.
template <class Place>
struct CornerSample {
  using R = Lanes<8>;
  const Place& place;
  R velocity[corners][3], strain[corners][3];

  CornerSample(const Place& of, const Linear::Field& field) : place(of) {
    alignas(64) double record[corners][block_lanes][node_doubles];
    for (int i = 0; i < block_lanes; ++i)
      for (int c = 0; c < corners; ++c)
        store(record[c][i], corner::interpolated<R>(field.nodes, place, c, i));
    for (int c = 0; c < corners; ++c) {
      R component[node_doubles];
      for (int i = 0; i < block_lanes; ++i) component[i] = load<R>(record[c][i]);
      transpose(component);
      for (int a = 0; a < 3; ++a) {
        velocity[c][a] = component[Motion::velocity_at + a];
        strain[c][a] = component[Motion::strain_velocity_at + a];
      }
    }
  }

  template <class Rows>
  void gradient(const BrickFrame&, Rows& rows, int at) const {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        R sum(0.0);
        for (int c = 0; c < corners; ++c) sum += strain[c][a] * load<R>(place.slope[c][b]);
        store(rows[3 * a + b] + at, sum);
      }
    }
  }
  /// sum S_i v_i.
  R mean_velocity(int axis) const {
    R sum(0.0);
    for (int c = 0; c < corners; ++c) sum += load<R>(place.value[c]) * velocity[c][axis];
    return sum;
  }
  /// x += dt sum S_i v_i.
  void move(const ColumnLayout& layout, double dt, double* block) const {
    for (int a = 0; a < 3; ++a) {
      double* x = block + layout.offset(next(Column::position_x, a));
      store(x, load<R>(x) + R(dt) * mean_velocity(a));
    }
  }
};

/// Sums over the particles for even and for odd corners.
template <NodeFields what>
class CornerSums {
 public:
  static constexpr int doubles = record_doubles(what.array) * corner_nodes.nodes();
  explicit CornerSums(double* contributions) : records(sum_), contributions_(contributions) {}
  void finish(const BrickFrame&) {
    for (int i = 0; i < doubles; ++i) contributions_[i] += sum_[i] + sum_[doubles + i];
  }
  double* records;

 private:
  alignas(64) double sum_[2 * doubles] = {};
  double* contributions_;
};

/// A policy (shape.hpp) but for its name and how the domains follow the motion.
template <class Domain>
struct CornerShape {
  static constexpr Site site = Site::cell;
  static constexpr NodeBlockShape node_block = corner_nodes;
  static constexpr int nodes_per_axis = 4;
  using Place = CornerPlace<Domain>;
  using Interpolation = CornerInterpolation<Place>;
  using Sample = CornerSample<Place>;
  template <NodeFields what>
  using Scatter = CornerScatter<what, Place>;
  template <NodeFields what>
  using Sums = CornerSums<what>;
  using Field = Linear::Field;
  static constexpr Column first_of_domain = Domain::first_column;
  static constexpr int columns_of_domain = Domain::columns;
  static ColumnSet columns() {
    ColumnSet set;
    set.add_range(first_of_domain, columns_of_domain);
    return set;
  }

  template <class Rows>
  static void gradient(const BrickFrame&, const Place& place, const Field& field, Rows& rows, int at) {
    using H = Lanes<4>;
    const double* nodes = field.nodes + Motion::strain_velocity_at;
    for (int i = 0; i < block_lanes; ++i) {
      H along[3] = {0.0, 0.0, 0.0};
      for (int c = 0; c < corners; ++c) {
        const H u = corner::interpolated<H>(nodes, place, c, i);
        for (int b = 0; b < 3; ++b) along[b] += u * H(place.slope[c][b][i]);
      }
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) rows[3 * a + b][at + i] = along[b][a];
    }
  }

  static void cell_divergence(const BrickFrame& frame, const Place& place, const Field& field, double factor,
                              double* row, int at) {
    const double* nodes = field.nodes + Motion::strain_velocity_at;
    for (int l = 0; l < block_lanes; ++l)
      row[at + l] =
          factor * mean_divergence<node_block>(frame, nodes + node_doubles * place.lowest_of_cell(l));
  }

  static std::int64_t lowest_node(const GridGeometry& g, double x, int axis) {
    return g.site_index(x, axis) - 1;
  }
  /// Without the nodes that no corner reaches.
  template <class F>
  static void for_each_node(const Place& place, int lane, const Vec3<double>&, F f) {
    struct Weight {
      double value = 0;
      Vec3<double> slope{};
      bool reached = false;
    };
    Weight weights[nodes_per_axis * nodes_per_axis * nodes_per_axis];
    constexpr int side = Place::side;
    for (int c = 0; c < corners; ++c) {
      const int from_lowest = place.node[c][lane] - place.lowest[lane];
      const int at[3] = {from_lowest % side, from_lowest / side % side, from_lowest / (side * side)};
      for (int n = 0; n < 8; ++n) {
        double shape = 1;
        int number = 0;
        for (int a = 2; a >= 0; --a) {
          const double fraction = place.f[c][a][lane];
          shape *= (n >> a & 1) != 0 ? fraction : 1 - fraction;
          number = nodes_per_axis * number + at[a] + (n >> a & 1);
        }
        Weight& w = weights[number];
        w.reached = true;
        w.value += place.value[c][lane] * shape;
        for (int a = 0; a < 3; ++a) w.slope[a] += place.slope[c][a][lane] * shape;
      }
    }
    for (int k = 0; k < nodes_per_axis; ++k) {
      for (int j = 0; j < nodes_per_axis; ++j) {
        for (int i = 0; i < nodes_per_axis; ++i) {
          const Weight& w = weights[i + nodes_per_axis * (j + nodes_per_axis * k)];
          if (w.reached)
            f(place.lowest[lane] + i + side * (j + side * k), NodeOffset{{i, j, k}}, w.value, w.slope);
        }
      }
    }
  }
};

}  // namespace mpm::core
