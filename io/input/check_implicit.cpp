// Refuses what implicit steps cannot do, with the lines of the input. Materials are checked with their laws
// (core/setup/prepare_model.cpp).

#include <algorithm>

#include <fmt/format.h>

#include "io/input/build.hpp"

namespace mpm::io {

namespace {

void check_settings(const Node& solution, const core::SolutionInput& input, const BuildContext& context) {
  const auto refuse = [&](std::string_view child, std::string_view attribute, std::string why) {
    if (const auto node = solution.child(child)) node->report(context.diagnostics, attribute, std::move(why));
  };
  if (input.scheme != core::Scheme::musl)
    solution.report(context.diagnostics, "algorithm",
                    "is not available with implicit steps, whose stress is that at the end of the step: "
                    "remove it, or use explicit steps (remove Integration)");
  if (input.transfer != core::Transfer::flip || input.flip_fraction != 1)
    solution.report(context.diagnostics, "transfer",
                    "implicit steps take FLIP alone: their displacements follow from "
                    "the nodes, and only velocity increments return to the particles");
  if (input.limit_velocity) refuse("LimitVelocity", "max", "is not available with implicit steps; remove it");
  if (input.volume.erode || input.volume.min || input.volume.max)
    refuse("Volume", {},
           "erode, min and max are not available with implicit steps: a step that would invert a "
           "particle is shortened instead");
  if (input.volume.update != core::VolumeUpdate::rate)
    refuse("Volume", "update_type",
           "implicit steps take the volume from the deformation gradient; remove it");
}

void check_faces(const Node& root, const core::GridInput& grid, const BuildContext& context) {
  const bool any = grid.has_face(core::Boundary::nonreflecting) || grid.has_face(core::Boundary::rigid_wall);
  const auto node = root.child("Grid");
  if (any && node)
    node->report(
        context.diagnostics,
        "non-reflecting faces and rigid walls are not available with implicit steps: use 0 (free), 1 "
        "(fixed) or 2 (symmetry)");
}

/// A particle that is deleted takes its forces out of a step that has been solved with them.
void check_erosion(const Node& root, const core::Scene& scene, const BuildContext& context) {
  const std::vector<Node> materials = root.children("Material");
  for (std::size_t m = 0; m < std::min(materials.size(), scene.materials.size()); ++m) {
    const bool used = std::ranges::any_of(scene.components, [&](const core::ComponentInput& component) {
      return std::ranges::any_of(component.bodies, [&](const core::BodyInput& b) { return b.material == m; });
    });
    if (!used) continue;
    const auto refuse = [&](const Node& node, std::string_view attribute) {
      node.report(context.diagnostics, attribute,
                  "particles are not deleted in implicit steps: set it to 0, or remove Solution@Integration");
    };
    for (const Node& failure : materials[m].children("FailureModel"))
      if (failure.boolean("Erosion")) refuse(failure, "Erosion");
    const auto strength = materials[m].child("StrengthModel");
    for (const char* attribute : {"ErosionByDamage", "ErosionByPressure"})
      if (strength && scene.materials[m].strength.value_or(attribute, 0) != 0) refuse(*strength, attribute);
  }
}

/// core/implicit/implicit_contact.hpp.
void check_implicit_contact(const Node& root, const core::Scene& scene, const BuildContext& context) {
  const auto contact = root.child("Contact");
  if (!contact) return;
  const auto refuse = [&](std::string_view attribute, std::string why) {
    contact->report(context.diagnostics, attribute, std::move(why));
  };
  const core::ContactInput& input = scene.contact;
  if (scene.solution.implicit && scene.solution.implicit->linearised())
    refuse("enable",
           "is not available with semi-implicit steps: use type dynamic or quasistatic, or set it to 0");
  if (input.distance != core::ContactInput::Distance::shared_node)
    refuse("distance_type", "must be 0 with implicit steps, which find contact at nodes that both reach");
  if (input.normal == core::ContactInput::Normal::regression)
    refuse("contact_normal",
           "regression is not available with implicit steps, whose normals are those of rigid bodies and "
           "gradients of "
           "volume; remove it");
  if (input.limits_time_step)
    refuse("contact_time_step", "must be 0 with implicit steps, whose length Newton's method decides");
  if (input.failed_to_component)
    refuse("failure_to_component", "must be 0 with implicit steps: failed particles keep their component");
}

}  // namespace

void check_implicit(const Node& root, const core::Scene& scene, const BuildContext& context) {
  const std::optional<Node> solution = root.child("Solution");
  if (!solution || scene.solution.integration != core::Integration::implicit) return;
  check_settings(*solution, scene.solution, context);
  check_faces(root, scene.grid, context);
  check_erosion(root, scene, context);
  if (scene.contact.enable) check_implicit_contact(root, scene, context);
}

}  // namespace mpm::io
