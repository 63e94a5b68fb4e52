// The shapes of bodies, and whether their numbers make a shape.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "io/input/build.hpp"
#include "io/input/file_access.hpp"

namespace mpm::io {

namespace {

/// No machine holds more particles; beyond it the spacing is a mistake.
constexpr double most_particles = 0x1p48;

void check_count(const Node& node, std::string_view spacing, double volume, double cell,
                 const BuildContext& context) {
  const double count = volume / cell;
  if (count > most_particles)
    node.complain(
        context.diagnostics, spacing,
        fmt::format("this makes about {:.3g} particles, more than any machine holds (2^48); expected a "
                    "larger distance of particles",
                    count));
}

/// The file of a geometry against the input's folder; complains when it cannot be read.
std::string build_file(const Node& node, const BuildContext& context) {
  const std::string given = node.word("file");
  if (given.empty()) return {};
  const std::filesystem::path path = context.folder / given;
  if (context.check_files)
    if (const std::string wrong = why_unreadable(path); !wrong.empty())
      node.complain(context.diagnostics, "file", fmt::format("{}: {}", path.string(), wrong));
  return path.string();
}

/// Inline children or a file: one of the two.
void check_one_source(const Node& node, bool has_children, std::string_view children,
                      const BuildContext& context) {
  const bool has_file = !node.word("file").empty();
  if (has_file && has_children)
    node.complain(context.diagnostics, "file",
                  fmt::format("{} are given in the input too; expected one of the two ways", children));
  if (!has_file && !has_children)
    node.complain(context.diagnostics, fmt::format("expected {}, or file=\"...\"", children));
}

core::PointGeometry build_points(const Node& node, const BuildContext& context) {
  core::PointGeometry points;
  points.file = build_file(node, context);
  const std::vector<Node> nodes = node.children("Point");
  points.points.reserve(nodes.size());
  for (const Node& p : nodes) points.points.push_back({p.real("mass"), p.reals("x", "y", "z")});
  check_one_source(node, !nodes.empty(), "<Point> elements", context);
  return points;
}

core::BlockGeometry build_block(const Node& node, const BuildContext& context) {
  const core::BlockGeometry block{node.real("dp"), node.reals("x0", "y0", "z0"),
                                  node.reals("lx", "ly", "lz")};
  const double volume = block.size[0] * block.size[1] * block.size[2];
  check_count(node, "dp", volume, std::pow(block.spacing, 3), context);
  return block;
}

void check_radii(const Node& node, std::string_view inner, std::string_view outer, bool may_vanish,
                 const BuildContext& context) {
  const double in = node.real(inner), out = node.real(outer);
  if (in >= out && !(may_vanish && in == 0 && out == 0))
    node.complain(context.diagnostics, outer, fmt::format("expected more than {}, {}", inner, in));
}

core::Layout layout(const Node& node) {
  return node.boolean("discretization") ? core::Layout::polar : core::Layout::orthogonal;
}

core::SphereGeometry build_sphere(const Node& node, const BuildContext& context) {
  core::SphereGeometry sphere;
  sphere.spacing = node.real("dp");
  sphere.centre = node.reals("x0", "y0", "z0");
  sphere.outer_radius = node.real("Outer_Radius");
  sphere.inner_radius = node.real("Inner_Radius");
  sphere.angle = node.real("angle");
  sphere.upper_half = node.boolean("half");
  sphere.layout = layout(node);
  check_radii(node, "Inner_Radius", "Outer_Radius", false, context);
  if (sphere.upper_half && sphere.angle != 90)
    node.complain(context.diagnostics, "half", fmt::format("needs angle=\"90\", not {}", sphere.angle));
  const double shell = std::pow(sphere.outer_radius, 3) - std::pow(sphere.inner_radius, 3);
  const double share = sphere.angle / 360 * (sphere.upper_half ? 0.5 : 1);
  check_count(node, "dp", 4 * std::numbers::pi / 3 * shell * share, std::pow(sphere.spacing, 3), context);
  return sphere;
}

core::CylinderGeometry build_cylinder(const Node& node, const BuildContext& context) {
  core::CylinderGeometry c;
  c.base_centre = node.reals("x0", "y0", "z0");
  c.bottom_spacing = node.real("dp_bottom");
  c.top_spacing = node.real("dp_top");
  c.bottom_inner_radius = node.real("Bottom_Inner_Radius");
  c.bottom_outer_radius = node.real("Bottom_Outer_Radius");
  c.top_inner_radius = node.real("Top_Inner_Radius");
  c.top_outer_radius = node.real("Top_Outer_Radius");
  c.height = node.real("height");
  c.angle = node.real("angle");
  c.layout = layout(node);
  check_radii(node, "Bottom_Inner_Radius", "Bottom_Outer_Radius", c.top_outer_radius > 0, context);
  check_radii(node, "Top_Inner_Radius", "Top_Outer_Radius", c.bottom_outer_radius > 0, context);
  // Frusta without and with the hole, at the mean of the cubed spacings: an estimate.
  const auto frustum = [&](double a, double b) {
    return std::numbers::pi / 3 * c.height * (a * a + a * b + b * b);
  };
  const double volume =
      frustum(c.bottom_outer_radius, c.top_outer_radius) - frustum(c.bottom_inner_radius, c.top_inner_radius);
  const double cell = std::pow(c.bottom_spacing * c.top_spacing, 1.5);
  check_count(node, "dp_bottom", volume * c.angle / 360, cell, context);
  return c;
}

core::OgiveGeometry build_ogive(const Node& node, const BuildContext& context) {
  core::OgiveGeometry o;
  o.base_centre = node.reals("x0", "y0", "z0");
  o.bottom_spacing = node.real("dp_bottom");
  o.top_spacing = node.real("dp_top");
  o.ogive_radius = node.real("Ogive_Radius");
  o.end_radius = node.real("End_Radius");
  o.angle = node.real("angle");
  o.layout = layout(node);
  if (o.ogive_radius < o.end_radius)
    node.complain(context.diagnostics, "Ogive_Radius",
                  fmt::format("expected at least End_Radius, {}", o.end_radius));
  const double length = std::sqrt(std::max(0., o.end_radius * (2 * o.ogive_radius - o.end_radius)));
  const double volume = std::numbers::pi * o.end_radius * o.end_radius * length * o.angle / 360;
  check_count(node, "dp_bottom", volume, std::pow(o.bottom_spacing * o.top_spacing, 1.5), context);
  return o;
}

template <std::size_t N>
core::MeshGeometry<N> build_mesh(const Node& node, const BuildContext& context) {
  core::MeshGeometry<N> mesh;
  mesh.file = build_file(node, context);
  mesh.file_nodes = node.integer("nb_nodes");
  mesh.file_elements = node.integer("nb_elements");
  if (N == 3) mesh.thickness = node.real("thickness");
  constexpr int first_id = N == 8 ? 1 : 0;  // hexahedra count their corners from 1
  for (const Node& n : node.children("Point"))
    mesh.nodes.push_back({n.integer("node_id"), n.reals("x", "y", "z")});
  std::set<std::int64_t> ids;
  for (const auto& n : mesh.nodes) ids.insert(n.id);
  for (const Node& e : node.children("Element")) {
    typename core::MeshGeometry<N>::Element element;
    element.id = e.integer("element_id");
    for (std::size_t i = 0; i < N; ++i) {
      const std::string name = fmt::format("id{}", i + first_id);
      element.nodes[i] = e.integer(name);
      if (element.nodes[i] > 0 && !ids.contains(element.nodes[i]))
        e.complain(context.diagnostics, name, "there is no node of this number");
    }
    if (N == 2) element.sectional_area = e.real("sectional_area");
    mesh.elements.push_back(element);
  }
  check_one_source(node, !mesh.nodes.empty() || !mesh.elements.empty(), "<Point> and <Element> elements",
                   context);
  return mesh;
}

core::BarLinesGeometry build_bar_lines(const Node& node, const BuildContext& context) {
  core::BarLinesGeometry bars;
  bars.sectional_area = node.real("sectional_area");
  bars.element_size = node.real("element_size");
  bars.lines = node.integer("nb_lines");
  bars.extend_direction = node.small_integer("extend_direction");
  bars.expand_direction = node.small_integer("expand_direction");
  bars.length = node.real("length");
  bars.origin = node.reals("x0", "y0", "z0");
  bars.interval = node.real("internal");
  if (node.given_integer("extend_direction") && bars.extend_direction == bars.expand_direction)
    node.complain(context.diagnostics, "expand_direction", "expected another axis than extend_direction");
  return bars;
}

core::BarNetGeometry build_bar_net(const Node& node) {
  core::BarNetGeometry net;
  net.sectional_area = node.real("sectional_area");
  net.origin = node.reals("x0", "y0", "z0");
  net.element_size = node.reals("element_size_x", "element_size_y", "element_size_z");
  net.lines = {node.integer("nb_lines_x"), node.integer("nb_lines_y"), node.integer("nb_layers_z")};
  net.interval = node.reals("internal_x", "internal_y", "internal_z");
  net.line_direction = node.small_integer("line_direction");
  net.column_direction = node.small_integer("colum_direction");
  net.column_copies = node.integer("colum_nb_copy");
  net.column_interval = node.real("colum_interval");
  net.line_copies = node.integer("line_nb_copy");
  net.line_interval = node.real("line_interval");
  return net;
}

}  // namespace

core::Geometry build_geometry(const Node& node, const BuildContext& context) {
  const std::string_view type = node.type();
  if (type == "Point") return build_points(node, context);
  if (type == "Block") return build_block(node, context);
  if (type == "Sphere") return build_sphere(node, context);
  if (type == "Cylinder") return build_cylinder(node, context);
  if (type == "Ogive") return build_ogive(node, context);
  if (type == "PointForBar") return build_mesh<2>(node, context);
  if (type == "LineForBar") return build_bar_lines(node, context);
  if (type == "NettyForBar") return build_bar_net(node);
  if (type == "PointForMembrane") return build_mesh<3>(node, context);
  if (type == "RectangularForMembrane")
    return core::MembraneRectangleGeometry{node.real("thickness"),
                                           node.real("element_size"),
                                           node.reals("x0", "y0", "z0"),
                                           {node.real("lx"), node.real("ly")}};
  if (type == "CylinderForMembrane")
    return core::MembraneCylinderGeometry{node.real("thickness"),       node.real("element_size"),
                                          node.reals("x0", "y0", "z0"), node.real("radius"),
                                          node.real("height"),          node.real("angle")};
  if (type == "PointForFEM") return build_mesh<8>(node, context);
  if (type == "BlockForFEM") return core::HexahedronBlockGeometry{build_block(node, context)};
  return core::PointGeometry{};
}

}  // namespace mpm::io
