// The motion of a rigid body: Newton's and Euler's equations with a step's impulses, and rotations without
// drift.
//
// Within a step the body moves with the velocity V and spin w that it would have without contact: every point
// x has the velocity V + w x (x - c), and ends at c + dt V + R (x - c), R the rotation by dt w. Impulses J
// and their moment H about c then change momentum and angular momentum at the end of the step.
#pragma once

#include <cmath>

#include "core/tensor/tensor.hpp"

namespace mpm::core {

struct RigidState {
  double mass = 0;
  Vec3<double> centre{};    ///< of mass
  Vec3<double> velocity{};  ///< of the centre
  Vec3<double> spin{};      ///< angular velocity
  Sym3<double> inertia{};   ///< about the centre, global axes
  // Of the last step.
  Vec3<double> force{}, moment{};  ///< by contact, mean over the step; the moment about the centre
  double contacts = 0;             ///< nodes at which the body touched others

  static constexpr int size = 23;  ///< doubles, in restart files
};
static_assert(sizeof(RigidState) == RigidState::size * sizeof(double));

inline Vec3<double> velocity_at(const RigidState& s, const Vec3<double>& x) {
  return s.velocity + cross(s.spin, x - s.centre);
}

/// Rotation by the angle and axis of `w`, exact for any angle below a half turn.
inline Mat3<double> rotation(const Vec3<double>& w) {
  const double half = 0.5 * std::sqrt(dot(w, w));
  return mid_point_rotation((half > 0 ? std::tan(half) / half : 1.0) * w);
}

inline Vec3<double> operator*(const Mat3<double>& m, const Vec3<double>& v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.yx * v.x + m.yy * v.y + m.yz * v.z,
          m.zx * v.x + m.zy * v.y + m.zz * v.z};
}
inline Vec3<double> operator*(const Sym3<double>& m, const Vec3<double>& v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

inline double kinetic_energy(const RigidState& s) {
  return 0.5 * s.mass * dot(s.velocity, s.velocity) + 0.5 * dot(s.spin, s.inertia * s.spin);
}

/// The spin with the angular momentum `l`; none about axes without inertia (particles on one line).
inline Vec3<double> spin_of(const Sym3<double>& inertia, const Vec3<double>& l) {
  const Mat3<double> m{inertia.xx, inertia.xy, inertia.xz, inertia.xy, inertia.yy,
                       inertia.yz, inertia.xz, inertia.yz, inertia.zz};
  const double d = determinant(m), size = inertia.xx + inertia.yy + inertia.zz;
  constexpr double least = 1e-12;  // of the largest determinant with this trace
  if (!(d > least * size * size * size / 27)) return {};
  return (1 / d) * (adjugate(m) * l);
}

/// The end of a step of length dt with contact's impulse and its moment about the centre at its beginning;
/// `driven`: contact does not change the motion.
inline void end_step(RigidState& s, double dt, const Vec3<double>& impulse, const Vec3<double>& moment,
                     bool driven) {
  const Vec3<double> angular_momentum = s.inertia * s.spin + moment;
  s.inertia = rotate(rotation(dt * s.spin), s.inertia);
  s.centre = s.centre + dt * s.velocity;
  s.force = (1 / dt) * impulse;
  s.moment = (1 / dt) * moment;
  if (driven) return;
  s.velocity = s.velocity + (1 / s.mass) * impulse;
  s.spin = spin_of(s.inertia, angular_momentum);
}

}  // namespace mpm::core
