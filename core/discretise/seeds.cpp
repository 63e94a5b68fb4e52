#include "core/discretise/seeds.hpp"

#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "core/discretise/block.hpp"
#include "core/discretise/difference.hpp"
#include "core/discretise/lattice.hpp"
#include "core/discretise/points.hpp"
#include "core/discretise/revolved.hpp"
#include "core/discretise/shells.hpp"

namespace mpm::core {

namespace {

using Source = std::unique_ptr<SeedSource>;

/// Collects what is impossible about a body's geometry, under the input's names.
class Checks {
 public:
  explicit Checks(const BodyInput& body) : body_(body) {}

  void require(bool holds, std::string_view element, std::string_view attribute, double value,
               std::string_view what) {
    if (holds) return;
    errors_.add({body_.source.file, body_.source.line, std::string(element), std::string(attribute),
                 fmt::format("{}", value), fmt::format("body `{}`: expected {}", body_.name, what)});
  }
  void positive(std::string_view attribute, double value) {
    require(std::isfinite(value) && value > 0, "Geometry", attribute, value, "a number above 0");
  }
  /// Of particles: above 0, and so are the volume and the mass of one, which are numbers.
  void spacing(std::string_view attribute, double spacing) {
    positive(attribute, spacing);
    const double volume = spacing * spacing * spacing;
    if (!(spacing > 0)) return;  // said already
    require(
        std::isnormal(volume) && std::isnormal(volume * body_.density), "Geometry", attribute, spacing,
        "a distance of particles whose volume and mass are neither 0 nor beyond all numbers: choose other "
        "units");
  }
  void spacings(double bottom, double top) {
    spacing("dp_bottom", bottom);
    spacing("dp_top", top);
  }
  void angle(double value) {
    require(value > 0 && value <= 360, "Geometry", "angle", value, "0 < angle <= 360");
  }
  /// Radii of a wall; both may be zero where a cone ends in its tip.
  void wall(std::string_view inner_name, double inner, double outer) {
    require(std::isfinite(outer) && inner >= 0 && inner <= outer, "Geometry", inner_name, inner,
            "0 <= inner radius <= outer radius");
  }
  void raise_if_any() { errors_.raise_if_any(); }

 private:
  const BodyInput& body_;
  Complaints errors_;
};

void check(Checks& checks, const PointGeometry& points) {
  for (const PointMass& point : points.points)
    checks.require(std::isnormal(point.mass) && point.mass > 0, "Point", "mass", point.mass,
                   "a number above 0");
}

void check(Checks& checks, const BlockGeometry& block) {
  checks.spacing("dp", block.spacing);
  checks.positive("lx", block.size[0]);
  checks.positive("ly", block.size[1]);
  checks.positive("lz", block.size[2]);
}

void check(Checks& checks, const SphereGeometry& ball) {
  checks.spacing("dp", ball.spacing);
  checks.positive("Outer_Radius", ball.outer_radius);
  checks.require(ball.inner_radius >= 0 && ball.inner_radius < ball.outer_radius, "Geometry", "Inner_Radius",
                 ball.inner_radius, "0 <= Inner_Radius < Outer_Radius");
  checks.angle(ball.angle);
}

void check(Checks& checks, const CylinderGeometry& cylinder) {
  checks.spacings(cylinder.bottom_spacing, cylinder.top_spacing);
  checks.positive("height", cylinder.height);
  checks.wall("Bottom_Inner_Radius", cylinder.bottom_inner_radius, cylinder.bottom_outer_radius);
  checks.wall("Top_Inner_Radius", cylinder.top_inner_radius, cylinder.top_outer_radius);
  checks.require(cylinder.bottom_outer_radius > cylinder.bottom_inner_radius ||
                     cylinder.top_outer_radius > cylinder.top_inner_radius,
                 "Geometry", "Bottom_Outer_Radius", cylinder.bottom_outer_radius,
                 "an outer radius above the inner one at the bottom or at the top");
  checks.angle(cylinder.angle);
}

void check(Checks& checks, const OgiveGeometry& ogive) {
  checks.spacings(ogive.bottom_spacing, ogive.top_spacing);
  checks.positive("End_Radius", ogive.end_radius);
  checks.require(std::isfinite(ogive.ogive_radius) && ogive.ogive_radius >= ogive.end_radius, "Geometry",
                 "Ogive_Radius", ogive.ogive_radius, "Ogive_Radius >= End_Radius");
  checks.angle(ogive.angle);
}

template <class T>
void check(Checks&, const T&) {}

void check(const BodyInput& body) {
  Checks checks(body);
  if (!std::holds_alternative<BoolGeometry>(body.geometry))
    checks.require(std::isfinite(body.density) && body.density > 0, "Body", "density", body.density,
                   "a number above 0");
  std::visit([&](const auto& geometry) { check(checks, geometry); }, body.geometry);
  checks.raise_if_any();
}

/// Makes a source from the alternative that a body holds.
struct Maker {
  const Scene& scene;
  const BodyInput& body;
  Frame frame;

  Source operator()(const PointGeometry& g) const {
    if (!g.file.empty()) return std::make_unique<FilePoints>(g.file, body.source, frame, body.density);
    return std::make_unique<InlinePoints>(g.points, frame, body.density);
  }
  Source operator()(const BlockGeometry& g) const {
    return std::make_unique<BlockSource>(g, frame, body.density);
  }
  Source operator()(const SphereGeometry& g) const {
    if (g.layout == Layout::polar) return std::make_unique<ShellSource>(g, frame, body.density);
    return std::make_unique<BallLattice>(g, frame, body.density);
  }
  Source operator()(const CylinderGeometry& g) const { return turned(revolved(g), g.layout); }
  Source operator()(const OgiveGeometry& g) const { return turned(revolved(g), g.layout); }
  Source operator()(const BoolGeometry& g) const {
    BodyInput minuend = body_number(scene, g.minuend_body);
    minuend.density = body.density;
    return std::make_unique<DifferenceSource>(make_seed_source(scene, minuend),
                                              make_inside_test(scene, body_number(scene, g.subtrahend_body)),
                                              frame);
  }
  template <class Mesh>
  Source operator()(const Mesh&) const {
    throw InputErrors(body.source, "Body",
                      fmt::format("type \"{}\" is known but not implemented yet: body `{}` cannot be made of "
                                  "particles",
                                  body.type, body.name));
  }

 private:
  Source turned(const Revolved& solid, Layout layout) const {
    if (layout == Layout::polar) return std::make_unique<RingSource>(solid, frame, body.density);
    return std::make_unique<RevolvedLattice>(solid, frame, body.density);
  }
};

/// Whether a Bool body is, through its operands, made of itself.
bool endless(const Scene& scene, const BodyInput& body, int depth = 0) {
  constexpr int deepest = 64;
  const auto* difference = std::get_if<BoolGeometry>(&body.geometry);
  if (difference == nullptr) return false;
  return depth == deepest || endless(scene, body_number(scene, difference->minuend_body), depth + 1) ||
         endless(scene, body_number(scene, difference->subtrahend_body), depth + 1);
}

/// Of bodies small enough to try it.
bool is_empty(const SeedSource& source) {
  constexpr std::uint64_t few = 16;
  if (source.units() > few) return false;
  std::vector<Seed> seeds;
  source.generate(0, source.units(), seeds);
  return seeds.empty();
}

}  // namespace

std::unique_ptr<SeedSource> make_seed_source(const Scene& scene, const BodyInput& body) {
  check(body);
  if (endless(scene, body))
    throw InputErrors(body.source, "Body",
                      fmt::format("Bool body `{}` is made of itself, through its operands", body.name));
  Source source = std::visit(Maker{scene, body, Frame(scene, body)}, body.geometry);
  if (is_empty(*source))
    throw InputErrors(
        body.source, "Body",
        fmt::format("body `{}` has no particles: its shape is smaller than the particle spacing, or "
                    "nothing is left of it",
                    body.name));
  return source;
}

}  // namespace mpm::core
