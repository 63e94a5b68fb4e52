#include "core/contact/component_contact.hpp"

#include <limits>

namespace mpm::core {

namespace {

/// Automatic weight of the normals of a material (manual 3.9): the stiffer body decides.
double stiffness(const MaterialInput& material) {
  constexpr double unknown = -32767;
  if (material.strength.type == "MooneyRivlin") return std::numeric_limits<double>::infinity();
  return material.strength.value_or("Young", unknown);
}

}  // namespace

bool has_reaction(const Scene& scene, const BodyInput& body) {
  return body.prescribed_velocity || body.constrain_rigid_position ||
         (scene.contact.enable && is_rigid(scene.materials[body.material]));
}

double normal_weight(const Scene& scene, std::size_t component, std::size_t material) {
  return scene.contact.automatic_weights ? stiffness(scene.materials[material])
                                         : scene.components[component].normal_weight;
}

Friction friction_of(const Scene& scene, std::size_t material, std::size_t other) {
  for (const FrictionPair& pair : scene.frictions)
    if ((pair.first_material == material && pair.second_material == other) ||
        (pair.first_material == other && pair.second_material == material))
      return pair.friction;
  return {};
}

}  // namespace mpm::core
