// The motion of free rigid bodies at the end of a step, found together with the impulses of contact on them:
// six unknowns q = (V, w) per body, velocity of the centre and spin. At a node x the body has the velocity B
// q = V + w x (x - c); a field that touches it there is brought to that velocity along the normal, and across
// as friction allows (node_contact.hpp, with a rigid body of infinite mass), by an impulse P(q) on the body:
//
//   M q = M q0 + sum over nodes of B^T P(q)          M: mass and inertia, q0: without contact
//
// Newton's method with secants, k_n and k_t the impulse over the approach along and across the normal:
//
//   (M + sum B^T k B) (q' - q) = M (q0 - q) + sum B^T P(q)
//
// Without friction P is the gradient of a convex function, piecewise linear: a few trials find the nodes that
// press, and q with them. Sums over nodes are exact, so that q has the same bits on any ranks and threads.
#pragma once

#include <array>
#include <span>

#include "core/contact/rigid_state.hpp"
#include "core/exact_sum.hpp"

namespace mpm::core {

struct RigidVelocity {
  Vec3<double> velocity{}, spin{};

  Vec3<double> at(const Vec3<double>& arm) const { return velocity + cross(spin, arm); }
};

/// The nodes' answer to a trial motion of a body, by thread.
struct RigidResponse {
  static constexpr int size = 6 + 21;
  ExactSum sums[size];  ///< B^T P, then the lower triangle of B^T k B, row by row

  /// The impulse `p` on the body at the end of `arm`, which follows its approach by `along` the normal and
  /// `across` it.
  void add(const Vec3<double>& p, const Vec3<double>& arm, const Vec3<double>& normal, double along,
           double across);
};

/// A motion of a body, velocity and then spin, or an impulse and its moment.
using Six = std::array<double, 6>;

/// M + sum B^T k B of a body, where symmetry planes let it move: an impulse's answer is the change of motion.
class RigidResistance {
 public:
  /// `response`: the values of the sums.
  RigidResistance(const RigidState& s, std::span<const double> response);
  /// x with A x = b.
  Six answer(Six b) const;

 private:
  std::array<double, 21> factor_;  ///< L D L^T in place of the lower triangle
  std::array<bool, 6> fixed_;
};

/// The next trial, q'. `free`: q0; `response`: the values of the sums.
RigidVelocity next_trial(const RigidState& s, const RigidVelocity& free, const RigidVelocity& trial,
                         std::span<const double> response);

/// Whether two motions of a body are the same but for a small part of its speed.
bool same_motion(const RigidState& s, const RigidVelocity& a, const RigidVelocity& b);

}  // namespace mpm::core
