// Rejects surface loads that the particles cannot resolve (core/step/loads.hpp).

#include <algorithm>
#include <variant>

#include <fmt/format.h>

#include "io/input/build.hpp"

namespace mpm::io {

namespace {

/// The body whose particles a Bool body keeps; null where names or operands are wrong, which is reported.
const core::BodyInput* source_of(const core::Scene& scene, const core::BodyInput* body) {
  constexpr int deepest = 64;
  for (int depth = 0; depth < deepest; ++depth) {
    const auto* difference = std::get_if<core::BoolGeometry>(&body->geometry);
    if (difference == nullptr) return body;
    const auto [c, b] = difference->minuend;
    if (c >= scene.components.size() || b >= scene.components[c].bodies.size()) return nullptr;
    body = &scene.components[c].bodies[b];
  }
  return nullptr;
}

/// The largest distance of neighbouring particles that the input gives; 0 where it gives none.
double spacing_of(const core::BodyInput& body) {
  if (const auto* block = std::get_if<core::BlockGeometry>(&body.geometry)) return block->spacing;
  if (const auto* sphere = std::get_if<core::SphereGeometry>(&body.geometry)) return sphere->spacing;
  if (const auto* cylinder = std::get_if<core::CylinderGeometry>(&body.geometry))
    return std::max(cylinder->bottom_spacing, cylinder->top_spacing);
  if (const auto* ogive = std::get_if<core::OgiveGeometry>(&body.geometry))
    return std::max(ogive->bottom_spacing, ogive->top_spacing);
  return 0;
}

bool has_box(const Node& load) {
  constexpr const char* faces[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  return std::ranges::any_of(faces, [&](const char* face) { return load.given_real(face).has_value(); });
}

}  // namespace

void check_loads(const Node& root, const core::Scene& scene, const BuildContext& context) {
  const std::vector<Node> components = root.children("Component");
  for (std::size_t c = 0; c < std::min(components.size(), scene.components.size()); ++c) {
    const std::vector<Node> bodies = components[c].children("Body");
    for (std::size_t b = 0; b < std::min(bodies.size(), scene.components[c].bodies.size()); ++b) {
      const core::BodyInput* source = source_of(scene, &scene.components[c].bodies[b]);
      const double spacing = source == nullptr ? 0 : spacing_of(*source);
      for (const Node& load : bodies[b].children("Traction")) {
        const std::optional<double> ramp = load.given_real("ramp");
        constexpr double rounding = 1e-9;
        if (!ramp || !(*ramp > 0) || !has_box(load) || !(*ramp < (1 - rounding) * spacing)) continue;
        load.report(context.diagnostics, "ramp",
                    fmt::format("less than the distance {:.6g} of the body's particles: none of their layers "
                                "would be on the ramp, or too many for its width, and the load would be zero "
                                "or several times too large; expected at least {:.6g}, best twice that with "
                                "the box's faces midway between layers",
                                spacing, spacing));
      }
    }
  }
}

}  // namespace mpm::io
