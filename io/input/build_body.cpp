// Work planes, components, bodies and detonations.

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <unordered_map>

#include <fmt/format.h>

#include "core/contact/component_contact.hpp"
#include "core/tensor/principal.hpp"
#include "io/input/build.hpp"
#include "io/input/text.hpp"

namespace mpm::io {

namespace {

core::WorkPlane build_work_plane(const Node& node, const BuildContext& context) {
  core::WorkPlane plane;
  plane.name = node.word("name");
  plane.source = context.at(node);
  plane.origin = node.reals("r0x", "r0y", "r0z");
  const core::Vec3<double> z = node.reals("ex", "ey", "ez");
  const core::Vec3<double> x = node.reals("a11", "a21", "a31");
  const double lengths = std::sqrt(dot(z, z)) * std::sqrt(dot(x, x));
  if (lengths == 0 || std::isinf(lengths)) {
    node.report(context.diagnostics, "the axes (ex, ey, ez) and (a11, a21, a31) must not be zero");
    return plane;
  }
  constexpr double tolerance = 1e-6;  // of the cosine: accepts axes given with seven digits
  const double cosine = dot(z, x) / lengths;
  if (std::abs(cosine) > tolerance) {
    const double degrees = std::acos(std::clamp(cosine, -1., 1.)) * 180 / std::acos(-1.);
    node.report(context.diagnostics,
                fmt::format("the axes (ex, ey, ez) and (a11, a21, a31) must be orthogonal; the "
                            "angle between them is {:.6g} degrees",
                            degrees));
  }
  plane.z_axis = (1 / std::sqrt(dot(z, z))) * z;
  plane.y_axis = cross(plane.z_axis, x);  // exactly orthogonal
  plane.y_axis = (1 / std::sqrt(dot(plane.y_axis, plane.y_axis))) * plane.y_axis;
  plane.x_axis = cross(plane.y_axis, plane.z_axis);
  return plane;
}

/// The time of the last point, read from `node`, must exceed the previous one.
template <class Point>
void check_last_time(const std::vector<Point>& points, const Node& node, const BuildContext& context) {
  const std::size_t n = points.size();
  if (n > 1 && points[n - 1].time <= points[n - 2].time)
    node.report(context.diagnostics, "time",
                fmt::format("the times must increase; the one before is {}", points[n - 2].time));
}

core::PrescribedAcceleration build_acceleration(const Node& node, const BuildContext& context) {
  core::PrescribedAcceleration load;
  load.linear_amplitude = node.reals("ax", "ay", "az");
  load.angular_amplitude = node.reals("arx", "ary", "arz");
  for (const Node& point : node.children("Coefficient")) {
    load.points.push_back(
        {point.real("time"), point.reals("cx", "cy", "cz"), point.reals("crx", "cry", "crz")});
    check_last_time(load.points, point, context);
  }
  return load;
}

/// The expressions among these attributes, the components of a quantity.
core::Expressions expressions_of(const Node& node, std::initializer_list<std::string_view> attributes,
                                 const BuildContext& context) {
  core::Expressions found;
  int component = 0;
  for (const std::string_view attribute : attributes) {
    if (const std::optional<std::string> text = node.expression(attribute))
      found.push_back({component,
                       *text,
                       std::string(node.name()),
                       std::string(attribute),
                       {context.at(node).file, node.find(attribute)->line}});
    ++component;
  }
  return found;
}

core::SurfaceLoad build_surface_load(const Node& node, const BuildContext& context) {
  core::SurfaceLoad load;
  load.pressure = node.real("pressure");
  load.traction = node.reals("tx", "ty", "tz");
  load.expressions = expressions_of(node, {"tx", "ty", "tz", "pressure"}, context);
  const auto varies = [&](bool pressure) {
    return std::ranges::any_of(load.expressions, [&](const core::Expression& e) {
      return (e.component == core::SurfaceLoad::pressure_component) == pressure;
    });
  };
  const bool pulls = load.traction != core::Vec3<double>{} || varies(false);
  if (const auto normal = node.given_integer("normal")) load.normal = static_cast<int>(*normal);
  if (pulls != (load.normal >= 0))
    node.report(context.diagnostics, "normal is the axis of the traction tx, ty, tz: give both or neither");
  if (!pulls && load.pressure == 0 && !varies(true))
    node.report(context.diagnostics, "expected a pressure, or tx, ty, tz and normal");
  static constexpr std::array<std::array<const char*, 2>, 3> sides{
      {{"xmin", "xmax"}, {"ymin", "ymax"}, {"zmin", "zmax"}}};
  for (std::size_t a = 0; a < 3; ++a) {
    load.lower[a] = node.given_real(sides[a][0]).value_or(load.lower[a]);
    load.upper[a] = node.given_real(sides[a][1]).value_or(load.upper[a]);
    if (!(load.lower[a] < load.upper[a]))
      node.report(context.diagnostics, sides[a][1], fmt::format("must be greater than {}", sides[a][0]));
  }
  load.ramp = node.given_real("ramp");
  for (const Node& point : node.children("Coefficient")) {
    load.points.push_back({point.real("time"), point.real("c")});
    check_last_time(load.points, point, context);
  }
  return load;
}

core::HarmonicExcitation build_excitation(const Node& node) {
  const auto reals_of = [&](std::string_view child) {
    const std::optional<Node> found = node.child(child);
    return found ? found->reals("x", "y", "z") : core::Vec3<double>{};
  };
  return {reals_of("A"), reals_of("Omega"), reals_of("Theta"), reals_of("EndTime")};
}

void build_loads(core::BodyInput& body, const Node& node, const BuildContext& context) {
  if (const auto v = node.child("InitialVelocity")) {
    body.initial_velocity = v->reals("vx", "vy", "vz");
    body.initial_velocity_expressions = expressions_of(*v, {"vx", "vy", "vz"}, context);
  }
  if (const auto t = node.child("InitialTemperature")) body.initial_temperature = t->given_real("value");
  if (const auto v = node.child("PrescribedVelocity")) {
    body.prescribed_velocity = v->reals("vx", "vy", "vz");
    body.prescribed_velocity_expressions = expressions_of(*v, {"vx", "vy", "vz"}, context);
  }
  if (const auto a = node.child("PrescribedAcceleration"))
    body.prescribed_acceleration = build_acceleration(*a, context);
  if (const auto h = node.child("HarmExcit")) {
    body.harmonic_excitation = build_excitation(*h);
    if (body.prescribed_acceleration)
      h->report(context.diagnostics,
                "a body cannot have both PrescribedAcceleration and HarmExcit: remove one");
  }
  if (const auto f = node.child("BodyForce"))
    body.body_force = {f->reals("bx", "by", "bz"), expressions_of(*f, {"bx", "by", "bz"}, context)};
  for (const Node& load : node.children("Traction"))
    body.surface_loads.push_back(build_surface_load(load, context));
  if (const auto c = node.child("ConstrainRigidPosition"))
    body.constrain_rigid_position = c->boolean("value");
  if (const auto i = node.child("RigidInertia")) {
    core::RigidInertia& inertia = body.rigid_inertia.emplace();
    inertia.mass = i->real("mass");
    if (i->given_real("Ixx"))
      inertia.tensor = core::Sym3<double>{i->real("Ixx"), i->real("Iyy"), i->real("Izz"),
                                          i->real("Ixy"), i->real("Iyz"), i->real("Ixz")};
  }
  if (const auto s = node.child("AdaptiveSplit")) body.adaptive_split = s->given_real("value");
  if (const auto f = node.child("CountFragDp")) body.fragment_spacing = f->given_real("value");
  for (const Node& layer : node.children("LocalBoundaryCond"))
    body.fixed_layers.push_back(build_fixed_layer(layer, context));
}

/// Rejects loads without effect on a body with prescribed velocity.
void check_held(const core::BodyInput& body, const Node& node, const BuildContext& context) {
  const auto refuse = [&](std::string_view element, const std::string& why) {
    for (const Node& load : node.children(element)) load.report(context.diagnostics, why);
  };
  if (body.prescribed_velocity && !body.constrain_rigid_position) {
    for (const char* element : {"PrescribedAcceleration", "HarmExcit"})
      refuse(element,
             "has no effect with PrescribedVelocity: give ConstrainRigidPosition value=\"1\" to add it to "
             "that velocity, or replace PrescribedVelocity by InitialVelocity");
  }
  if (body.prescribed_velocity || body.constrain_rigid_position)
    for (const char* element : {"Traction", "BodyForce"})
      refuse(element, "has no effect on a body whose velocity is prescribed or constrained");
  if (body.constrain_rigid_position && !body.prescribed_velocity) {
    for (const core::Expression& e : body.initial_velocity_expressions)
      node.child("InitialVelocity")
          ->report(context.diagnostics, e.attribute,
                   "ConstrainRigidPosition keeps one velocity for the whole body: expected a number; or use "
                   "PrescribedVelocity");
  }
}

/// Rejects expressions of the position for a rigid body, whose particles have one velocity.
void check_rigid_expressions(const core::BodyInput& body, const Node& node, const BuildContext& context) {
  const auto check = [&](const char* element, const core::Expressions& expressions) {
    for (const core::Expression& e : expressions)
      if ((core::Formula::check(e.text).uses & ~core::variables_named("t")).any())
        node.child(element)->report(
            context.diagnostics, e.attribute,
            "a rigid body moves as a whole: expected a number or an expression in t only");
  };
  check("PrescribedVelocity", body.prescribed_velocity_expressions);
  if (body.body_force) check("BodyForce", body.body_force->expressions);
  for (const core::Expression& e : body.initial_velocity_expressions)
    node.child("InitialVelocity")
        ->report(context.diagnostics, e.attribute,
                 "a rigid body moves as a whole: expected a number; a spin comes from the angular part of "
                 "PrescribedAcceleration");
}

/// Angular accelerations turn rigid bodies in contact only.
void check_rotation(const core::BodyInput& body, const Node& node, bool rigid, const core::Scene& scene,
                    const BuildContext& context) {
  const auto& load = body.prescribed_acceleration;
  if (!load || load->angular_amplitude == core::Vec3<double>{}) return;
  if (rigid && scene.contact.enable) return;
  const std::optional<Node> at = node.child("PrescribedAcceleration");
  if (!at) return;
  at->report(context.diagnostics, "arx",
             rigid ? "turns rigid bodies in contact only: set Contact enable to 1, or arx, ary, arz to 0"
                   : "angular accelerations turn rigid bodies only: set arx, ary, arz to 0");
}

/// The mass and inertia of a rigid body are those of its motion, which contact changes.
void check_inertia(const core::BodyInput& body, const Node& node, bool rigid, const core::Scene& scene,
                   const BuildContext& context) {
  const std::optional<Node> at = node.child("RigidInertia");
  if (!at) return;
  if (!rigid || !scene.contact.enable)
    at->report(context.diagnostics, "has an effect on a rigid body in contact only");
  else if (body.prescribed_velocity || body.constrain_rigid_position)
    at->report(context.diagnostics, "has no effect on a rigid body whose motion is prescribed");
  if (!body.rigid_inertia->tensor) return;
  const core::Vec3<double> principal = core::principal_values(*body.rigid_inertia->tensor);
  constexpr double flat = 1 + 1e-9;  // a plate reaches the sum up to the digits that the input has
  if (principal.z <= 0)
    at->report(context.diagnostics,
               fmt::format("the tensor of inertia must be positive definite; its principal moments are "
                           "{:.6g}, {:.6g}, {:.6g}",
                           principal.x, principal.y, principal.z));
  else if (principal.x > flat * (principal.y + principal.z))
    at->report(context.diagnostics,
               fmt::format("no body has this tensor of inertia: of its principal moments {:.6g}, {:.6g}, "
                           "{:.6g} the largest exceeds the sum of the others",
                           principal.x, principal.y, principal.z));
}

/// A rigid body acts on others through contact only: in a single velocity field it would exert no force, so
/// it may not be combined with deformable bodies.
void check_rigid(const std::vector<core::BodyInput*>& bodies, const std::vector<Node>& nodes,
                 const core::Scene& scene, const BuildContext& context) {
  const auto takes_part = [](const core::BodyInput& b) { return !b.deactivated && !b.for_bool; };
  const auto rigid = [&](const core::BodyInput& b) {
    return b.material < scene.materials.size() && core::is_rigid(scene.materials[b.material]);
  };
  const core::BodyInput* deformable = nullptr;
  for (const core::BodyInput* b : bodies)
    if (takes_part(*b) && !rigid(*b)) deformable = deformable == nullptr ? b : deformable;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (takes_part(*bodies[i])) {
      check_rotation(*bodies[i], nodes[i], rigid(*bodies[i]), scene, context);
      check_inertia(*bodies[i], nodes[i], rigid(*bodies[i]), scene, context);
    }
    if (!takes_part(*bodies[i]) || !rigid(*bodies[i])) continue;
    for (const Node& load : nodes[i].children("Traction"))
      load.report(context.diagnostics, "has no effect on a rigid body; use PrescribedAcceleration");
    check_rigid_expressions(*bodies[i], nodes[i], context);
    // The nodes of implicit steps follow a rigid body's motion (core/implicit/node_unknowns.hpp).
    const bool implicit = scene.solution.integration == core::Integration::implicit;
    if (deformable == nullptr || scene.contact.enable || implicit) continue;
    nodes[i].report(
        context.diagnostics, "material",
        fmt::format(
            "a rigid body acts on others only through contact, which is off: it "
            "would pass through '{}' without exerting a force. Set Contact enable to 1, give the "
            "body a deformable material, "
            "with PrescribedVelocity where its motion is known (such a body pushes with its stiffness), or "
            "remove it; a scene of rigid bodies only is accepted",
            deformable->name));
  }
}

/// The bounds of the volume must contain the one at the start, or the first step would change it.
void check_volume_bounds(const core::BodyInput& body, const Node& node, const core::Scene& scene,
                         const BuildContext& context) {
  const core::MaterialInput& material = scene.materials[body.material];
  const core::VolumeInput& bounds = scene.solution.volume;
  const double start = material.reference_density / body.density;
  if (bounds.min.value_or(1) > 1 || bounds.max.value_or(1) < 1) return;  // reported already
  if (core::is_rigid(material) || body.deactivated || body.for_bool) return;
  if (start < bounds.min.value_or(start) || start > bounds.max.value_or(start))
    node.report(context.diagnostics, "density",
                fmt::format("body '{}' starts with {:.6g} of its volume at reference density, outside of "
                            "Volume {}: change density, or min and max",
                            body.name, start, start < bounds.min.value_or(0) ? "min" : "max"));
}

core::BodyInput build_body(const Node& node, const core::Scene& scene, const BuildContext& context) {
  core::BodyInput body;
  body.name = node.word("name");
  body.source = context.at(node);
  body.type = node.type();
  const auto material = resolve(node, "material", "material", names_of(scene.materials), context);
  body.material = material.value_or(0);
  body.density = material ? scene.materials[*material].reference_density : NAN;
  if (const auto density = node.given_real("density")) body.density = *density;
  body.work_plane = resolve(node, "workPlane", "work plane", names_of(scene.work_planes), context);
  const std::optional<Node> control = node.child("BodyContrl");
  body.deactivated = node.boolean("Deactive") || (control && control->boolean("Deactive"));
  body.no_output = control && control->boolean("NoOutput");
  body.for_bool = node.boolean("ForBoolBody");
  if (const std::optional<Node> geometry = node.child("Geometry"))
    body.geometry = build_geometry(*geometry, context);
  build_loads(body, node, context);
  check_held(body, node, context);
  if (material) check_volume_bounds(body, node, scene, context);
  return body;
}

/// Finds bodies by name in constant time.
class BodyNames {
 public:
  explicit BodyNames(const std::vector<core::ComponentInput>& components) {
    for (std::size_t c = 0; c < components.size(); ++c)
      for (std::size_t b = 0; b < components[c].bodies.size(); ++b)
        places_.emplace(components[c].bodies[b].name, core::BodyPlace{c, b});
  }

  /// The body that an attribute names; if there is none, reports a fault and returns an invalid place.
  core::BodyPlace resolve(const Node& node, std::string_view attribute, const BuildContext& context) {
    const std::string name = node.word(attribute);
    if (name.empty()) return {};
    if (const auto found = places_.find(name); found != places_.end()) return found->second;
    constexpr int most_suggestions = 20;  // each searches all names
    std::vector<std::string_view> names;
    if (suggestions_++ < most_suggestions)
      for (const auto& [known, place] : places_) names.emplace_back(known);
    std::ranges::sort(names);
    node.report(context.diagnostics, attribute,
                fmt::format("there is no body of this name{}", did_you_mean(name, names)));
    return {};
  }

 private:
  std::unordered_map<std::string, core::BodyPlace> places_;
  int suggestions_ = 0;
};

}  // namespace

std::vector<core::WorkPlane> build_work_planes(const Node& root, const BuildContext& context) {
  std::vector<core::WorkPlane> planes;
  const std::vector<Node> nodes = root.children("WorkPlane");
  check_unique_names(nodes, "work plane", context);
  for (const Node& node : nodes) planes.push_back(build_work_plane(node, context));
  return planes;
}

std::vector<core::ComponentInput> build_components(const Node& root, const core::Scene& scene,
                                                   const BuildContext& context) {
  std::vector<core::ComponentInput> components;
  const std::vector<Node> nodes = root.children("Component");
  check_unique_names(nodes, "component", context);
  std::vector<Node> body_nodes;
  for (const Node& node : nodes) {
    core::ComponentInput component{
        node.word("name"), node.real("normal_vector_weight"), {}, context.at(node)};
    for (const Node& body : node.children("Body")) {
      component.bodies.push_back(build_body(body, scene, context));
      body_nodes.push_back(body);
    }
    components.push_back(std::move(component));
  }
  check_unique_names(body_nodes, "body", context);
  std::vector<core::BodyInput*> bodies;
  for (core::ComponentInput& component : components)
    for (core::BodyInput& body : component.bodies) bodies.push_back(&body);
  BodyNames names(components);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i]->type == "Bool")
      bodies[i]->geometry = core::BoolGeometry{names.resolve(body_nodes[i], "BoolBodyA", context),
                                               names.resolve(body_nodes[i], "BoolBodyB", context)};
  check_rigid(bodies, body_nodes, scene, context);
  return components;
}

std::vector<core::DetonationItem> build_detonations(const Node& root, const BuildContext& context) {
  std::vector<core::DetonationItem> items;
  for (const Node& detonation : root.children("Detonation")) {
    for (const Node& node : detonation.children("Item")) {
      core::DetonationItem item;
      item.time = node.real("time");
      item.source = context.at(node);
      if (node.type() == "plane") {
        item.kind = core::DetonationItem::Kind::plane;
        item.normal = node.small_integer("normal");
        item.location = node.real("location");
        item.lower = {node.real("left"), node.real("bottom")};
        item.upper = {node.real("right"), node.real("top")};
        if (item.upper[0] < item.lower[0])
          node.report(context.diagnostics, "right", "expected at least left");
        if (item.upper[1] < item.lower[1])
          node.report(context.diagnostics, "top", "expected at least bottom");
      } else if (node.type() == "point") {
        item.position = node.reals("x", "y", "z");
      }
      items.push_back(std::move(item));
    }
  }
  return items;
}

}  // namespace mpm::io
