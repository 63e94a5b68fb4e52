// Particles to grid (thesis 2-31, 2-32, 2-38): what one block of particles adds to its brick's nodes.
//
// The eight nodes of a cell ride in the lanes of one vector; a particle adds itself to seven of them
// (momentum, mass, force), and only when the cell changes are they turned into node records and written.
// Particles are kept in approximate cell order, so that is once in about eight. Oracle:
// tests/support/reference_stepper.
#pragma once

#include "core/particles/columns.hpp"
#include "core/step/shape.hpp"

namespace mpm::core {

/// What is mapped, to which array: components 0..2 momentum, 3 mass, 4..6 force of its records.
enum class Mapped {
  momentum_mass_force,  ///< first array
  momentum_mass,        ///< second
  momentum,             ///< second; mass stays 0
  force                 ///< first; momentum and mass stay 0
};

constexpr bool maps_momentum(Mapped m) { return m != Mapped::force; }
constexpr bool maps_mass(Mapped m) { return m == Mapped::momentum_mass_force || m == Mapped::momentum_mass; }
constexpr NodeArray array_of(Mapped m) {
  return m == Mapped::momentum_mass || m == Mapped::momentum ? NodeArray::second : NodeArray::first;
}
constexpr bool maps_force(Mapped m) { return m == Mapped::momentum_mass_force || m == Mapped::force; }

namespace detail {
using Nodes = Lanes<8>;

/// Rows to columns of an 8 x 8 matrix.
inline void transpose(Nodes r[8]) {
  using V = Nodes::vector;
  V a[8], b[8];
  for (int i = 0; i < 4; ++i) {
    a[2 * i] = __builtin_shufflevector(r[2 * i].v, r[2 * i + 1].v, 0, 8, 2, 10, 4, 12, 6, 14);
    a[2 * i + 1] = __builtin_shufflevector(r[2 * i].v, r[2 * i + 1].v, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int h = 0; h < 2; ++h) {
    for (int i = 0; i < 2; ++i) {
      b[4 * h + i] = __builtin_shufflevector(a[4 * h + i], a[4 * h + 2 + i], 0, 1, 8, 9, 4, 5, 12, 13);
      b[4 * h + 2 + i] = __builtin_shufflevector(a[4 * h + i], a[4 * h + 2 + i], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (int i = 0; i < 4; ++i) {
    r[i].v = __builtin_shufflevector(b[i], b[4 + i], 0, 1, 2, 3, 8, 9, 10, 11);
    r[4 + i].v = __builtin_shufflevector(b[i], b[4 + i], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}
}  // namespace detail

/// Sums over the particles of one cell, node i + 2 j + 4 k in lane i + 2 j + 4 k.
template <Mapped what>
struct CellSums {
  detail::Nodes px, py, pz, m, fx, fy, fz;
  int node = -1;

  void clear() { px = py = pz = m = fx = fy = fz = detail::Nodes(0.0); }

  void flush(double* contributions, const CellCorners& corners) {
    if (node < 0) return;
    detail::Nodes r[8] = {px, py, pz, m, fx, fy, fz, detail::Nodes(0.0)};
    detail::transpose(r);
    constexpr int width = record_doubles(array_of(what));
    using Record = Lanes<width>;
    double* lowest = contributions + width * node;
    for (int n = 0; n < 8; ++n) {
      double* at = lowest + width * corners.node[n];
      store(at, load<Record>(at) + load<Record>(reinterpret_cast<const double*>(&r[n])));
    }
  }
};

/// Add the first `used` particles of a block.
template <Mapped what>
inline void add_block(const BrickFrame& frame, const CellCorners& corners, const ColumnLayout& layout,
                      const double* block, int used, CellSums<what>& running, double* contributions) {
  using N = detail::Nodes;
  CellSums<what> sums = running;  // a local of its own stays in registers
  const auto col = [&](Column c) { return block + layout.offset(c); };
  alignas(64) double q[10][block_lanes];  // m, m v, -V sigma
  alignas(64) double f[3][block_lanes];
  int node[block_lanes];
  for (int l = 0; l < block_lanes; l += real_width) {
    const auto p = locate<Real>(frame, col(Column::position_x) + l, col(Column::position_y) + l,
                                col(Column::position_z) + l);
    store(f[0] + l, p.fx);
    store(f[1] + l, p.fy);
    store(f[2] + l, p.fz);
    for (int i = 0; i < real_width; ++i) node[l + i] = p.node[i];
    if constexpr (maps_momentum(what)) {
      const Real m = load<Real>(col(Column::mass) + l);
      store(q[0] + l, m);
      for (int a = 0; a < 3; ++a) store(q[1 + a] + l, m * load<Real>(col(next(Column::velocity_x, a)) + l));
    }
    if constexpr (maps_force(what)) {
      const Real v = -load<Real>(col(Column::volume) + l);
      const Real p_total =
          load<Real>(col(Column::pressure) + l) + load<Real>(col(Column::viscous_pressure) + l);
      for (int a = 0; a < 3; ++a)
        store(q[4 + a] + l, v * (load<Real>(col(next(Column::s_xx, a)) + l) - p_total));
      for (int a = 3; a < 6; ++a) store(q[4 + a] + l, v * load<Real>(col(next(Column::s_xx, a)) + l));
    }
  }
  const N one_x(N::vector{1, 0, 1, 0, 1, 0, 1, 0}), sign_x(N::vector{-1, 1, -1, 1, -1, 1, -1, 1});
  const N one_y(N::vector{1, 1, 0, 0, 1, 1, 0, 0}), sign_y(N::vector{-1, -1, 1, 1, -1, -1, 1, 1});
  const N one_z(N::vector{1, 1, 1, 1, 0, 0, 0, 0}), sign_z(N::vector{-1, -1, -1, -1, 1, 1, 1, 1});
  for (int i = 0; i < used; ++i) {
    if (node[i] != sums.node) {
      sums.flush(contributions, corners);
      sums.clear();
      sums.node = node[i];
    }
    const N wx = one_x + sign_x * N(f[0][i]), wy = one_y + sign_y * N(f[1][i]),
            wz = one_z + sign_z * N(f[2][i]);
    const N wyz = wy * wz;
    if constexpr (maps_momentum(what)) {
      const N w = wx * wyz;
      if constexpr (maps_mass(what)) sums.m += w * N(q[0][i]);
      sums.px += w * N(q[1][i]);
      sums.py += w * N(q[2][i]);
      sums.pz += w * N(q[3][i]);
    }
    if constexpr (maps_force(what)) {
      const N gx = sign_x * wyz * N(frame.inverse_cell.x), gy = sign_y * (wx * wz) * N(frame.inverse_cell.y),
              gz = sign_z * (wx * wy) * N(frame.inverse_cell.z);
      sums.fx += gx * N(q[4][i]) + gy * N(q[7][i]) + gz * N(q[9][i]);
      sums.fy += gx * N(q[7][i]) + gy * N(q[5][i]) + gz * N(q[8][i]);
      sums.fz += gx * N(q[9][i]) + gy * N(q[8][i]) + gz * N(q[6][i]);
    }
  }
  running = sums;
}

}  // namespace mpm::core
