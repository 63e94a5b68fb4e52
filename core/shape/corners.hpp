// Shape functions through the corners x_c of a particle's domain (CPDI: Sadeghirad, Brannon and Burghardt,
// IJNME 86 (2011) 1435): with N_i the trilinear functions,
//   S_i = sum_c s_c N_i(x_c),   grad S_i = sum_c w_c N_i(x_c)
// with the corners and weights of a Domain (corner_place.hpp).
//
// A particle's corners share most of their nodes, and adding a record to a node takes longer than the
// arithmetic between two additions. Particles to grid: S_i on 27 nodes, particles in the lanes, serves
// momentum and mass: sums over the lanes where all particles of a block have the same nodes, else one
// particle at a time, a node's record in the lanes. With forces, each corner is a point with a record of its
// own; those of a block that lie in the same cell are added up in registers, the cell's nodes in the lanes,
// as particles are with linear functions. Grid to particles: velocities by S_i again; for strain and motion
// the nodes' records are interpolated to the corners, and the sums over these that the domain needs are
// transposed to particles in the lanes.
#pragma once

#include "core/shape/corner_place.hpp"

namespace mpm::core {

/// The cells of the corners of a block's particles.
template <class Domain>
struct CornerCells {
  alignas(64) double f[3][corners * block_lanes];  ///< of the corners, within their cells
  alignas(64) int node[corners][block_lanes];      ///< lowest of a cell's nodes

  explicit CornerCells(const CornerPlace<Domain>& place) {
    using R = Lanes<8>;
    for (int c = 0; c < corners; ++c) {
      R cell[3];
      for (int a = 0; a < 3; ++a) {
        const R s = load<R>(place.corner[a][c]);
        cell[a] = min(max(floor(s), R(-1.0)), R(1.0));
        store(f[a] + block_lanes * c, s - cell[a]);
      }
      const auto nodes = place.nodes(cell[0] + R(1.0), cell[1] + R(1.0), cell[2] + R(1.0));
      std::memcpy(node[c], &nodes, sizeof nodes);
    }
  }

  /// The records that the nodes of corner `c`'s cell have from `nodes` on, interpolated to the corner.
  template <class T>
  [[gnu::always_inline]] T interpolated(const double* nodes, int c, int lane) const {
    const int point = block_lanes * c + lane;
    const T x(f[0][point]), y(f[1][point]), z(f[2][point]);
    const double* lowest = nodes + node_doubles * node[c][lane];
    T edge[4];
    for (int e = 0; e < 4; ++e) {
      const double* at =
          lowest + node_doubles * corner_nodes.side() * (e % 2 + corner_nodes.side() * (e / 2));
      edge[e] = load<T>(at) + x * (load<T>(at + node_doubles) - load<T>(at));
    }
    const T lower = edge[0] + y * (edge[1] - edge[0]), upper = edge[2] + y * (edge[3] - edge[2]);
    return lower + z * (upper - lower);
  }
  /// The domain's sums over the corners of those records.
  template <class T>
  [[gnu::always_inline]] void sum(const double* nodes, int lane, T (&sums)[Domain::sums]) const {
    T at[corners];
#pragma GCC unroll 8
    for (int c = 0; c < corners; ++c) at[c] = interpolated<T>(nodes, c, lane);
    Domain::reduce(at, sums);
  }
};

namespace corner {

/// f(number of the node among n^3, offset of its record from the lowest node's).
template <int n, int width, class F>
[[gnu::always_inline]] inline void for_each_record(F f) {
  constexpr int side = corner_nodes.side();
  for (int k = 0; k < n; ++k)
#pragma GCC unroll 4
    for (int j = 0; j < n; ++j)
#pragma GCC unroll 4
      for (int i = 0; i < n; ++i) f(i + n * (j + n * k), width * (i + side * (j + side * k)));
}

}  // namespace corner

/// The corners of a block's particles as points, corner by corner, with what they add to the nodes of their
/// cells: momentum, mass and force, if mapped.
template <NodeFields what, class Domain>
struct CornerPoints {
  static constexpr int first = maps_momentum(what) ? 0 : node_field::force.first;
  static constexpr int beyond = node_field::force.first + 3;
  CornerCells<Domain> cells;
  alignas(64) double record[beyond][corners * block_lanes];

  CornerPoints(const CornerPlace<Domain>& place, const MappedRows& rows) : cells(place) {
    using R = Lanes<8>;
    R of[corners];
    const auto keep = [&](int i) {
      for (int c = 0; c < corners; ++c) store(record[i] + block_lanes * c, of[c]);
    };
    if constexpr (maps_momentum(what)) {
      for (int a = 0; a < 4; ++a) {
        Domain::share(place, load<R>(a < 3 ? rows.momentum[a] : rows.mass), of);
        keep(a);
      }
    }
    constexpr int row[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    for (int a = 0; a < 3; ++a) {
      R flow[3];
      for (int b = 0; b < 3; ++b) flow[b] = -load<R>(rows.stress[row[a][b]]);
      Domain::share_flow(place, flow, of);
      keep(node_field::force.first + a);
    }
  }

  /// Of the nodes of its cell.
  [[gnu::always_inline]] linear::Nodes weights(int point) const {
    return linear::weights_at(cells.f[0][point], cells.f[1][point], cells.f[2][point]);
  }

  /// f(lowest node, points as bits) for each cell that holds corners of the first `used` particles.
  template <class F>
  [[gnu::always_inline]] void for_each_cell(int used, F f) const {
    using Mask = LaneMask<block_lanes>;
    Mask::vector node[corners];
    for (int c = 0; c < corners; ++c) {
      typename CornerPlace<Domain>::Ints narrow;
      std::memcpy(&narrow, cells.node[c], sizeof narrow);
      node[c] = __builtin_convertvector(narrow, Mask::vector);
    }
    std::uint64_t left = 0;
    for (int c = 0; c < corners; ++c) left |= ((std::uint64_t{1} << used) - 1) << (block_lanes * c);
    while (left != 0) {
      const int point = __builtin_ctzll(left), cell = cells.node[point / block_lanes][point % block_lanes];
      std::uint64_t here = 0;
#pragma GCC unroll 8
      for (int c = 0; c < corners; ++c)
        here |= std::uint64_t{bits(Mask{node[c] == std::int64_t{cell}})} << (block_lanes * c);
      here &= left;
      left &= ~here;
      f(cell, here);
    }
  }
};

template <NodeFields what, class Domain>
struct CornerScatter {
  static constexpr int width = record_doubles(what.array);
  void clear() {}
  void flush(const BrickFrame&, double*) {}

  /// Adds the first `used` particles of a block.
  [[gnu::always_inline]] void add_block(const BrickFrame&, const CornerPlace<Domain>& place, int used,
                                        const MappedRows& rows, double* records) {
    if constexpr (maps_force(what))
      add_forces(place, used, rows, records);
    else
      add_momentum(place, used, rows, records);
  }

 private:
  static void add_momentum(const CornerPlace<Domain>& place, int used, const MappedRows& rows,
                           double* records) {
    using H = Lanes<4>;
    const auto& values = place.values();
    if (values.shared && used == block_lanes) [[likely]]
      return add_shared_momentum(values, rows, records);
    values.with_along([&](auto n) {
      for (int l = 0; l < used; ++l) {
        const H motion = H::vector{rows.momentum[0][l], rows.momentum[1][l], rows.momentum[2][l],
                                   maps_mass(what) ? rows.mass[l] : 0.0};
        double* lowest = records + width * values.lowest[l];
        corner::for_each_record<n, width>([&](int node, int offset) {
          double* at = lowest + offset;
          store(at, load<H>(at) + motion * H(values.value[node][l]));
        });
      }
    });
  }

  /// Of particles with the same nodes, in the lanes.
  static void add_shared_momentum(const typename CornerPlace<Domain>::Values& values, const MappedRows& rows,
                                  double* records) {
    using R = Lanes<8>;
    using H = Lanes<4>;
    R motion[4] = {load<R>(rows.momentum[0]), load<R>(rows.momentum[1]), load<R>(rows.momentum[2]), R(0.0)};
    if constexpr (maps_mass(what)) motion[3] = load<R>(rows.mass);
    double* lowest = records + width * values.lowest[0];
    values.with_along([&](auto n) {
      corner::for_each_record<n, width>([&](int node, int offset) {
        R mapped[4];
        for (int i = 0; i < 4; ++i) mapped[i] = load<R>(values.value[node]) * motion[i];
        store(lowest + offset, load<H>(lowest + offset) + sums_over_lanes(mapped));
      });
    });
  }

  static void add_forces(const CornerPlace<Domain>& place, int used, const MappedRows& rows,
                         double* records) {
    using N = linear::Nodes;
    using Points = CornerPoints<what, Domain>;
    const Points points(place, rows);
    points.for_each_cell(used, [&](int cell, std::uint64_t here) {
      N sum[node_doubles] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
      for (; here != 0; here &= here - 1) {
        const int point = __builtin_ctzll(here);
        const N w = points.weights(point);
#pragma GCC unroll 8
        for (int i = Points::first; i < Points::beyond; ++i) sum[i] += w * N(points.record[i][point]);
      }
      add_to_corners<width, corner_nodes>(sum, records + width * cell);
    });
  }
};

/// sum S_i u_i of three components of the records from `nodes` on.
template <class Domain>
struct CornerInterpolation {
  using R = Lanes<8>;
  using H = Lanes<4>;
  R value[3];
  CornerInterpolation(const CornerPlace<Domain>& place, const double* nodes) {
    alignas(64) double row[3][block_lanes];
    const auto& values = place.values();
    values.with_along([&](auto n) {
      if (values.shared) [[likely]] {
        const double* lowest = nodes + node_doubles * values.lowest[0];
        R sum[3] = {0.0, 0.0, 0.0}, plane[3];
        corner::for_each_record<n, node_doubles>([&](int node, int offset) {
          for (int a = 0; a < 3; ++a) {
            if (node % (n * n) == 0) plane[a] = R(0.0);
            plane[a] += load<R>(values.value[node]) * R(lowest[offset + a]);
            if (node % (n * n) == n * n - 1) sum[a] += plane[a];
          }
        });
        for (int a = 0; a < 3; ++a) store(row[a], sum[a]);
        return;
      }
      for (int l = 0; l < block_lanes; ++l) {
        const double* lowest = nodes + node_doubles * values.lowest[l];
        H sum[n] = {};  // by planes: an addition waits for the one before
        corner::for_each_record<n, node_doubles>([&](int node, int offset) {
          sum[node / (n * n)] += H(values.value[node][l]) * load<H>(lowest + offset);
        });
        for (int k = 1; k < n; ++k) sum[0] += sum[k];
        for (int a = 0; a < 3; ++a) row[a][l] = sum[0][a];
      }
    });
    for (int a = 0; a < 3; ++a) value[a] = load<R>(row[a]);
  }
};

/// The domain's sums over the corners of their motion, and what a block's particles take of it.
template <class Domain>
struct CornerSample {
  using R = Lanes<8>;
  const CornerPlace<Domain>& place;
  R velocity[Domain::sums][3], strain[Domain::sums][3];

  CornerSample(const CornerPlace<Domain>& of, const Linear::Field& field) : place(of) {
    alignas(64) double record[Domain::sums][block_lanes][node_doubles];
    const CornerCells<Domain> cells(place);
    for (int l = 0; l < block_lanes; ++l) {
      R sum[Domain::sums];
      cells.sum(field.nodes, l, sum);
      for (int s = 0; s < Domain::sums; ++s) store(record[s][l], sum[s]);
    }
    for (int s = 0; s < Domain::sums; ++s) {
      R component[node_doubles];
      for (int l = 0; l < block_lanes; ++l) component[l] = load<R>(record[s][l]);
      transpose(component);
      for (int a = 0; a < 3; ++a) {
        velocity[s][a] = component[Motion::velocity_at + a];
        strain[s][a] = component[Motion::strain_velocity_at + a];
      }
    }
  }

  template <class Rows>
  void gradient(const BrickFrame&, Rows& rows, int at) const {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        R sum(0.0);
        for (int s = Domain::first_slope; s < Domain::sums; ++s)
          sum += strain[s][a] * load<R>(place.slope[s - Domain::first_slope][b]);
        store(rows[3 * a + b] + at, sum);
      }
    }
  }
  /// sum S_i v_i.
  R mean_velocity(int axis) const {
    R sum(0.0);
    for (int s = 0; s < Domain::values; ++s) sum += load<R>(place.value[s]) * velocity[s][axis];
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

/// A policy (shape.hpp) but for its name and how the domains follow the motion.
template <class Domain>
struct CornerShape {
  static constexpr Site site = Site::cell;
  static constexpr NodeBlockShape node_block = corner_nodes;
  static constexpr int nodes_per_axis = 4;
  using Place = CornerPlace<Domain>;
  using Interpolation = CornerInterpolation<Domain>;
  using Sample = CornerSample<Domain>;
  template <NodeFields what>
  using Scatter = CornerScatter<what, Domain>;
  template <NodeFields what>
  using Sums = Linear::Sums<what>;
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
    const CornerCells<Domain> cells(place);
    for (int l = 0; l < block_lanes; ++l) {
      H sum[Domain::sums], along[3] = {0.0, 0.0, 0.0};
      cells.sum(nodes, l, sum);
      for (int s = Domain::first_slope; s < Domain::sums; ++s)
        for (int b = 0; b < 3; ++b) along[b] += sum[s] * H(place.slope[s - Domain::first_slope][b][l]);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) rows[3 * a + b][at + l] = along[b][a];
    }
  }

  static void cell_divergence(const BrickFrame& frame, const Place& place, const Field& field, double factor,
                              double* row, int at) {
    const double* nodes = field.nodes + Motion::strain_velocity_at;
    for (int l = 0; l < block_lanes; ++l)
      row[at + l] =
          factor * mean_divergence<node_block>(frame, nodes + node_doubles * place.lowest_of_cell(l));
  }

  /// Without the nodes that no corner reaches.
  template <class F>
  static void for_each_node(const Place& place, int lane, const Vec3<double>&, F f) {
    constexpr int n = nodes_per_axis;
    for (int number = 0; number < n * n * n; ++number) {
      const int offset[3] = {number % n, number / n % n, number / (n * n)};
      double at[corners], sum[Domain::sums], largest = 0;
      for (int c = 0; c < corners; ++c) {
        at[c] = 1;
        for (int a = 0; a < 3; ++a)
          at[c] *= std::max(1 - std::abs(place.corner[a][c][lane] - (offset[a] - 1)), 0.0);
        largest = std::max(largest, at[c]);
      }
      if (largest == 0) continue;
      Domain::reduce(at, sum);
      double value = 0;
      Vec3<double> slope{};
      for (int s = 0; s < Domain::values; ++s) value += place.value[s][lane] * sum[s];
      for (int s = Domain::first_slope; s < Domain::sums; ++s)
        for (int a = 0; a < 3; ++a) slope[a] += place.slope[s - Domain::first_slope][a][lane] * sum[s];
      f(place.lowest[lane] + offset[0] + Place::side * (offset[1] + Place::side * offset[2]), value, slope);
    }
  }
};

}  // namespace mpm::core
