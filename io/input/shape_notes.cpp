#include "io/input/shape_notes.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include <fmt/format.h>

#include "core/contact/component_contact.hpp"
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

namespace {

/// The largest distance of neighbouring particles; 0 where the geometry does not say it.
double largest_spacing(const core::Geometry& geometry) {
  return std::visit(
      [](const auto& of) {
        if constexpr (requires { of.spacing; })
          return of.spacing;
        else if constexpr (requires { of.top_spacing; })
          return std::max(of.bottom_spacing, of.top_spacing);
        else
          return 0.0;
      },
      geometry);
}

/// Of a body's particles; of a difference, those of what it is taken from.
double largest_spacing(const core::Scene& scene, const core::BodyInput& body) {
  const core::BodyInput* shape = &body;
  while (const auto* difference = std::get_if<core::BoolGeometry>(&shape->geometry))
    shape = &core::body_at(scene, difference->minuend);
  return largest_spacing(shape->geometry);
}

constexpr double wide = 1 + 1e-9;  // cells

}  // namespace

void note_wide_spacings(const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const double cell = scene.grid.smallest_cell();
  core::for_each_active_body(scene, [&](int, const core::BodyInput& body) {
    const double spacing = largest_spacing(scene, body);
    if (!(spacing > wide * cell)) return;
    notes.push_back(
        {body.source.file,
         body.source.line,
         "Body",
         {},
         {},
         fmt::format("body '{}': its particles are {:.6g} apart, more than a cell, {:.6g}: neighbours "
                     "then share few nodes or none, and the body has little strength or none. Use a dp "
                     "of about half a cell",
                     body.name, spacing, cell)});
  });
}

const core::BodyInput* body_of_single_particles(const core::Scene& scene) {
  using enum core::ShapeFunction;
  if (scene.grid.shape != linear && scene.grid.shape != ddmp) return nullptr;
  const double cell = scene.grid.smallest_cell();
  constexpr double single = 0.95;  // cells
  const core::BodyInput* first = nullptr;
  core::for_each_active_body(scene, [&](int, const core::BodyInput& body) {
    const double spacing = largest_spacing(scene, body);
    if (first == nullptr && spacing > single * cell && !(spacing > wide * cell) &&
        !core::is_rigid(scene.materials[body.material]))
      first = &body;
  });
  return first;
}

void note_single_particles(const core::Scene& scene, std::vector<core::Diagnostic>& notes) {
  const core::SolutionInput& solution = scene.solution;
  const bool begins_with_usavg = solution.automatic_scheme && solution.scheme == core::Scheme::usavg;
  if (solution.integration != core::Integration::explicit_dynamics ||
      (solution.scheme != core::Scheme::musl && !begins_with_usavg))
    return;
  const core::BodyInput* body = body_of_single_particles(scene);
  if (body == nullptr) return;
  notes.push_back(
      {body->source.file,
       body->source.line,
       "Body",
       {},
       {},
       fmt::format(
           "body '{}' has one particle in a cell: with these shape functions its energy may "
           "grow where they cross cells, with MUSL most{} (docs/stability.md). {}se a dp of about half "
           "a cell, or other shape functions{}",
           body->name, solution.transfer == core::Transfer::flip ? ", and FLIP takes shorter steps" : "",
           begins_with_usavg ? "The run begins with USAVG. U" : "U",
           begins_with_usavg ? "" : ", or algorithm=\"USAVG\"")});
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
