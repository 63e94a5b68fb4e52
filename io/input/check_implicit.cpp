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
  const auto unsuitable = [](core::Boundary b) {
    return b == core::Boundary::nonreflecting || b == core::Boundary::rigid_wall;
  };
  const bool any = std::ranges::any_of(grid.axes, [&](const core::GridAxis& axis) {
    return unsuitable(axis.lower) || unsuitable(axis.upper);
  });
  const auto node = root.child("Grid");
  if (any && node)
    node->report(
        context.diagnostics,
        "non-reflecting faces and rigid walls are not available with implicit steps: use 0 (free), 1 "
        "(fixed) or 2 (symmetry)");
}

}  // namespace

void check_implicit(const Node& root, const core::Scene& scene, const BuildContext& context) {
  const std::optional<Node> solution = root.child("Solution");
  if (!solution || scene.solution.integration != core::Integration::implicit) return;
  check_settings(*solution, scene.solution, context);
  check_faces(root, scene.grid, context);
  if (scene.contact.enable)
    if (const auto contact = root.child("Contact"))
      contact->report(context.diagnostics, "enable",
                      "is not available with implicit steps: bodies stick to each other; set it to 0");
}

}  // namespace mpm::io
