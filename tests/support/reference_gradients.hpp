// What USF makes of a particle's velocity gradient before it updates the stress. Part of
// reference_stepper.hpp.
#pragma once

#include <vector>

#include "tests/support/reference_material.hpp"

namespace mpm::tests {

/// X of (I - dt L) X = L by elimination. USF has L at the positions that its velocities led to, so that
/// I + dt X is the deformation from the old ones.
Matrix relative_to_old_positions(const Matrix& L, double dt);

struct KickedNode {
  double weight;
  Vector slope, velocity;
  double mass;
};

/// Adds to L, where a particle is trapped at a face of its cell, the gradient that a share of the kick of its
/// own traction gives the face: the equations of core/shape/face_traps.hpp.
void add_own_kick(const ReferenceParticle& particle, const std::vector<KickedNode>& nodes, const Vector& cell,
                  double dt, Matrix& L);

}  // namespace mpm::tests
