// Particles trapped at a face of cells, with linear functions and USF, whose gradients jump there.
//
// Below a face a compressed particle pushes the face's nodes up, above it down. Once slow it therefore stays,
// and crosses the face every few steps. Each kick moves it across, so it is above the face while the face
// moves up and below while it moves down; USF takes that velocity for its strain, which is a compression
// every time. Stress and kicks grow exponentially, by up to (c dt/h)^2/2 per step. (USF adds to the energy,
// per step, sum m dv^2/2 - sum V dsigma : de/2: here the kicks dv, and no strain.)
//
// With the traction t = -sigma n on a face normal to axis n, V the particle's volume, and w_i its weights on
// the face among the face's nodes, of masses m_i, one step's kick is k = dt V t_n B/h, B = sum w_i^2/m_i. A
// particle counts as trapped if it leaves the face at a speed u < 2 k and is nearer than dt max(k, u) to it.
// It is strained as if a share of its kick had already acted:
//   L <- L + s dt V B/h^2 t (x) n,   s = min(max(x, 1/2), 2 - x),   x = u/k
// s = x takes the face's own velocity out of the strain: the particle then neither gains nor loses energy,
// as if half of its strain were that of the cell it has left. Forces and velocities stay as they are.
// Tested by tests/core/shape/face_traps_test.cpp; benchmarks/stability/long_runs.py.
#pragma once

#include "core/shape/linear.hpp"

namespace mpm::core {

/// Bit mask of the lanes that may be within 2 dt k of a face: V t_n B/h is at most V t_n/(m h) over the
/// weight 1 - z at the face, z the distance over h.
inline unsigned lanes_near_faces(const Vec3<double>& inverse_cell, const LinearPlace& place, double dt,
                                 const ColumnLayout& layout, const double* block, int used) {
  const auto col = [&](Column c) { return block + layout.offset(c); };
  unsigned near = 0;
  for (int l = 0; l < block_lanes; l += real_width) {
    const Real m = load<Real>(col(Column::mass) + l), v = load<Real>(col(Column::volume) + l);
    const Real p = load<Real>(col(Column::pressure) + l);
    const auto close = [&](int n) {
      const Real f = load<Real>(place.f[n] + l), t = p - load<Real>(col(next(Column::s_xx, n)) + l);
      const double step = dt * inverse_cell[n];
      return f * (Real(1.0) - f) * m < Real(2 * step * step) * v * t;
    };
    const auto found = close(0) | close(1) | close(2);
    if (!any(found)) continue;
    for (int i = 0; i < real_width && l + i < used; ++i)
      near |= static_cast<unsigned>(test(found, i)) << (l + i);
  }
  return near;
}

/// The particle of a lane at the nearer of its cell's faces normal to axis `n`.
struct NearFace {
  double distance;          ///< over the cell's edge
  double away = 0;          ///< velocity from the face
  double inverse_mass = 0;  ///< B

  NearFace(const LinearPlace& place, int lane, int n, const double* nodes) {
    const bool upper = place.f[n][lane] > 0.5;
    distance = upper ? 1 - place.f[n][lane] : place.f[n][lane];
    for (int c = 0; c < 8; ++c) {
      const MotionRecord<const double> node{nodes + node_doubles * (place.node[lane] + corner_node(c))};
      double along[3];
      for (int a = 0; a < 3; ++a) along[a] = (c >> a & 1) != 0 ? place.f[a][lane] : 1 - place.f[a][lane];
      const double on_face = along[(n + 1) % 3] * along[(n + 2) % 3];
      away += along[n] * on_face * (upper ? -node.strain_velocity()[n] : node.strain_velocity()[n]);
      if ((c >> n & 1) == static_cast<int>(upper) && node.mass() > 0)
        inverse_mass += on_face * on_face / node.mass();
    }
  }
};

/// Adds to the velocity gradients of trapped particles, rows 0..8 from `at` on; `nodes`: MotionRecords with
/// the strain velocity.
template <class Rows>
inline void release_from_faces(const BrickFrame& frame, const LinearPlace& place, const double* nodes,
                               double dt, const ColumnLayout& layout, const double* block, int used,
                               Rows& rows, int at) {
  const Vec3<double>& inverse_cell = frame.inverse_cell;
  for (unsigned left = lanes_near_faces(inverse_cell, place, dt, layout, block, used); left != 0;
       left &= left - 1) {
    const int lane = __builtin_ctz(left);
    const auto of = [&](Column c) { return block[layout.offset(c) + lane]; };
    const double xx = of(Column::s_xx), yy = of(Column::s_yy), zz = of(Column::s_zz), xy = of(Column::s_xy),
                 yz = of(Column::s_yz), xz = of(Column::s_xz), p = of(Column::pressure);
    const double traction[3][3] = {{p - xx, -xy, -xz}, {-xy, p - yy, -yz}, {-xz, -yz, p - zz}};
    for (int n = 0; n < 3; ++n) {
      if (!(traction[n][n] > 0)) continue;
      const NearFace face(place, lane, n, nodes);
      const double response = dt * of(Column::volume) * face.inverse_mass * inverse_cell[n];
      const double kick = response * traction[n][n];
      if (!(face.away > 0 && face.away < 2 * kick)) continue;
      if (!(face.distance < dt * inverse_cell[n] * std::max(kick, face.away))) continue;
      const double x = face.away / kick, share = std::min(std::max(x, 0.5), 2 - x);
      for (int a = 0; a < 3; ++a)
        rows[3 * a + n][at + lane] += share * response * inverse_cell[n] * traction[n][a];
    }
  }
}

}  // namespace mpm::core
