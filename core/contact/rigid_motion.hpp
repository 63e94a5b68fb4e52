// The motion of free rigid bodies at the end of a step, found together with the impulses of contact on them:
// six unknowns q = (V, w) per body, velocity of the centre and spin. At a node x the body has the velocity B
// q = V + w x (x - c); a field that touches it there is brought to that velocity along the normal, and across
// as friction allows (node_contact.hpp, with a rigid body of infinite mass), by an impulse P(q) on the body:
//
//   M q = M q0 + sum over nodes of B^T P(q)          M: mass and inertia, q0: without contact
//
// Newton's method, D = -dP/du for the velocity u of the body at a node:
//
//   (M + sum B^T D B) (q' - q) = M (q0 - q) + sum B^T P(q)
//
// Without friction P is the gradient of a convex function, piecewise linear: a few trials find the nodes that
// press, and q with them. Friction, mu times what presses, makes D unsymmetric. The lighter the body is
// beside the nodes' masses, the more often a whole step passes from nodes that stick to nodes that slide and
// back: it is halved while the residual does not fall, in the norm of M^-1, down to a sixteenth. A body that
// meets bodies of prescribed motion, too, takes the symmetric secants P/u in the place of D, which their
// impulses need (rigid_contact.hpp), and whole steps. A heavy body needs 4 trials, one of a hundredth of the
// nodes' mass 10 on average (tests/core/contact/rigid_motion_test.cpp). Sums over nodes are exact, so that q
// has the same bits on any ranks and threads.
#pragma once

#include <array>
#include <limits>
#include <span>

#include "core/contact/rigid_state.hpp"
#include "core/exact_sum.hpp"

namespace mpm::core {

struct RigidVelocity {
  Vec3<double> velocity{}, spin{};

  Vec3<double> at(const Vec3<double>& arm) const { return velocity + cross(spin, arm); }
};
inline RigidVelocity operator+(const RigidVelocity& a, const RigidVelocity& b) {
  return {a.velocity + b.velocity, a.spin + b.spin};
}
inline RigidVelocity operator*(double factor, const RigidVelocity& q) {
  return {factor * q.velocity, factor * q.spin};
}

/// The nodes' answer to a trial motion of a body, by thread.
struct RigidResponse {
  static constexpr int size = 6 + 36;
  ExactSum sums[size];  ///< B^T P, then B^T D B, row by row

  /// The impulse `p` on the body at the end of `arm`, which falls by `change` times what the velocity there
  /// grows by: D, or another matrix in its place.
  void add(const Vec3<double>& p, const Vec3<double>& arm, const Mat3<double>& change);
};

/// A motion of a body, velocity and then spin, or an impulse and its moment.
using Six = std::array<double, 6>;

/// M + sum B^T D B of a body, where symmetry planes let it move: an impulse's answer is the change of motion.
class RigidResistance {
 public:
  /// `response`: the values of the sums.
  RigidResistance(const RigidState& s, std::span<const double> response);
  /// x with A x = b.
  Six answer(const Six& b) const;

 private:
  std::array<double, 36> inverse_;  ///< row by row
  std::array<bool, 6> fixed_;
};

/// The next trial, q'. `free`: q0; `response`: the values of the sums.
RigidVelocity next_trial(const RigidState& s, const RigidVelocity& free, const RigidVelocity& trial,
                         std::span<const double> response);

/// Whether two motions of a body are the same but for a small part of its speed, with contact or without.
bool same_motion(const RigidState& s, const RigidVelocity& a, const RigidVelocity& b);

/// Newton's method for a body, with steps that are halved where they do not help.
class RigidSearch {
 public:
  /// `free`: q0.
  explicit RigidSearch(const RigidVelocity& free) : free_(free), from_(free), trial_(free) {}
  const RigidVelocity& free() const { return free_; }
  const RigidVelocity& trial() const { return trial_; }
  /// Whether trial() is the motion.
  bool found() const { return found_; }
  /// The next trial. `response`: the values of the sums at trial().
  void next(const RigidState& s, std::span<const double> response);

 private:
  RigidVelocity free_, from_, step_, trial_;
  double part_ = 1;                                            ///< of the step
  double residual_ = std::numeric_limits<double>::infinity();  ///< at `from_`: squared norm
  bool found_ = false;
};

}  // namespace mpm::core
