// Components, bodies and their shapes as text.

#include <fmt/format.h>

#include "io/input/echo_parts.hpp"

namespace mpm::io {

namespace {

/// A number, or the expression in its place.
void echo_component(XmlWriter& w, std::string_view attribute, int component, double value,
                    const core::Expressions& expressions) {
  for (const core::Expression& e : expressions)
    if (e.component == component) return w.text(attribute, e.text);
  w.number(attribute, value);
}

void echo_vector(XmlWriter& w, std::string_view name, std::string_view a, std::string_view b,
                 std::string_view c, const core::Vec3<double>& values,
                 const core::Expressions& expressions = {}) {
  const auto scope = w.element(name);
  echo_component(w, a, 0, values.x, expressions);
  echo_component(w, b, 1, values.y, expressions);
  echo_component(w, c, 2, values.z, expressions);
}

void echo_value(XmlWriter& w, std::string_view name, double value) {
  const auto scope = w.element(name);
  w.number("value", value);
}

/// Writes the attributes and children of Geometry.
struct GeometryEcho {
  XmlWriter& w;

  void operator()(const core::PointGeometry& g) const {
    if (!g.file.empty()) w.text("file", g.file);
    for (const core::PointMass& p : g.points) {
      const auto point = w.element("Point");
      w.number("mass", p.mass);
      w.numbers("x", "y", "z", p.position);
    }
  }
  void operator()(const core::BlockGeometry& g) const {
    w.number("dp", g.spacing);
    w.numbers("x0", "y0", "z0", g.origin);
    w.numbers("lx", "ly", "lz", g.size);
  }
  void operator()(const core::SphereGeometry& g) const {
    w.number("dp", g.spacing);
    w.numbers("x0", "y0", "z0", g.centre);
    w.number("Outer_Radius", g.outer_radius);
    w.number("Inner_Radius", g.inner_radius);
    w.number("angle", g.angle);
    w.flag("half", g.upper_half);
    w.flag("discretization", g.layout == core::Layout::polar);
  }
  void operator()(const core::CylinderGeometry& g) const {
    w.numbers("x0", "y0", "z0", g.base_centre);
    w.number("dp_bottom", g.bottom_spacing);
    w.number("dp_top", g.top_spacing);
    w.number("Bottom_Inner_Radius", g.bottom_inner_radius);
    w.number("Bottom_Outer_Radius", g.bottom_outer_radius);
    w.number("Top_Inner_Radius", g.top_inner_radius);
    w.number("Top_Outer_Radius", g.top_outer_radius);
    w.number("height", g.height);
    w.number("angle", g.angle);
    w.flag("discretization", g.layout == core::Layout::polar);
  }
  void operator()(const core::OgiveGeometry& g) const {
    w.numbers("x0", "y0", "z0", g.base_centre);
    w.number("dp_bottom", g.bottom_spacing);
    w.number("dp_top", g.top_spacing);
    w.number("Ogive_Radius", g.ogive_radius);
    w.number("End_Radius", g.end_radius);
    w.number("angle", g.angle);
    w.flag("discretization", g.layout == core::Layout::polar);
  }
  void operator()(const core::BoolGeometry&) const {}  // has no Geometry element
  template <std::size_t N>
  void operator()(const core::MeshGeometry<N>& g) const {
    if (!g.file.empty()) {
      w.text("file", g.file);
      w.integer("nb_nodes", g.file_nodes);
      w.integer("nb_elements", g.file_elements);
    }
    if (N == 3) w.number("thickness", g.thickness);
    for (const auto& node : g.nodes) {
      const auto point = w.element("Point");
      w.integer("node_id", node.id);
      w.numbers("x", "y", "z", node.position);
    }
    for (const auto& e : g.elements) {
      const auto element = w.element("Element");
      w.integer("element_id", e.id);
      for (std::size_t i = 0; i < N; ++i) w.integer(fmt::format("id{}", i + (N == 8 ? 1 : 0)), e.nodes[i]);
      if (N == 2) w.number("sectional_area", e.sectional_area);
    }
  }
  void operator()(const core::BarLinesGeometry& g) const {
    w.number("sectional_area", g.sectional_area);
    w.number("element_size", g.element_size);
    w.integer("nb_lines", g.lines);
    w.integer("extend_direction", g.extend_direction);
    w.integer("expand_direction", g.expand_direction);
    w.number("length", g.length);
    w.numbers("x0", "y0", "z0", g.origin);
    w.number("internal", g.interval);
  }
  void operator()(const core::BarNetGeometry& g) const {
    w.number("sectional_area", g.sectional_area);
    w.numbers("x0", "y0", "z0", g.origin);
    w.numbers("element_size_x", "element_size_y", "element_size_z", g.element_size);
    w.integer("nb_lines_x", g.lines[0]);
    w.integer("nb_lines_y", g.lines[1]);
    w.integer("nb_layers_z", g.lines[2]);
    w.numbers("internal_x", "internal_y", "internal_z", g.interval);
    w.integer("line_direction", g.line_direction);
    w.integer("colum_direction", g.column_direction);
    w.integer("colum_nb_copy", g.column_copies);
    w.number("colum_interval", g.column_interval);
    w.integer("line_nb_copy", g.line_copies);
    w.number("line_interval", g.line_interval);
  }
  void operator()(const core::MembraneRectangleGeometry& g) const {
    w.number("thickness", g.thickness);
    w.number("element_size", g.element_size);
    w.numbers("x0", "y0", "z0", g.origin);
    w.number("lx", g.size[0]);
    w.number("ly", g.size[1]);
  }
  void operator()(const core::MembraneCylinderGeometry& g) const {
    w.number("thickness", g.thickness);
    w.number("element_size", g.element_size);
    w.numbers("x0", "y0", "z0", g.base_centre);
    w.number("radius", g.radius);
    w.number("height", g.height);
    w.number("angle", g.angle);
  }
};

void echo_loads(XmlWriter& w, const core::BodyInput& body) {
  echo_vector(w, "InitialVelocity", "vx", "vy", "vz", body.initial_velocity,
              body.initial_velocity_expressions);
  if (body.initial_temperature) echo_value(w, "InitialTemperature", *body.initial_temperature);
  if (body.prescribed_velocity)
    echo_vector(w, "PrescribedVelocity", "vx", "vy", "vz", *body.prescribed_velocity,
                body.prescribed_velocity_expressions);
  if (body.prescribed_acceleration) {
    const auto scope = w.element("PrescribedAcceleration");
    w.numbers("ax", "ay", "az", body.prescribed_acceleration->linear_amplitude);
    w.numbers("arx", "ary", "arz", body.prescribed_acceleration->angular_amplitude);
    for (const auto& point : body.prescribed_acceleration->points) {
      const auto coefficient = w.element("Coefficient");
      w.number("time", point.time);
      w.numbers("cx", "cy", "cz", point.linear_factor);
      w.numbers("crx", "cry", "crz", point.angular_factor);
    }
  }
  if (body.harmonic_excitation) {
    const auto scope = w.element("HarmExcit");
    echo_vector(w, "A", "x", "y", "z", body.harmonic_excitation->amplitude);
    echo_vector(w, "Omega", "x", "y", "z", body.harmonic_excitation->angular_frequency);
    echo_vector(w, "Theta", "x", "y", "z", body.harmonic_excitation->phase);
    echo_vector(w, "EndTime", "x", "y", "z", body.harmonic_excitation->end_time);
  }
  if (body.body_force)
    echo_vector(w, "BodyForce", "bx", "by", "bz", body.body_force->number, body.body_force->expressions);
  for (const core::SurfaceLoad& load : body.surface_loads) {
    const auto scope = w.element("Traction");
    echo_component(w, "pressure", core::SurfaceLoad::pressure_component, load.pressure, load.expressions);
    if (load.normal >= 0) {
      echo_component(w, "tx", 0, load.traction.x, load.expressions);
      echo_component(w, "ty", 1, load.traction.y, load.expressions);
      echo_component(w, "tz", 2, load.traction.z, load.expressions);
      w.integer("normal", load.normal);
    }
    static constexpr const char* lower[3] = {"xmin", "ymin", "zmin"};
    static constexpr const char* upper[3] = {"xmax", "ymax", "zmax"};
    for (std::size_t a = 0; a < 3; ++a) {
      if (load.lower[a] > -1e300) w.number(lower[a], load.lower[a]);
      if (load.upper[a] < 1e300) w.number(upper[a], load.upper[a]);
    }
    if (load.ramp) w.number("ramp", *load.ramp);
    for (const auto& point : load.points) {
      const auto coefficient = w.element("Coefficient");
      w.number("time", point.time);
      w.number("c", point.factor);
    }
  }
  if (body.constrain_rigid_position) echo_value(w, "ConstrainRigidPosition", 1);
  if (body.rigid_inertia) {
    const auto scope = w.element("RigidInertia");
    w.number("mass", body.rigid_inertia->mass);
    if (const auto& i = body.rigid_inertia->tensor) {
      w.numbers("Ixx", "Iyy", "Izz", {i->xx, i->yy, i->zz});
      w.numbers("Ixy", "Iyz", "Ixz", {i->xy, i->yz, i->xz});
    }
  }
  if (body.adaptive_split) echo_value(w, "AdaptiveSplit", *body.adaptive_split);
  if (body.fragment_spacing) echo_value(w, "CountFragDp", *body.fragment_spacing);
  for (const core::FixedLayer& layer : body.fixed_layers) echo_fixed_layer(w, "LocalBoundaryCond", layer);
}

void echo_body(XmlWriter& w, const core::BodyInput& body, const core::Scene& scene) {
  const auto scope = w.element("Body");
  w.text("name", body.name);
  w.text("material", scene.materials[body.material].name);
  w.text("type", body.type);
  w.number("density", body.density);
  if (body.work_plane) w.text("workPlane", scene.work_planes[*body.work_plane].name);
  w.flag("ForBoolBody", body.for_bool);
  if (const auto* difference = std::get_if<core::BoolGeometry>(&body.geometry)) {
    w.text("BoolType", "subtract");
    w.text("BoolBodyA", core::body_at(scene, difference->minuend).name);
    w.text("BoolBodyB", core::body_at(scene, difference->subtrahend).name);
  } else {
    const auto geometry = w.element("Geometry");
    std::visit(GeometryEcho{w}, body.geometry);
  }
  echo_loads(w, body);
  const auto control = w.element("BodyContrl");
  w.flag("Deactive", body.deactivated);
  w.flag("NoOutput", body.no_output);
}

}  // namespace

void echo_fixed_layer(XmlWriter& w, std::string_view name, const core::FixedLayer& layer) {
  const auto scope = w.element(name);
  w.integer("FixedDirection", layer.direction);
  w.integer("Normal", layer.normal);
  w.number("Min", layer.min);
  w.number("Max", layer.max);
}

void echo_component(XmlWriter& w, const core::ComponentInput& component, const core::Scene& scene) {
  const auto scope = w.element("Component");
  w.text("name", component.name);
  w.number("normal_vector_weight", component.normal_weight);
  for (const core::BodyInput& body : component.bodies) echo_body(w, body, scene);
}

}  // namespace mpm::io
