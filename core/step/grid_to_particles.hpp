// Grid to particles: velocity, position and velocity gradient of one block from its brick's nodes
// (thesis 2-28, 2-42, 2-43). Particles ride in the lanes; each distinct cell among them is visited once.
//
// A node record after the node update: 0..2 velocity at the end of the step, 3 mass, 4..6 its increment, or,
// once that is with the particles, the velocity that strains them (node_update.hpp); 7 USL's share left out.
#pragma once

#include "core/particles/columns.hpp"
#include "core/step/shape.hpp"

namespace mpm::core {

namespace detail {
/// Three neighbouring node components, from `nodes` on, at the block's particles.
struct AtParticles {
  using R = Lanes<8>;
  R value[3];
  AtParticles(const BlockPlace& place, const double* nodes) : value{0.0, 0.0, 0.0} {
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
/// `at` + 7.
template <class Rows>
inline void velocity_gradient(const BrickFrame& frame, const BlockPlace& place, const double* nodes,
                              Rows& rows, int at) {
  using R = Lanes<8>;
  const R x = load<R>(place.f[0]), y = load<R>(place.f[1]), z = load<R>(place.f[2]);
  R gradient[9] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  for_each_cell(place, [&](int node, auto here) {
    const double* lowest = nodes + node_doubles * node + 4;
    for (int i = 0; i < 3; ++i) {
      const auto v = [&](int n) { return R(lowest[node_doubles * corner_node(n) + i]); };
      // Differences along x on the four edges, and the values at x; then the same with these along y and z.
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

/// Volumetric strain of the cells that hold the block's particles: dt times the mean of div v over each cell,
/// from the mean differences along its edges; of node components 4..6.
template <class Row>
inline void cell_strain(const BrickFrame& frame, const BlockPlace& place, const double* nodes, double dt,
                        Row& row, int at) {
  for_each_cell(place, [&](int node, auto here) {
    double divergence = 0;
    for (int a = 0; a < 3; ++a) {
      double difference = 0;
      for (int n = 0; n < 8; ++n) {
        const double v = nodes[node_doubles * (node + corner_node(n)) + 4 + a];
        difference += (n >> a & 1) != 0 ? v : -v;
      }
      divergence += 0.25 * frame.inverse_cell[a] * difference;
    }
    store(row + at, select(here, Lanes<8>(divergence * dt), load<Lanes<8>>(row + at)));
  });
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
