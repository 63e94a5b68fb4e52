#include "core/discretise/shape_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <type_traits>
#include <variant>

#include <fmt/format.h>

#include "core/discretise/block.hpp"
#include "core/discretise/make_source.hpp"
#include "core/discretise/parts.hpp"
#include "core/discretise/solid_box.hpp"

namespace mpm::core {

namespace {

/// More particles than any machine can store: such a number indicates a wrong spacing.
constexpr double most_particles = 0x1p48;
/// Arc over base of an ogive: above it round-off dominates its outline and volumes.
constexpr double most_slender = 1000;

/// Checks the values of one body, each alternative of Geometry by its own function.
class NumberCheck {
 public:
  explicit NumberCheck(const BodyInput& body) : body_(body) {
    dense_ = std::isfinite(body.density) && body.density > 0;
    if (!dense_) report({"Body", 0, "density", as_text(body.density), "expected a number greater than 0"});
    std::visit([this](const auto& geometry) { check(geometry); }, body.geometry);
  }

  std::vector<ShapeFault> take() { return std::move(faults_); }

 private:
  static std::string as_text(double value) { return fmt::format("{}", value); }
  void report(ShapeFault fault) { faults_.push_back(std::move(fault)); }
  void report(std::string_view attribute, double value, std::string message) {
    report({"Geometry", 0, std::string(attribute), as_text(value), std::move(message)});
  }

  void positive(std::string_view attribute, double value) {
    if (!(std::isfinite(value) && value > 0)) report(attribute, value, "expected a number greater than 0");
  }
  void not_negative(std::string_view attribute, double value) {
    if (!(std::isfinite(value) && value >= 0)) report(attribute, value, "expected a number of at least 0");
  }
  void place(const Vec3<double>& position) {
    static constexpr std::array names{"x0", "y0", "z0"};
    for (std::size_t d = 0; d < 3; ++d)
      if (!std::isfinite(position[d])) report(names[d], position[d], "expected a number");
  }
  void angle(double value) {
    if (!(value > 0 && value <= 360)) report("angle", value, "expected a number in (0, 360]");
  }
  /// The particle spacing: volume and mass of a particle must be finite and not 0.
  void spacing(std::string_view attribute, double value) {
    positive(attribute, value);
    if (!(value > 0)) return;
    const double volume = value * value * value;
    if (!std::isnormal(volume) || (dense_ && !std::isnormal(volume * body_.density)))
      report(attribute, value,
             "the volume or the mass of a particle with this spacing is outside the range of double "
             "precision: choose other units");
  }
  /// A wall between two radii. Both may be 0 where a cone ends in its tip.
  void wall(std::string_view inner_name, double inner, std::string_view outer_name, double outer, bool tip) {
    if (inner >= outer && outer >= 0 && !(tip && outer == 0 && inner == 0))
      report(outer_name, outer, fmt::format("expected more than {}, {}", inner_name, inner));
  }
  /// Children of Geometry or a file: one of the two.
  void one_source(bool has_children, const std::string& file, std::string_view children) {
    if (has_children && !file.empty())
      report({"Geometry", 0, "file", file,
              fmt::format("{} are also given in the input; expected only one of the two", children)});
    if (!has_children && file.empty())
      report({"Geometry", 0, {}, {}, fmt::format("expected {}, or file=\"...\"", children)});
  }

  void check(const PointGeometry& points) {
    one_source(!points.points.empty(), points.file, "<Point> elements");
    for (std::size_t i = 0; i < points.points.size(); ++i) {
      const double mass = points.points[i].mass;
      if (!(std::isnormal(mass) && mass > 0))
        report({"Point", i, "mass", as_text(mass), "expected a number greater than 0"});
      for (std::size_t d = 0; d < 3; ++d)
        if (const double x = points.points[i].position[d]; !std::isfinite(x))
          report({"Point", i, std::string(1, "xyz"[d]), as_text(x), "expected a number"});
    }
  }
  void check(const BlockGeometry& block) {
    spacing("dp", block.spacing);
    place(block.origin);
    positive("lx", block.size[0]);
    positive("ly", block.size[1]);
    positive("lz", block.size[2]);
  }
  void check(const HexahedronBlockGeometry& block) { check(static_cast<const BlockGeometry&>(block)); }
  void check(const SphereGeometry& ball) {
    spacing("dp", ball.spacing);
    place(ball.centre);
    positive("Outer_Radius", ball.outer_radius);
    not_negative("Inner_Radius", ball.inner_radius);
    if (ball.outer_radius > 0)
      wall("Inner_Radius", ball.inner_radius, "Outer_Radius", ball.outer_radius, false);
    angle(ball.angle);
    if (ball.upper_half && std::isfinite(ball.angle) && ball.angle != 90)
      report("half", 1, fmt::format("requires angle=\"90\", not {}", ball.angle));
  }
  void check(const CylinderGeometry& c) {
    spacing("dp_bottom", c.bottom_spacing);
    spacing("dp_top", c.top_spacing);
    place(c.base_centre);
    positive("height", c.height);
    not_negative("Bottom_Inner_Radius", c.bottom_inner_radius);
    not_negative("Bottom_Outer_Radius", c.bottom_outer_radius);
    not_negative("Top_Inner_Radius", c.top_inner_radius);
    not_negative("Top_Outer_Radius", c.top_outer_radius);
    wall("Bottom_Inner_Radius", c.bottom_inner_radius, "Bottom_Outer_Radius", c.bottom_outer_radius,
         c.top_outer_radius > 0);
    wall("Top_Inner_Radius", c.top_inner_radius, "Top_Outer_Radius", c.top_outer_radius,
         c.bottom_outer_radius > 0);
    angle(c.angle);
  }
  void check(const OgiveGeometry& ogive) {
    spacing("dp_bottom", ogive.bottom_spacing);
    spacing("dp_top", ogive.top_spacing);
    place(ogive.base_centre);
    positive("End_Radius", ogive.end_radius);
    positive("Ogive_Radius", ogive.ogive_radius);
    if (ogive.ogive_radius > 0 && ogive.ogive_radius < ogive.end_radius)
      report("Ogive_Radius", ogive.ogive_radius,
             fmt::format("expected at least End_Radius, {}: the arc starts at the rim of the base, in the "
                         "direction of the axis; an arc of smaller radius does not reach the axis",
                         ogive.end_radius));
    if (ogive.end_radius > 0 && ogive.ogive_radius > most_slender * ogive.end_radius)
      report("Ogive_Radius", ogive.ogive_radius,
             fmt::format("expected at most {} times End_Radius, {}; a Cylinder with Top_Outer_Radius=\"0\" "
                         "gives a longer tip",
                         most_slender, ogive.end_radius));
    angle(ogive.angle);
  }
  template <std::size_t N>
  void check(const MeshGeometry<N>& mesh) {
    one_source(!mesh.nodes.empty() || !mesh.elements.empty(), mesh.file, "<Point> and <Element> elements");
    std::set<std::int64_t> ids;
    for (const auto& node : mesh.nodes) ids.insert(node.id);
    constexpr std::size_t first_id = N == 8 ? 1 : 0;  // hexahedra count their corners from 1
    for (std::size_t e = 0; e < mesh.elements.size(); ++e)
      for (std::size_t i = 0; i < N; ++i)
        if (const std::int64_t id = mesh.elements[e].nodes[i]; id > 0 && !ids.contains(id))
          report({"Element", e, fmt::format("id{}", i + first_id), fmt::format("{}", id),
                  "no node has this number"});
  }
  void check(const BarLinesGeometry& bars) {
    if (bars.extend_direction >= 0 && bars.extend_direction == bars.expand_direction)
      report("expand_direction", bars.expand_direction, "expected another axis than extend_direction");
  }
  template <class Geometry>
  void check(const Geometry&) {
  }  // no checks beyond the ranges of the attributes; Bool is checked by its operands

  const BodyInput& body_;
  bool dense_ = false;
  std::vector<ShapeFault> faults_;
};

constexpr std::array operand_types{"Point", "Block", "Sphere", "Cylinder", "Ogive", "Bool"};

bool made_of_particles(const Geometry& g) {
  return std::holds_alternative<PointGeometry>(g) || std::holds_alternative<BlockGeometry>(g) ||
         std::holds_alternative<SphereGeometry>(g) || std::holds_alternative<CylinderGeometry>(g) ||
         std::holds_alternative<OgiveGeometry>(g) || std::holds_alternative<BoolGeometry>(g);
}

bool placed(const Scene& scene, const BodyInput& body) {
  if (!body.work_plane) return true;
  const WorkPlane& plane = scene.work_planes.at(*body.work_plane);
  return std::ranges::all_of(std::array{plane.origin, plane.x_axis, plane.y_axis, plane.z_axis},
                             [](const Vec3<double>& v) {
                               return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
                             });
}

/// Checks the operands of a Bool body by their types.
void check_operands(const Scene& scene, const BoolGeometry& difference, const Parts& parts,
                    std::vector<ShapeFault>& faults) {
  const auto check = [&](const char* attribute, BodyPlace place) {
    if (place.component == BodyPlace{}.component)
      return;  // the reader has reported that no body has this name
    const BodyInput& other = body_at(scene, place);
    const auto report = [&](std::string message) {
      faults.push_back({"Body", 0, attribute, other.name, std::move(message)});
    };
    if (!made_of_particles(other.geometry))
      report(fmt::format("a body of type {} cannot be an operand; expected one of {}", other.type,
                         fmt::join(operand_types, ", ")));
    else if (!other.for_bool)
      report(fmt::format("body '{}', on line {}, requires ForBoolBody=\"1\"", other.name, other.source.line));
    if (!parts.circle().empty() &&
        parts.circle_by_subtrahend() == (attribute == std::string_view("BoolBodyB")))
      report(fmt::format("the body is an operand of itself: {}; expected operands that do not contain it",
                         fmt::join(parts.circle(), " -> ")));
  };
  check("BoolBodyA", difference.minuend);
  check("BoolBodyB", difference.subtrahend);
  if (parts.too_many())
    faults.push_back({"Body", 0, "BoolBodyA", body_at(scene, difference.minuend).name,
                      fmt::format("the body consists of more than {} shapes, including those of its "
                                  "operands, each counted as often as it is used; expected fewer",
                                  Parts::most_shapes)});
}

/// Rejects a body that is entirely outside the grid.
void check_inside(const Scene& scene, const BodyInput& body, std::vector<ShapeFault>& faults) {
  const SolidBox box = solid_box(scene, body);
  for (std::size_t i = 0; i < 3; ++i) {
    const GridAxis& axis = scene.grid.axes[i];
    if (std::isinf(box.lower[i]) || !(axis.min < axis.max)) continue;
    if (box.upper[i] >= axis.min && box.lower[i] <= axis.max) continue;
    faults.push_back(
        {"Body", 0, "name", body.name,
         fmt::format(
             "the body is outside the grid: its {0} ranges from {1} to {2}, that of the grid from {3} to {4}",
             "xyz"[i], box.lower[i], box.upper[i], axis.min, axis.max)});
    return;
  }
}

void check_count(std::string_view attribute, double spacing, double count, std::vector<ShapeFault>& faults) {
  if (count > most_particles)
    faults.push_back({"Geometry", 0, std::string(attribute), fmt::format("{}", spacing),
                      fmt::format("this gives about {:.3g} particles, more than the limit of 2^48; expected "
                                  "a larger particle spacing",
                                  count)});
}

ShapeFault nothing_left(const Scene& scene, const BodyInput& body) {
  if (const auto* difference = std::get_if<BoolGeometry>(&body.geometry))
    return {"Body", 0, "BoolBodyB", body_at(scene, difference->subtrahend).name,
            fmt::format("the body has no particles: no particle of body '{}' is outside the subtracted body",
                        body_at(scene, difference->minuend).name)};
  return {"Geometry",
          0,
          {},
          {},
          "the body has no particles: its shape is smaller than the particle spacing; expected a smaller "
          "spacing"};
}

/// Checks the particles' lattice: whether there are too many particles, or none.
void check_lattice(const Scene& scene, const BodyInput& body, std::vector<ShapeFault>& faults) {
  if (const auto* block = std::get_if<HexahedronBlockGeometry>(&body.geometry))
    check_count("dp", block->spacing, BlockSource(*block, Frame(), body.density).expected_particles(),
                faults);
  if (!made_of_particles(body.geometry) || made_of_files(scene, body)) return;
  const auto source = make_unchecked_source(scene, body);
  std::visit(
      [&](const auto& g) {
        using G = std::decay_t<decltype(g)>;
        if constexpr (std::is_same_v<G, BlockGeometry> || std::is_same_v<G, SphereGeometry>)
          check_count("dp", g.spacing, source->expected_particles(), faults);
        if constexpr (std::is_same_v<G, CylinderGeometry> || std::is_same_v<G, OgiveGeometry>)
          check_count("dp_bottom", g.bottom_spacing, source->expected_particles(), faults);
      },
      body.geometry);
  const bool takes_part = !body.deactivated && !body.for_bool;
  const bool may_be_empty = !std::holds_alternative<BlockGeometry>(body.geometry) &&
                            !std::holds_alternative<PointGeometry>(body.geometry);
  if (faults.empty() && takes_part && may_be_empty && is_surely_empty(*source))
    faults.push_back(nothing_left(scene, body));
}

Diagnostic at_body(const BodyInput& body, ShapeFault fault) {
  return {body.source.file,         body.source.line,
          std::move(fault.element), std::move(fault.attribute),
          std::move(fault.value),   fmt::format("body `{}`: {}", body.name, fault.message)};
}

}  // namespace

std::vector<ShapeFault> shape_faults(const Scene& scene, const BodyInput& body) {
  std::vector<ShapeFault> faults = NumberCheck(body).take();
  const Parts parts(scene, body);
  if (const auto* difference = std::get_if<BoolGeometry>(&body.geometry))
    check_operands(scene, *difference, parts, faults);
  const bool sound =
      parts.whole() && std::ranges::all_of(parts.bodies(), [&](const BodyInput* part) {
        return placed(scene, *part) &&
               (part == &body || (made_of_particles(part->geometry) && NumberCheck(*part).take().empty()));
      });
  if (!faults.empty() || !sound) return faults;
  if (!body.deactivated && !body.for_bool) check_inside(scene, body, faults);
  check_lattice(scene, body, faults);
  return faults;
}

std::vector<Diagnostic> shape_errors(const Scene& scene, const BodyInput& body) {
  std::vector<Diagnostic> errors;
  for (ShapeFault& fault : shape_faults(scene, body)) errors.push_back(at_body(body, std::move(fault)));
  const Parts parts(scene, body);
  for (const BodyInput* part : parts.bodies()) {
    if (part == &body) continue;
    for (ShapeFault& fault : NumberCheck(*part).take()) errors.push_back(at_body(*part, std::move(fault)));
  }
  return errors;
}

Diagnostic no_particles(const Scene& scene, const BodyInput& body) {
  return at_body(body, nothing_left(scene, body));
}

bool made_of_files(const Scene& scene, const BodyInput& body) {
  const Parts parts(scene, body);
  return std::ranges::any_of(parts.bodies(), [](const BodyInput* part) {
    const auto* points = std::get_if<PointGeometry>(&part->geometry);
    return points != nullptr && !points->file.empty();
  });
}

}  // namespace mpm::core
