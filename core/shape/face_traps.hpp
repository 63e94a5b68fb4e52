// Particles trapped at a face of cells, with linear functions and USF, whose gradients jump there.
//
// Below a face a compressed particle pushes the face's nodes up, above it down. Once slow it therefore stays,
// and crosses the face every few steps. Each kick moves it across, so it is above the face while the face
// moves up and below while it moves down; USF takes that velocity for its strain, which is a compression
// every time. Stress and kicks grow exponentially, by up to (c dt/h)^2/2 per step. (USF adds to the energy,
// per step, sum m dv^2/2 - sum V dsigma : de/2: here the kicks dv, and no strain.)
//
// With the traction t = -sigma n on a face normal to axis n, and w_i the particle's weights on the face among
// the face's nodes, of masses m_i, a step's kick of its own is k = dt V t_n B/h, B = sum w_i^2/m_i; with all
// others there it is at most K = dt V t_n/(m h). A particle counts as trapped if it leaves the face at a
// speed u < 2 K and is nearer to it than dt max(k, 2 u), 2 since the nodes' velocity is the smoothed one of
// the particles. It is then strained as if a share of the kick had already acted:
//   L_nn <- L_nn + s k/h,   L_an <- L_an + min(s, 1) k (t_a/t_n)/h,   s = max(u/k, 1/2) min(1, 2 - u/K)
// s = u/k takes the face's own velocity out of the strain: kicks then neither add nor take energy, as if half
// of the strain were that of the cell that has been left. Forces and velocities stay as they are.
// In cells beside lighter ones particles act away from the faces (linear.hpp), and none counts as trapped.
// Tested by tests/core/step/oracle_test.cpp and tests/system/physics_face_trap.py.
#pragma once

#include "core/shape/linear.hpp"

namespace mpm::core {

/// Bit mask of the lanes that may be trapped: those within 4 dt K of a face, the most of max(k, 2 u).
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
      return f * (Real(1.0) - f) * m < Real(4 * step * step) * v * t;
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
      const double response = dt * of(Column::volume) * inverse_cell[n];
      const double own = response * face.inverse_mass, kick = own * traction[n][n];
      const double most = response / of(Column::mass) * traction[n][n];
      if (!(kick > 0 && face.away > 0 && face.away < 2 * most)) continue;
      if (!(face.distance < dt * inverse_cell[n] * std::max(kick, 2 * face.away))) continue;
      const double share = std::max(face.away / kick, 0.5) * std::min(1.0, 2 - face.away / most);
      for (int a = 0; a < 3; ++a)
        rows[3 * a + n][at + lane] +=
            (a == n ? share : std::min(share, 1.0)) * own * inverse_cell[n] * traction[n][a];
    }
  }
}

}  // namespace mpm::core
