// The consistent mass of one cell of the lattice, for shape functions that are trilinear on it: its products
// need no particles.
//
//   M_ij = sum_p m_p w_i w_j,   w_i = product over the axes of f or 1 - f
// depends on i and j through i + j alone, which is 0, 1 or 2 on each axis: 27 moments of a cell, those of
// m_p times (1 - f)^2, f (1 - f) or f^2 along each axis. Shown by tests/core/shape/cell_mass_test.cpp.
#pragma once

#include <cstdint>

#include "core/shape/linear.hpp"

namespace mpm::core {

namespace cell_mass {

/// A cell's moments, (i + j)_x + 3 (i + j)_y + 9 (i + j)_z, in a record of whole cache lines.
inline constexpr int doubles = 32;
inline constexpr int in_use = 27;  ///< of a record: whether the cell has particles
inline constexpr int cells = brick_cells * brick_cells * brick_cells;
inline constexpr int brick_doubles = doubles * cells;

/// Of a cell by its number.
constexpr int lowest_point(int cell) {
  constexpr int side = lattice_points.side();
  return cell % brick_cells +
         side * (cell / brick_cells % brick_cells + side * (cell / (brick_cells * brick_cells)));
}
/// Moment of M_0j, hence the lowest of M_ij, i = 0..7.
constexpr int moment(int j) { return (j & 1) + 3 * (j >> 1 & 1) + 9 * (j >> 2); }

/// M_ij, i in lanes.
[[gnu::always_inline]] inline linear::Nodes row(const double* moments, int j) {
  const double* from = moments + moment(j);
  const auto low = load<linear::Nodes>(from), high = load<linear::Nodes>(from + 8);
  return __builtin_shufflevector(low.v, high.v, 0, 1, 3, 4, 9, 10, 12, 13);
}

/// Lanes of one vector, or of two.
template <int... lanes>
[[gnu::always_inline]] inline linear::Nodes pick(const linear::Nodes& a, const linear::Nodes& b) {
  return __builtin_shufflevector(a.v, b.v, lanes...);
}
template <int... lanes>
[[gnu::always_inline]] inline linear::Nodes pick(const linear::Nodes& a) {
  return pick<lanes...>(a, a);
}

/// Sums of m w_i w_j over the particles of the current cell; moments of cells are added to when it changes.
struct Sums {
  /// One pair for each i + j, with i's bits where it is 1 or 2 along an axis, j's where 2:
  ///   i  0 1 2 3 4 5 6 7   1 3 5 7 2 3 6 7   4 5 6 7 3 7 5 7   6 7 7
  ///   j  0 0 0 0 0 0 0 0   1 1 1 1 2 2 2 2   4 4 4 4 3 3 5 5   6 6 7
  linear::Nodes pairs[4];
  int point = -1;

  [[gnu::always_inline]] void add(const LinearPlace& place, int i, double m, double* moments) {
    if (place.node[i] != point) {
      flush(moments);
      for (linear::Nodes& p : pairs) p = linear::Nodes(0.0);
      point = place.node[i];
    }
    const linear::Nodes w = linear::weights(place, i), mw = linear::Nodes(m) * w;
    pairs[0] += mw * pick<0, 0, 0, 0, 0, 0, 0, 0>(w);
    pairs[1] += pick<1, 3, 5, 7, 2, 3, 6, 7>(mw) * pick<1, 1, 1, 1, 2, 2, 2, 2>(w);
    pairs[2] += pick<4, 5, 6, 7, 3, 7, 5, 7>(mw) * pick<4, 4, 4, 4, 3, 3, 5, 5>(w);
    pairs[3] += pick<6, 7, 7, 7, 7, 7, 7, 7>(mw) * pick<6, 6, 7, 7, 7, 7, 7, 7>(w);
  }
  void flush(double* moments) const {
    if (point < 0) return;
    double* to = moments + doubles * cell_at(point);
    const auto add_to = [](double* at, const linear::Nodes& more) {
      store(at, load<linear::Nodes>(at) + more);
    };
    add_to(to, pick<0, 1, 8, 2, 3, 9, 12, 13>(pairs[0], pairs[1]));
    add_to(to + 8,
           pick<12, 1, 2, 3, 4, 5, 6, 7>(pick<0, 4, 5, 10, 6, 7, 11, 14>(pairs[0], pairs[1]), pairs[2]));
    add_to(to + 16, pick<15, 5, 0, 1, 6, 2, 3, 7>(pairs[2], pairs[1]));
    add_to(to + 24, pairs[3]);
    to[in_use] = 1;
  }
};

/// Adds M d of the cell whose lowest point this is to `px`, `py`, `pz`; d: three components, records of
/// node_doubles from the lattice's first point on.
[[gnu::always_inline]] inline void multiply(const double* moments, const double* d, int point,
                                            linear::Nodes& px, linear::Nodes& py, linear::Nodes& pz) {
  using N = linear::Nodes;
  const double* lowest = d + node_doubles * point;
  for (int j = 0; j < 8; ++j) {
    const N m = row(moments, j);
    const double* at = lowest + node_doubles * corner_node(j);
    px += m * N(at[0]);
    py += m * N(at[1]);
    pz += m * N(at[2]);
  }
}

}  // namespace cell_mass

/// Shape functions whose values are trilinear on the lattice, so that particles are mapped by its cells.
template <class S>
inline constexpr bool trilinear_on_lattice = requires(typename S::template Scatter<mapped::correction>& cell,
                                                      const typename S::Place& place) {
  cell.sums.px;
  cell.node;
  linear::weights(place, 0);
};

}  // namespace mpm::core
