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

/// Of a cell by its lowest point, and back.
constexpr int cell_at(int point) {
  const auto [i, j, k] = lattice_points.node(point);
  return i + brick_cells * (j + brick_cells * k);
}
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

/// Sums of m w_i w_j over the particles of the current cell; moments of cells are added to when it changes.
struct Sums {
  linear::Nodes row[8];
  int point = -1;

  [[gnu::always_inline]] void add(const LinearPlace& place, int i, double m, double* moments) {
    if (place.node[i] != point) {
      flush(moments);
      for (linear::Nodes& r : row) r = linear::Nodes(0.0);
      point = place.node[i];
    }
    const linear::Nodes w = linear::weights(place, i), mw = linear::Nodes(m) * w;
    for (int j = 0; j < 8; ++j) row[j] += mw * linear::Nodes(w[j]);
  }
  void flush(double* moments) const {
    if (point < 0) return;
    double* to = moments + doubles * cell_at(point);
    // Each moment from one of the pairs with its i + j: M_ij with i's bits where i + j is 1 or 2, j's
    // where 2.
    for (int s = 0; s < 27; ++s) {
      const int along[3] = {s % 3, s / 3 % 3, s / 9};
      int i = 0, j = 0;
      for (int a = 0; a < 3; ++a) {
        if (along[a] > 0) i |= 1 << a;
        if (along[a] > 1) j |= 1 << a;
      }
      to[s] += row[j][i];
    }
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
