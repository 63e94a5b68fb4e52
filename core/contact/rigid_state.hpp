// The motion of a rigid body: Newton's and Euler's equations with a step's impulses, and rotations without
// drift.
//
// Within a step the body moves with the velocity V and spin w of its end (rigid_motion.hpp; with XPIC of that
// before the corrections, as particles do): every point x
// has the velocity V + w x (x - c), and ends at c + dt V + R (x - c), R the rotation by dt w, or of a free
// body by dt times the spin that the same angular momentum has halfway. Impulses J and their moment H about c
// at the start change momentum and angular momentum, which is then kept to round-off: c moves along the
// momentum of the end.
//
// A body that symmetry planes cut is a part of the whole: the other parts cancel impulses along the planes'
// normals and moments about axes in the planes. The whole has the part's inertia about the normal, over its
// mass.
#pragma once

#include <cmath>

#include "core/step/step_length.hpp"
#include "core/tensor/tensor.hpp"

namespace mpm::core {

struct RigidState {
  double mass = 0;
  Vec3<double> centre{};    ///< of mass
  Vec3<double> velocity{};  ///< of the centre
  Vec3<double> spin{};      ///< angular velocity
  Sym3<double> inertia{};   ///< about the centre, global axes
  double contacts = 0;      ///< nodes at which the body touched others in the last step
  Vec3<double> cut{};       ///< 1 for the axes normal to symmetry planes that cut the body

  static constexpr int size = 20;  ///< doubles, in restart files
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

/// The motion that symmetry planes leave: along them, and about the normal of a single one.
inline void keep_symmetry(RigidState& s) {
  const double planes = s.cut.x + s.cut.y + s.cut.z;
  if (planes == 0) return;
  for (int a = 0; a < 3; ++a) {
    if (s.cut[a] != 0) s.velocity[a] = 0;
    if (s.cut[a] == 0 || planes > 1) s.spin[a] = 0;
  }
}

/// The spin with the angular momentum `l` that symmetry planes leave.
inline Vec3<double> spin_with(const RigidState& s, const Vec3<double>& l) {
  const double about[3] = {s.inertia.xx, s.inertia.yy, s.inertia.zz};
  for (int a = 0; a < 3; ++a) {
    if (s.cut[a] == 0) continue;
    Vec3<double> spin{};
    if (about[a] > 0) spin[a] = l[a] / about[a];
    return spin;
  }
  return spin_of(s.inertia, l);
}

/// The rotation of a free body in a step of length dt, of which `spin` is the angular velocity with the
/// inertia of its start: by that with the same angular momentum halfway, which keeps the energy to third
/// order in the step. With that of the start a body that turns about no principal axis gains energy.
inline Mat3<double> turn_in_step(const RigidState& s, const Vec3<double>& spin, double dt) {
  constexpr int iterations = 3;
  const Vec3<double> angular_momentum = s.inertia * spin;
  RigidState halfway = s;
  Vec3<double> w = spin;
  for (int i = 0; i < iterations && spin != Vec3<double>{}; ++i) {
    halfway.inertia = rotate(rotation(0.5 * dt * w), s.inertia);
    w = spin_with(halfway, angular_momentum);
  }
  return rotation(dt * w);
}

/// The end of a step, in which the body has moved with `velocity` and turned by `turn`, with contact's
/// impulse and its moment about the centre at its beginning; `driven`: contact does not change the motion.
inline void end_step(RigidState& s, const StepLength& length, const Vec3<double>& velocity,
                     const Mat3<double>& turn, const Vec3<double>& impulse, const Vec3<double>& moment,
                     bool driven) {
  const Vec3<double> angular_momentum = s.inertia * s.spin + moment;
  s.inertia = rotate(turn, s.inertia);
  s.centre = s.centre + length.dt * velocity;
  if (driven) return;
  s.velocity = s.velocity + (1 / s.mass) * impulse;
  s.spin = spin_with(s, angular_momentum);
  keep_symmetry(s);
}

}  // namespace mpm::core
