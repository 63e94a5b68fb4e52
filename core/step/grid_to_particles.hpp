// Grid to particles: velocity, position and velocity gradient of one block from its brick's nodes
// (thesis 2-28, 2-42, 2-43). Particles ride in the lanes; each distinct cell among them is visited once.
//
// A node record after the node update: 0..2 velocity at the end of the step, 3 mass, 4..6 its increment, or,
// once that is with the particles, the velocity that strains them (node_update.hpp); 7 USL's share left out.
#pragma once

#include "core/particles/columns.hpp"
#include "core/step/shape.hpp"

namespace mpm::core {

/// v += sum S dv, from node components 4..6.
inline void add_velocity_increment(const BrickFrame& frame, const CellCorners& corners,
                                   const ColumnLayout& layout, const double* nodes, double* block) {
  const auto col = [&](Column c) { return block + layout.offset(c); };
  for (int l = 0; l < block_lanes; l += real_width) {
    const auto p = locate<Real>(frame, col(Column::position_x) + l, col(Column::position_y) + l,
                                col(Column::position_z) + l);
    Real dv[3] = {Real(0.0), Real(0.0), Real(0.0)};
    for_each_cell(p, [&](int node, MaskOf<Real> here) {
      const double* lowest = nodes + node_doubles * node + 4;
      for (int a = 0; a < 3; ++a)
        dv[a] = select(here, interpolate(CornerValues(lowest + a, corners), p), dv[a]);
    });
    for (int a = 0; a < 3; ++a) {
      double* v = col(next(Column::velocity_x, a)) + l;
      store(v, load<Real>(v) + dv[a]);
    }
  }
}

/// Gradient of node components 4..6 at the block's particles into rows 0..8 (order of Mat3), columns `at` ..
/// `at` + 7.
template <class Rows>
inline void velocity_gradient(const BrickFrame& frame, const CellCorners& corners, const ColumnLayout& layout,
                              const double* nodes, const double* block, Rows& rows, int at) {
  const auto col = [&](Column c) { return block + layout.offset(c); };
  for (int l = 0; l < block_lanes; l += real_width) {
    const auto p = locate<Real>(frame, col(Column::position_x) + l, col(Column::position_y) + l,
                                col(Column::position_z) + l);
    Real g[9] = {};
    for_each_cell(p, [&](int node, MaskOf<Real> here) {
      const double* lowest = nodes + node_doubles * node + 4;
      for (int a = 0; a < 3; ++a) {
        const Vec3<Real> ga = scaled_gradient(CornerValues(lowest + a, corners), p);
        for (int j = 0; j < 3; ++j) g[3 * a + j] = select(here, ga[j], g[3 * a + j]);
      }
    });
    for (int a = 0; a < 3; ++a) {
      for (int j = 0; j < 3; ++j) store(rows[3 * a + j] + at + l, g[3 * a + j] * Real(frame.inverse_cell[j]));
    }
  }
}

/// Volumetric strain of the cells that hold the block's particles: dt times the mean of div v over each cell,
/// which for trilinear functions is its value at the centre; of node components 4..6.
template <class Row>
inline void cell_strain(const BrickFrame& frame, const CellCorners& corners, const ColumnLayout& layout,
                        const double* nodes, double dt, const double* block, Row& row, int at) {
  const auto col = [&](Column c) { return block + layout.offset(c); };
  for (int l = 0; l < block_lanes; l += real_width) {
    auto p = locate<Real>(frame, col(Column::position_x) + l, col(Column::position_y) + l,
                          col(Column::position_z) + l);
    p.fx = p.fy = p.fz = Real(0.5);
    Real strain(0.0);
    for_each_cell(p, [&](int node, MaskOf<Real> here) {
      const double* lowest = nodes + node_doubles * node + 4;
      Real divergence(0.0);
      for (int a = 0; a < 3; ++a) {
        divergence += scaled_gradient(CornerValues(lowest + a, corners), p)[a] * Real(frame.inverse_cell[a]);
      }
      strain = select(here, divergence * Real(dt), strain);
    });
    store(row + at + l, strain);
  }
}

/// x += dt sum S v, from node components 0..2.
inline void move_with_grid(const BrickFrame& frame, const CellCorners& corners, const ColumnLayout& layout,
                           const double* nodes, double dt, double* block) {
  const auto col = [&](Column c) { return block + layout.offset(c); };
  for (int l = 0; l < block_lanes; l += real_width) {
    const auto p = locate<Real>(frame, col(Column::position_x) + l, col(Column::position_y) + l,
                                col(Column::position_z) + l);
    Real v[3] = {Real(0.0), Real(0.0), Real(0.0)};
    for_each_cell(p, [&](int node, MaskOf<Real> here) {
      const double* lowest = nodes + node_doubles * node;
      for (int a = 0; a < 3; ++a)
        v[a] = select(here, interpolate(CornerValues(lowest + a, corners), p), v[a]);
    });
    for (int a = 0; a < 3; ++a) {
      double* x = col(next(Column::position_x, a)) + l;
      store(x, load<Real>(x) + Real(dt) * v[a]);
    }
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
