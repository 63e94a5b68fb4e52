// The shapes of bodies. Their dimensions are checked after all bodies are built (check_shapes).

#include <fmt/format.h>

#include "io/input/build.hpp"
#include "io/input/file_access.hpp"

namespace mpm::io {

namespace {

/// The file of a geometry relative to the input's folder; reports a fault if it cannot be read.
std::string build_file(const Node& node, const BuildContext& context) {
  const std::string given = node.word("file");
  if (given.empty()) return {};
  const std::filesystem::path path = context.folder / given;
  if (context.check_files)
    if (const std::string wrong = why_unreadable(path); !wrong.empty())
      node.report(context.diagnostics, "file", fmt::format("{}: {}", path.string(), wrong));
  return path.string();
}

core::PointGeometry build_points(const Node& node, const BuildContext& context) {
  core::PointGeometry points;
  points.file = build_file(node, context);
  const std::vector<Node> nodes = node.children("Point");
  points.points.reserve(nodes.size());
  for (const Node& p : nodes) points.points.push_back({p.real("mass"), p.reals("x", "y", "z")});
  return points;
}

core::BlockGeometry build_block(const Node& node) {
  return {node.real("dp"), node.reals("x0", "y0", "z0"), node.reals("lx", "ly", "lz")};
}

core::Layout layout(const Node& node) {
  return node.boolean("discretization") ? core::Layout::polar : core::Layout::orthogonal;
}

core::SphereGeometry build_sphere(const Node& node) {
  core::SphereGeometry sphere;
  sphere.spacing = node.real("dp");
  sphere.centre = node.reals("x0", "y0", "z0");
  sphere.outer_radius = node.real("Outer_Radius");
  sphere.inner_radius = node.real("Inner_Radius");
  sphere.angle = node.real("angle");
  sphere.upper_half = node.boolean("half");
  sphere.layout = layout(node);
  return sphere;
}

core::CylinderGeometry build_cylinder(const Node& node) {
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
  return c;
}

core::OgiveGeometry build_ogive(const Node& node) {
  core::OgiveGeometry o;
  o.base_centre = node.reals("x0", "y0", "z0");
  o.bottom_spacing = node.real("dp_bottom");
  o.top_spacing = node.real("dp_top");
  o.ogive_radius = node.real("Ogive_Radius");
  o.end_radius = node.real("End_Radius");
  o.angle = node.real("angle");
  o.layout = layout(node);
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
  for (const Node& e : node.children("Element")) {
    typename core::MeshGeometry<N>::Element element;
    element.id = e.integer("element_id");
    for (std::size_t i = 0; i < N; ++i) element.nodes[i] = e.integer(fmt::format("id{}", i + first_id));
    if (N == 2) element.sectional_area = e.real("sectional_area");
    mesh.elements.push_back(element);
  }
  return mesh;
}

core::BarLinesGeometry build_bar_lines(const Node& node) {
  core::BarLinesGeometry bars;
  bars.sectional_area = node.real("sectional_area");
  bars.element_size = node.real("element_size");
  bars.lines = node.integer("nb_lines");
  bars.extend_direction = static_cast<int>(node.given_integer("extend_direction").value_or(-1));
  bars.expand_direction = static_cast<int>(node.given_integer("expand_direction").value_or(-1));
  bars.length = node.real("length");
  bars.origin = node.reals("x0", "y0", "z0");
  bars.interval = node.real("internal");
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
  if (type == "Block") return build_block(node);
  if (type == "Sphere") return build_sphere(node);
  if (type == "Cylinder") return build_cylinder(node);
  if (type == "Ogive") return build_ogive(node);
  if (type == "PointForBar") return build_mesh<2>(node, context);
  if (type == "LineForBar") return build_bar_lines(node);
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
  if (type == "BlockForFEM") return core::HexahedronBlockGeometry{build_block(node)};
  return core::PointGeometry{};
}

}  // namespace mpm::io
