// A free rigid body against bodies of prescribed motion: its impulses at all nodes where they meet, together.
//
// The body's motion q = (V, w) has the velocity u_i = B_i q - v_i relative to the other body at node i, n_i
// the normal from that one to it. Impulses P_i on it, with A q = A q0 + sum B_i^T P_i, are such that
//   u_i.n_i >= 0, P_i.n_i >= 0, and one of the two is 0       (it does not approach)
//   |P_t| <= mu P_n, against u_t where it slides              (Coulomb's cone)
// for the velocities u_i of the end of the step: no impulse then gains energy. A is the mass and inertia and,
// where deformable bodies touch it too, their resistance (rigid_motion.hpp). The motion without friction is
// unique (the least change of q0 in the norm of A), the impulses of many nodes are not. A few sweeps of
// Jacobi with mass splitting spread them evenly, then Gauss-Seidel in the order of the nodes ends at
// round-off (J. J. Moreau, CISM 302 (1988); M. Jean, CMAME 177 (1999) 235). Every rank solves the same list.
// Shown by tests/core/contact/rigid_contact_test.cpp and tests/system/physics_free_rigid.py.
#pragma once

#include <cstdint>
#include <span>

#include "core/contact/rigid_motion.hpp"

namespace mpm::core {

/// A node at which a free rigid body meets one of prescribed motion.
struct RigidContact {
  std::int64_t node = 0;              ///< number in the grid
  std::int32_t free = 0, driven = 0;  ///< numbers of the rigid bodies
  Vec3<double> place{};
  Vec3<double> normal{};    ///< unit vector from the driven body to the free one
  Vec3<double> velocity{};  ///< of the driven body there
  double friction = 0;      ///< Coulomb's coefficient
  Vec3<double> impulse{};   ///< result: on the free body

  /// The order in which they are solved: body by body.
  bool operator<(const RigidContact& other) const;
};

/// Sets the impulses of one body's contacts, and from the motion `q` without them that with them. False where
/// no motion is found that neither approaches nor gains energy: others close on the body from all sides.
bool resolve_rigid_contacts(const RigidState& s, const RigidResistance& resistance, RigidVelocity& q,
                            std::span<RigidContact> contacts);

}  // namespace mpm::core
