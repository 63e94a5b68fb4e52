// Particles to grid (thesis 2-31, 2-32, 2-38): what one block of particles adds to its brick's nodes.
//
// The eight nodes of a cell ride in the lanes of one vector; a particle adds itself to ten of them (momentum,
// mass, V sigma), and only when the cell changes are they turned into node records and written.
// Particles are kept in approximate cell order, so that is once in about eight. Oracle:
// tests/support/reference_stepper.
#pragma once

#include "core/particles/columns.hpp"
#include "core/simd/transpose.hpp"
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

/// A node's weight along an axis is 1 - f or f: its slope.
inline Nodes sign_x() { return Nodes::vector{-1, 1, -1, 1, -1, 1, -1, 1}; }
inline Nodes sign_y() { return Nodes::vector{-1, -1, 1, 1, -1, -1, 1, 1}; }
inline Nodes sign_z() { return Nodes::vector{-1, -1, -1, -1, 1, 1, 1, 1}; }

/// Both nodes of an edge along an axis get the sum of the two.
inline Nodes along_x(Nodes a) { return a.v + __builtin_shufflevector(a.v, a.v, 1, 0, 3, 2, 5, 4, 7, 6); }
inline Nodes along_y(Nodes a) { return a.v + __builtin_shufflevector(a.v, a.v, 2, 3, 0, 1, 6, 7, 4, 5); }
inline Nodes along_z(Nodes a) { return a.v + __builtin_shufflevector(a.v, a.v, 4, 5, 6, 7, 0, 1, 2, 3); }
}  // namespace detail

/// Sums over the particles of one cell, node i + 2 j + 4 k in lane i + 2 j + 4 k. The force on a node is
/// minus the sum of V sigma times the weight's gradient. Its component along an axis is a sign over the
/// cell's edge times the weights along the other two axes, and these are what the weights of the edge's two
/// nodes add up to. So V sigma is summed with the weights themselves, and a flush makes forces of the sums.
template <Mapped what>
struct CellSums {
  detail::Nodes px, py, pz, m;
  detail::Nodes xx, yy, zz, xy, yz, xz;  ///< V sigma times the weights
  int node = -1;

  void clear() {
    px = py = pz = m = detail::Nodes(0.0);
    xx = yy = zz = xy = yz = xz = detail::Nodes(0.0);
  }

  [[gnu::always_inline]] void flush(const BrickFrame& frame, double* contributions) {
    using N = detail::Nodes;
    if (node < 0) return;
    N r[8] = {px, py, pz, m, N(0.0), N(0.0), N(0.0), N(0.0)};
    if constexpr (maps_force(what)) {
      using namespace detail;
      const N gx = sign_x() * N(-frame.inverse_cell.x), gy = sign_y() * N(-frame.inverse_cell.y),
              gz = sign_z() * N(-frame.inverse_cell.z);
      r[4] = gx * along_x(xx) + gy * along_y(xy) + gz * along_z(xz);
      r[5] = gx * along_x(xy) + gy * along_y(yy) + gz * along_z(yz);
      r[6] = gx * along_x(xz) + gy * along_y(yz) + gz * along_z(zz);
    }
    constexpr int width = record_doubles(array_of(what));
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

/// Add the first `used` particles of a block.
template <Mapped what>
[[gnu::always_inline]] inline void add_block(const BrickFrame& frame, const BlockPlace& place,
                                             const ColumnLayout& layout, const double* block, int used,
                                             CellSums<what>& running, double* contributions) {
  using N = detail::Nodes;
  CellSums<what> sums = running;  // a local of its own stays in registers
  const auto col = [&](Column c) { return block + layout.offset(c); };
  alignas(64) double q[10][block_lanes];  // m, m v, V sigma
  for (int l = 0; l < block_lanes; l += real_width) {
    if constexpr (maps_momentum(what)) {
      const Real m = load<Real>(col(Column::mass) + l);
      store(q[0] + l, m);
      for (int a = 0; a < 3; ++a) store(q[1 + a] + l, m * load<Real>(col(next(Column::velocity_x, a)) + l));
    }
    if constexpr (maps_force(what)) {
      const Real v = load<Real>(col(Column::volume) + l);
      const Real p_total =
          load<Real>(col(Column::pressure) + l) + load<Real>(col(Column::viscous_pressure) + l);
      for (int a = 0; a < 3; ++a)
        store(q[4 + a] + l, v * (load<Real>(col(next(Column::s_xx, a)) + l) - p_total));
      for (int a = 3; a < 6; ++a) store(q[4 + a] + l, v * load<Real>(col(next(Column::s_xx, a)) + l));
    }
  }
  const N one_x(N::vector{1, 0, 1, 0, 1, 0, 1, 0}), one_y(N::vector{1, 1, 0, 0, 1, 1, 0, 0}),
      one_z(N::vector{1, 1, 1, 1, 0, 0, 0, 0});
  const N sign_x = detail::sign_x(), sign_y = detail::sign_y(), sign_z = detail::sign_z();
  for (int i = 0; i < used; ++i) {
    if (place.node[i] != sums.node) {
      sums.flush(frame, contributions);
      sums.clear();
      sums.node = place.node[i];
    }
    const N wx = one_x + sign_x * N(place.f[0][i]), wy = one_y + sign_y * N(place.f[1][i]),
            wz = one_z + sign_z * N(place.f[2][i]);
    const N w = wx * wy * wz;
    if constexpr (maps_momentum(what)) {
      if constexpr (maps_mass(what)) sums.m += w * N(q[0][i]);
      sums.px += w * N(q[1][i]);
      sums.py += w * N(q[2][i]);
      sums.pz += w * N(q[3][i]);
    }
    if constexpr (maps_force(what)) {
      sums.xx += w * N(q[4][i]);
      sums.yy += w * N(q[5][i]);
      sums.zz += w * N(q[6][i]);
      sums.xy += w * N(q[7][i]);
      sums.yz += w * N(q[8][i]);
      sums.xz += w * N(q[9][i]);
    }
  }
  running = sums;
}

}  // namespace mpm::core
