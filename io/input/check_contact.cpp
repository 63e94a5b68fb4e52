// Refuses what contact cannot do, with the lines of the input.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/contact/component_contact.hpp"
#include "io/input/build.hpp"

namespace mpm::io {

namespace {

using Bodies = std::vector<const core::BodyInput*>;

/// The active bodies of each component.
std::vector<Bodies> bodies_by_component(const core::Scene& scene) {
  std::vector<Bodies> bodies(scene.components.size());
  core::for_each_active_body(scene, [&](int component, const core::BodyInput& body) {
    bodies[static_cast<std::size_t>(component)].push_back(&body);
  });
  return bodies;
}

std::vector<std::size_t> materials_of(const Bodies& bodies) {
  std::vector<std::size_t> materials;
  for (const core::BodyInput* body : bodies) {
    if (std::ranges::find(materials, body->material) == materials.end()) materials.push_back(body->material);
  }
  return materials;
}

/// The surface of a component has one friction against each other component.
void check_friction(const Node& node, std::size_t c, const std::vector<Bodies>& bodies,
                    const core::Scene& scene, const BuildContext& context) {
  const std::vector<std::size_t> mine = materials_of(bodies[c]);
  for (std::size_t other = 0; other < bodies.size(); ++other) {
    if (other == c) continue;
    for (const std::size_t theirs : materials_of(bodies[other])) {
      for (const std::size_t material : mine) {
        if (material >= scene.materials.size() || theirs >= scene.materials.size()) return;
        const core::Friction friction = core::friction_of(scene, material, theirs),
                             of_first = core::friction_of(scene, mine.front(), theirs);
        // Not-a-number: a wrong value, which has been reported.
        if (friction == of_first || std::isnan(friction.coefficient) || std::isnan(of_first.coefficient))
          continue;
        return node.report(
            context.diagnostics,
            fmt::format("its materials '{}' and '{}' have different friction against '{}': contact has one "
                        "coefficient for a pair of components. Give the bodies components of their own",
                        scene.materials[mine.front()].name, scene.materials[material].name,
                        scene.materials[theirs].name));
      }
    }
  }
}

void check_rigid(const Node& node, const Bodies& bodies, const core::Scene& scene,
                 const BuildContext& context) {
  std::size_t known = 0, rigid = 0;
  for (const core::BodyInput* body : bodies) {
    if (body->material >= scene.materials.size()) continue;
    ++known;
    if (core::is_rigid(scene.materials[body->material])) ++rigid;
  }
  if (rigid > 0 && known > 1)
    node.report(
        context.diagnostics,
        "a rigid body in contact must be alone in its component, which moves as one: give the other "
        "bodies components of their own. One rigid body of several shapes, as a shank with a nose, is a "
        "Bool body: A minus ((A minus the first shape) minus the second), A being a block around both");
}

}  // namespace

void check_contact(const Node& root, const core::Scene& scene, const BuildContext& context) {
  const std::optional<Node> contact = root.child("Contact");
  if (!contact || !scene.contact.enable) return;
  const std::vector<Bodies> bodies = bodies_by_component(scene);
  const auto present = std::ranges::count_if(bodies, [](const Bodies& of) { return !of.empty(); });
  if (present < 2)
    contact->report(
        context.diagnostics, "enable",
        "contact acts between components, and there is only one with bodies: give bodies that are "
        "to meet components of their own, or set enable to 0");
  const std::vector<Node> components = root.children("Component");
  for (std::size_t c = 0; c < std::min(components.size(), scene.components.size()); ++c) {
    check_friction(components[c], c, bodies, scene, context);
    check_rigid(components[c], bodies[c], scene, context);
  }
}

}  // namespace mpm::io
