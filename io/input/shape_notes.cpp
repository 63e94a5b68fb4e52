#include "io/input/shape_notes.hpp"

#include <cmath>
#include <variant>

#include <fmt/format.h>

#include "core/discretise/line.hpp"

namespace mpm::io {

namespace {

constexpr double notable = 0.01;  // of the volume

/// The edges of the box that the particles fill.
core::Vec3<double> filled(const core::BlockGeometry& block) {
  core::Vec3<double> edges;
  for (int a = 0; a < 3; ++a) edges[a] = core::whole_count(block.size[a], block.spacing) * block.spacing;
  return edges;
}

double volume(const core::Vec3<double>& edges) { return edges.x * edges.y * edges.z; }

}  // namespace

void note_blocks(const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const core::BodyInput* first = nullptr;
  int more = 0;
  core::for_each_active_body(scene, [&](int, const core::BodyInput& body) {
    const auto* block = std::get_if<core::BlockGeometry>(&body.geometry);
    if (block == nullptr || std::abs(volume(filled(*block)) / volume(block->size) - 1) <= notable) return;
    if (first == nullptr)
      first = &body;
    else
      ++more;
  });
  if (first == nullptr) return;
  const auto& block = std::get<core::BlockGeometry>(first->geometry);
  const core::Vec3<double> edges = filled(block);
  notes.push_back(
      {first->source.file,
       first->source.line,
       "Body",
       {},
       {},
       fmt::format("body '{}': dp {:.6g} does not divide its edges {:.6g} x {:.6g} x {:.6g}: its "
                   "particles fill {:.6g} x {:.6g} x {:.6g}, with the mass {:.6g} instead of "
                   "{:.6g}{}",
                   first->name, block.spacing, block.size.x, block.size.y, block.size.z, edges.x, edges.y,
                   edges.z, first->density * volume(edges), first->density * volume(block.size),
                   more > 0 ? fmt::format(" (and {} more such bodies)", more) : "")});
}

void note_no_bodies(const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  if (!core::active_bodies(scene).empty()) return;
  const core::SourceLocation& at = scene.components.front().source;
  notes.push_back({at.file,
                   at.line,
                   "Component",
                   {},
                   {},
                   "the run has no particles: every body has Deactive=\"1\", or is an operand of Bool bodies "
                   "(ForBoolBody)"});
}

}  // namespace mpm::io
