// What the input says about the contact of components and materials, where the run and the checks of the
// input both need it.
#pragma once

#include <cstddef>

#include "core/scene/scene.hpp"

namespace mpm::core {

inline bool is_rigid(const MaterialInput& material) { return material.strength.type == "Rigid"; }

/// Whether the motion of a rigid body is given: others have no influence on it.
inline bool is_driven(const BodyInput& body) {
  return body.constrain_rigid_position || body.prescribed_velocity.has_value();
}

/// Whether the reaction of a body is recorded: it is rigid and in contact, or its velocity is prescribed.
bool has_reaction(const Scene& scene, const BodyInput& body);

/// Weight of the normals of a component of this material, which is not rigid: as given or, with
/// auto_normal_vector_weight, by stiffness.
double normal_weight(const Scene& scene, std::size_t component, std::size_t material);

/// Of two materials; none where the input gives none.
Friction friction_of(const Scene& scene, std::size_t material, std::size_t other);

}  // namespace mpm::core
