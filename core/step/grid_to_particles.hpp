// Grid to particles: velocity, position and velocity gradient of one block from its brick's nodes
// (thesis 2-28, 2-42, 2-43). Particles ride in the lanes; each distinct cell among them is visited once.
//
// A node record after the node update: 0..2 velocity at the end of the step, 3 mass, 4..6 its increment, or,
// once that is with the particles, the velocity that strains them (node_update.hpp); 7 USL's share left out.
#pragma once

#include "core/particles/columns.hpp"
#include "core/simd/transpose.hpp"
#include "core/step/shape.hpp"

namespace mpm::core {

namespace detail {
/// The values of three neighbouring components at the block's particles, from `nodes` on.
struct AtParticles {
  Lanes<8> value[4];
  AtParticles(const BlockPlace& place, const double* nodes) {
    Lanes<4> row[block_lanes];
    for (int i = 0; i < block_lanes;) {
      const CellFields<4> cell(place.node[i], nodes);
      do {
        row[i] = cell.value(place.f[0][i], place.f[1][i], place.f[2][i]);
      } while (++i < block_lanes && place.node[i] == cell.node);
    }
    transpose_rows(row, value);
  }
};
}  // namespace detail

/// v += sum S dv, from node components 4..6.
inline void add_velocity_increment(const BlockPlace& place, const ColumnLayout& layout, const double* nodes,
                                   double* block) {
  const detail::AtParticles dv(place, nodes + 4);
  for (int a = 0; a < 3; ++a) {
    double* v = block + layout.offset(next(Column::velocity_x, a));
    store(v, load<Lanes<8>>(v) + dv.value[a]);
  }
}

/// x += dt sum S v, from node components 0..2.
inline void move_with_grid(const BlockPlace& place, const ColumnLayout& layout, const double* nodes,
                           double dt, double* block) {
  const detail::AtParticles v(place, nodes);
  for (int a = 0; a < 3; ++a) {
    double* x = block + layout.offset(next(Column::position_x, a));
    store(x, load<Lanes<8>>(x) + Lanes<8>(dt) * v.value[a]);
  }
}

/// Gradient of node components 4..6 at the block's particles into rows 0..8 (order of Mat3), columns `at` ..
/// `at` + 7; where it moves, also x += dt sum S v from components 0..2.
template <bool moves, class Rows>
inline void strain(const BrickFrame& frame, const BlockPlace& place, const ColumnLayout& layout,
                   const double* nodes, double dt, double* block, Rows& rows, int at) {
  using R = Lanes<8>;
  R a[block_lanes], b[block_lanes];  // value 0..3 and d/dx of 4..7; d/dy and d/dz of 4..7
  for (int i = 0; i < block_lanes;) {
    const CellFields<8> cell(place.node[i], nodes);
    const auto& c = cell.c;
    do {
      const R x(place.f[0][i]), y(place.f[1][i]), z(place.f[2][i]);
      const R front = c[2] + x * c[3], back = c[6] + x * c[7];
      const R dx = c[1] + y * c[3] + z * (c[5] + y * c[7]);
      const R dy = front + z * back;
      const R dz = c[4] + x * c[5] + y * back;
      const R value = c[0] + x * c[1] + y * front + z * dz;
      a[i] = __builtin_shufflevector(value.v, dx.v, 0, 1, 2, 3, 12, 13, 14, 15);
      b[i] = __builtin_shufflevector(dy.v, dz.v, 4, 5, 6, 7, 12, 13, 14, 15);
    } while (++i < block_lanes && place.node[i] == cell.node);
  }
  transpose(a);
  transpose(b);
  for (int i = 0; i < 3; ++i) {
    store(rows[3 * i] + at, a[4 + i] * R(frame.inverse_cell.x));
    store(rows[3 * i + 1] + at, b[i] * R(frame.inverse_cell.y));
    store(rows[3 * i + 2] + at, b[4 + i] * R(frame.inverse_cell.z));
    if constexpr (moves) {
      double* to = block + layout.offset(next(Column::position_x, i));
      store(to, load<R>(to) + R(dt) * a[i]);
    }
  }
}

/// Volumetric strain of the cells that hold the block's particles: dt times the mean of div v over each cell,
/// which for trilinear functions is its value at the centre; of node components 4..6.
template <class Row>
inline void cell_strain(const BrickFrame& frame, const BlockPlace& place, const double* nodes, double dt,
                        Row& row, int at) {
  for (int i = 0; i < block_lanes;) {
    const CellFields<4> cell(place.node[i], nodes + 4);
    const auto& c = cell.c;
    const Lanes<4> half(0.5), quarter(0.25);
    const Lanes<4> dx = c[1] + half * (c[3] + c[5]) + quarter * c[7],
                   dy = c[2] + half * (c[3] + c[6]) + quarter * c[7],
                   dz = c[4] + half * (c[5] + c[6]) + quarter * c[7];
    const double divergence =
        dx[0] * frame.inverse_cell.x + dy[1] * frame.inverse_cell.y + dz[2] * frame.inverse_cell.z;
    do row[at + i] = divergence * dt;
    while (++i < block_lanes && place.node[i] == cell.node);
  }
}

/// Bits of the lanes that are no longer in the brick (or nowhere: not-a-number counts as outside).
inline unsigned lanes_outside(const BrickFrame& frame, const ColumnLayout& layout, const double* block,
                              int used) {
  unsigned outside = 0;
  const double* x[3] = {block + layout.offset(Column::position_x), block + layout.offset(Column::position_y),
                        block + layout.offset(Column::position_z)};
  for (int l = 0; l < block_lanes; l += real_width) {
    auto inside = Real(0.0) <= Real(0.0);
    for (int a = 0; a < 3; ++a) {
      const Real s = GridGeometry::scaled(load<Real>(x[a] + l), frame.origin[a], frame.inverse_cell[a]) -
                     Real(frame.first_cell[a]);
      inside = inside & (s >= Real(0.0)) & (s < Real(frame.last_cell[a] + 1.0));
    }
    if (all(inside)) continue;
    for (int i = 0; i < real_width && l + i < used; ++i) {
      outside |= static_cast<unsigned>(!test(inside, i)) << (l + i);
    }
  }
  return outside;
}

}  // namespace mpm::core
