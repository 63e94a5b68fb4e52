// Integration, contact and output.

#include <algorithm>

#include <fmt/format.h>

#include "core/built.hpp"
#include "core/contact/component_contact.hpp"
#include "core/step/passes.hpp"
#include "io/input/build.hpp"
#include "io/input/contact_words.hpp"

namespace mpm::io {

core::FixedLayer build_fixed_layer(const Node& node, const BuildContext& context) {
  const core::FixedLayer layer{node.small_integer("FixedDirection"), node.small_integer("Normal"),
                               node.real("Min"), node.real("Max")};
  if (layer.max < layer.min)
    node.report(context.diagnostics, "Max", fmt::format("expected at least Min, {}", layer.min));
  return layer;
}

core::ContactInput build_contact(const Node& root) {
  core::ContactInput contact;
  const std::optional<Node> node = root.child("Contact");
  if (!node) return contact;
  contact.enable = node->boolean("enable");
  contact.failed_to_component = node->boolean("failure_to_component");
  contact.automatic_weights = node->boolean("auto_normal_vector_weight");
  contact.ignore_failed_normals = node->boolean("normal_vector_excluding_failure_particle");
  contact.distance = static_cast<core::ContactInput::Distance>(node->small_integer("distance_type"));
  contact.min_distance = node->real("min_distance");
  contact.limits_time_step = node->boolean("contact_time_step");
  contact.method = static_cast<core::ContactInput::Method>(node->small_integer("contact_type"));
  contact.record_force = node->boolean("record_contact_force");
  const auto normal = std::ranges::find(contact_normals, node->word("contact_normal"));
  if (normal != contact_normals.end())
    contact.normal = static_cast<core::ContactInput::Normal>(normal - contact_normals.begin());
  return contact;
}

namespace {

core::Scheme scheme(std::string_view word) {
  if (word == "USF") return core::Scheme::usf;
  if (word == "USL") return core::Scheme::usl;
  if (word == "USAVG") return core::Scheme::usavg;
  return core::Scheme::musl;
}

core::Transfer transfer(std::string_view word) {
  if (word == "PIC") return core::Transfer::pic;
  if (word == "APIC") return core::Transfer::apic;
  if (word == "TPIC") return core::Transfer::tpic;
  if (word == "AFLIP") return core::Transfer::aflip;
  if (word == "XPIC") return core::Transfer::xpic;
  if (word == "FMPM") return core::Transfer::fmpm;
  return core::Transfer::flip;
}

core::TimeStepInput build_time_step(const Node& node) {
  return {node.real("factor"), node.boolean("const"), node.real("specified"),
          node.boolean("NotConsiderVisForCp")};
}

core::VolumeInput build_volume(const Node& node, const BuildContext& context) {
  core::VolumeInput volume;
  volume.update = static_cast<core::VolumeUpdate>(node.small_integer("update_type"));
  volume.erode = node.given_real("erode");
  volume.min = node.given_real("min");
  volume.max = node.given_real("max");
  if (volume.min && *volume.min > 1)
    node.report(context.diagnostics, "min", "expected at most 1, the volume at reference density");
  if (volume.max && *volume.max < 1)
    node.report(context.diagnostics, "max", "expected at least 1, the volume at reference density");
  if (volume.min && volume.max && *volume.max <= *volume.min)
    node.report(context.diagnostics, "max", fmt::format("expected more than min, {}", *volume.min));
  return volume;
}

void build_averaging(const Node& node, const BuildContext& context, core::SolutionInput& solution) {
  if (node.word("averaging") == "none") return;
  solution.averaging = core::VolumeAveraging::cell;
  solution.pressure_relaxation = node.real("relaxation");
  if (solution.pressure_relaxation > 0 && solution.integration == core::Integration::implicit)
    node.report(context.diagnostics, "relaxation", "is not available with implicit steps: expected 0");
  if (solution.volume.update == core::VolumeUpdate::cell)
    node.report(context.diagnostics, "averaging",
                "does not go with <Volume update_type=\"1\">, which takes the volume change from the cell's "
                "nodes: expected none, or another update_type");
}

core::WarnInput build_warn(const Node& node) {
  const std::vector<std::string> types = node.words("type");
  const auto watched = [&](std::string_view word) { return std::ranges::find(types, word) != types.end(); };
  return {watched("ie"), watched("vol"), watched("grid"),
          static_cast<core::WarnInput::Level>(node.small_integer("level"))};
}

core::ImplicitInput build_implicit(const Node& node, const BuildContext& context) {
  core::ImplicitInput implicit;
  if (node.type() == "quasistatic") implicit.type = core::ImplicitType::quasistatic;
  if (node.type() == "semi") implicit.type = core::ImplicitType::semi;
  if (node.word("rule") == "backward_euler") implicit.rule = core::ImplicitRule::backward_euler;
  if (node.word("rule") == "generalised_alpha") implicit.rule = core::ImplicitRule::generalised_alpha;
  implicit.spectral_radius = node.real("spectral_radius");
  implicit.newmark_beta = node.real("newmark_beta");
  implicit.newmark_gamma = node.real("newmark_gamma");
  implicit.time_step = node.given_real("time_step");
  implicit.min_step = node.given_real("min_step");
  implicit.max_step = node.given_real("max_step");
  implicit.relative_tolerance = node.real("rtol");
  implicit.absolute_tolerance = node.given_real("atol");
  implicit.max_newton = node.small_integer("max_newton");
  implicit.gravity_ramp = node.given_real("gravity_ramp").value_or(0);
  implicit.matrix_free = node.word("jacobian") == "matrixfree";
  implicit.difference_tangent = node.word("jacobian") == "differences";
  implicit.stabilisation = node.real("stabilisation");
  if (4 * implicit.newmark_beta < 2 * implicit.newmark_gamma - 1e-12)
    node.report(context.diagnostics, "newmark_beta",
                fmt::format("steps are stable without limit only from half of newmark_gamma, {}",
                            0.5 * implicit.newmark_gamma));
  if (implicit.min_step && implicit.time_step && *implicit.time_step < *implicit.min_step)
    node.report(context.diagnostics, "time_step",
                fmt::format("expected at least min_step, {}", *implicit.min_step));
  if (implicit.time_step && implicit.max_step && *implicit.max_step < *implicit.time_step)
    node.report(context.diagnostics, "max_step",
                fmt::format("expected at least time_step, {}", *implicit.time_step));
  if (implicit.min_step && implicit.max_step && *implicit.max_step < *implicit.min_step)
    node.report(context.diagnostics, "max_step",
                fmt::format("expected at least min_step, {}", *implicit.min_step));
  return implicit;
}

core::FemInput build_fem(const Node& node, const BuildContext& context) {
  core::FemInput fem;
  fem.couple_with_particles = node.boolean("CoupleFEM_MPM");
  fem.contact = node.boolean("FEMContact");
  for (const Node& wall : node.children("RigidWall")) {
    const int direction = wall.small_integer("RigidnDir");
    fem.rigid_walls.push_back({std::abs(direction) - 1, direction > 0, wall.real("RigidCoor")});
  }
  if (const auto hourglass = node.child("Hourglass"))
    fem.hourglass = {hourglass->small_integer("HGMethod"), hourglass->real("Qhg")};
  for (const Node& layer : node.children("GlobalBoundaryCond"))
    fem.fixed_layers.push_back(build_fixed_layer(layer, context));
  return fem;
}

/// What the consistent mass matrix does not go with.
void check_mass(const Node& node, const core::Scene& scene, const BuildContext& context) {
  const core::SolutionInput& solution = scene.solution;
  if (solution.mass != core::MassMatrix::consistent) return;
  const auto refuse = [&](std::string why) { node.report(context.diagnostics, "mass", std::move(why)); };
  if (solution.transfer != core::Transfer::flip)
    refuse(fmt::format("is available only with transfer FLIP, not with {}: expected lumped, or transfer FLIP",
                       node.word("transfer")));
  else if (solution.flip_fraction != 1)
    refuse("is available only with the whole of FLIP: expected lumped, or flip_fraction 1");
  if (!core::consistent_mass_goes_with(scene.grid.shape))
    refuse(
        "is not available with CPDI and CPDI2, whose domains tangle at the surface of a fluid: expected "
        "lumped, or another shape function");
  if (solution.scheme == core::Scheme::usl)
    refuse(
        "is not available with algorithm USL, whose strains would gain energy at light nodes: expected "
        "lumped, or algorithm MUSL, USAVG or USF");
  if (solution.integration == core::Integration::implicit)
    refuse("is not available with implicit steps, which have lumped masses: expected lumped");
}

}  // namespace

void check_method(const Node& root, const core::Scene& scene, const BuildContext& context) {
  using enum core::ShapeFunction;
  const core::ShapeFunction shape = scene.grid.shape;
  const core::Transfer transfer = scene.solution.transfer;
  const std::optional<Node> solution = root.child("Solution"), grid = root.child("Grid");
  if (solution && core::is_affine(transfer) && !core::affine_transfers_go_with(shape)) {
    solution->report(context.diagnostics, "transfer",
                     "is not available with this shape function: expected shape QuadraticBSpline, "
                     "CubicBSpline, uGIMP or cpGIMP");
  }
  if (solution) check_mass(*solution, scene, context);
  if (!grid || (shape != contiguous_particle_gimp && shape != cpdi && shape != cpdi2)) return;
  for (const core::ComponentInput& component : scene.components) {
    for (const core::BodyInput& body : component.bodies) {
      const auto* sphere = std::get_if<core::SphereGeometry>(&body.geometry);
      if (sphere != nullptr && sphere->layout == core::Layout::polar)
        grid->report(context.diagnostics, "shape",
                     fmt::format("body '{}' has spherical shells of particles, whose domains are not boxes "
                                 "along the axes: use uGIMP, or discretization 0",
                                 body.name));
    }
  }
}

core::SolutionInput build_solution(const Node& root, const BuildContext& context) {
  core::SolutionInput solution;
  const std::optional<Node> node = root.child("Solution");
  if (!node) return solution;
  solution.source = context.at(*node);
  solution.scheme = scheme(node->word("algorithm"));
  solution.automatic_scheme = node->word("algorithm") == "auto";
  solution.near_boundary_stop = node->boolean("near_boundary_stop");
  if (node->word("Integration") == "impl") solution.integration = core::Integration::implicit;
  solution.transfer = transfer(node->word("transfer"));
  solution.flip_fraction = node->real("flip_fraction");
  if (solution.flip_fraction != 1 && solution.transfer != core::Transfer::flip)
    node->report(context.diagnostics, "flip_fraction",
                 fmt::format("is available only with transfer FLIP, not with {}", node->word("transfer")));
  if (node->word("mass") == "consistent") solution.mass = core::MassMatrix::consistent;
  if (!core::built_corrections) {
    const auto require = [&](std::string_view attribute, std::string_view value, std::string_view other) {
      node->report(
          context.diagnostics, attribute,
          fmt::format("this program was built without {}: expected {}, or a program built with the CMake "
                      "option -DMPM_CORRECTIONS=ON",
                      value, other));
    };
    if (core::is_corrected(solution.transfer))
      require("transfer", node->word("transfer"), "another transfer");
    if (solution.mass != core::MassMatrix::lumped) require("mass", "the consistent mass matrix", "lumped");
  }
  solution.xpic_order = node->small_integer("xpic_order");
  solution.xpic_interval = node->small_integer("xpic_interval");
  const auto value_of = [&](std::string_view child, std::string_view attribute) -> std::optional<double> {
    const std::optional<Node> found = node->child(child);
    return found ? found->given_real(attribute) : std::nullopt;
  };
  solution.end_time = value_of("EndTime", "value").value_or(0);
  if (const auto step = node->child("TimeStep")) solution.time_step = build_time_step(*step);
  solution.limit_velocity = value_of("LimitVelocity", "max");
  if (const auto volume = node->child("Volume")) solution.volume = build_volume(*volume, context);
  if (const auto volumetric = node->child("Volumetric")) build_averaging(*volumetric, context, solution);
  if (const auto warn = node->child("Warn")) solution.warn = build_warn(*warn);
  solution.energy_fraction = value_of("EnergyFraction", "value");
  solution.damping = value_of("DynamicRelax", "damping").value_or(0);
  if (const auto gravity = node->child("Gravity")) solution.gravity = gravity->reals("ax", "ay", "az");
  if (const auto implicit = node->child("Implicit")) solution.implicit = build_implicit(*implicit, context);
  if (const auto fem = node->child("FEMSetting")) solution.fem = build_fem(*fem, context);
  if (const auto threads = node->child("OpenMPSetting")) solution.threads = threads->small_integer("nthread");
  return solution;
}

namespace {

core::PostProcessingInput build_post_processing(const Node& node) {
  using Post = core::PostProcessingInput;
  Post post;
  post.time_interval = node.real("time_interval");
  post.h5part = node.boolean("h5part");
  post.vtk = static_cast<Post::Vtk>(node.small_integer("vtk_data"));
  post.tecplot = node.boolean("tecplot");
  post.cell_result = node.boolean("cellresult");
  post.grid_data = static_cast<Post::GridData>(node.small_integer("OutGridData"));
  post.fragments = node.boolean("StaFragSize");
  post.fragments_time_interval = node.given_real("StaFragTimeInterval");
  post.variables = node.words("var");
  return post;
}

/// The bodies of a history, whose variables are `force` and `moment`.
void build_body_history(core::TimeHistoryInput& history, const Node& node, const core::Scene& scene,
                        const BuildContext& context) {
  history.force = std::erase(history.variables, "force") > 0;
  history.moment = std::erase(history.variables, "moment") > 0;
  const std::vector<const core::BodyInput*> bodies = core::active_bodies(scene);
  std::vector<std::string_view> names;
  for (const core::BodyInput* body : bodies) names.emplace_back(body->name);
  for (const Node& of : node.children("Body")) {
    const std::optional<std::size_t> body = resolve(of, "name", "body", names, context);
    if (body && std::ranges::find(history.bodies, names[*body]) != history.bodies.end()) {
      of.report(context.diagnostics, "name", "this TimeHistory has this body already: remove one of the two");
      continue;
    }
    if (!body || bodies[*body]->material >= scene.materials.size()) continue;
    if (!core::has_reaction(scene, *bodies[*body]))
      of.report(context.diagnostics, "name",
                "force and moment are those of rigid bodies in contact and of bodies with a prescribed "
                "velocity; this body is neither");
    history.bodies.emplace_back(names[*body]);
  }
  const bool asks = history.force || history.moment;
  if (asks != !node.children("Body").empty())
    node.report(context.diagnostics, asks
                                         ? "force and moment are variables of a <Body>: expected at least one"
                                         : "the variables of a <Body> are force and moment");
  if (asks && history.variables.empty() && !(history.particles.empty() && history.points.empty()))
    node.report(context.diagnostics,
                "force and moment are variables of a <Body>: a <Particle> or <Point> "
                "needs another");
}

core::TimeHistoryInput build_history(const Node& node, const core::Scene& scene,
                                     const BuildContext& context) {
  core::TimeHistoryInput history{node.words("var"), {}, {}, context.at(node), false, false, {}};
  for (const Node& place : node.children("Particle")) history.particles.push_back(place.reals("x", "y", "z"));
  for (const Node& place : node.children("Point")) history.points.push_back(place.reals("x", "y", "z"));
  build_body_history(history, node, scene, context);
  if (!history.variables.empty() && history.particles.empty() && history.points.empty())
    node.report(context.diagnostics, "expected at least one <Particle> or <Point>");
  return history;
}

std::optional<core::LineInput> build_line(const std::optional<Node>& node) {
  if (!node) return {};
  return core::LineInput{node->small_integer("normal"), node->real("x"), node->real("y")};
}

}  // namespace

core::OutputInput build_output(const Node& root, const core::Scene& scene, const BuildContext& context) {
  const double end_time = scene.solution.end_time;
  core::OutputInput output;
  output.console.print_time = end_time / 100;
  const std::optional<Node> node = root.child("Output");
  if (!node) return output;
  if (const auto console = node->child("Console")) {
    output.console.print_time = console->given_real("print_time").value_or(end_time / 100);
    output.console.print_momentum = console->boolean("print_momentum");
  }
  if (const auto post = node->child("PostProcessing")) output.post_processing = build_post_processing(*post);
  for (const Node& history : node->children("TimeHistory"))
    output.histories.push_back(build_history(history, scene, context));
  output.grid_line = build_line(node->child("GridLineResults"));
  output.fem_profile = build_line(node->child("FEMProfileResults"));
  if (const auto restart = node->child("Restart"))
    output.restart_interval = restart->given_real("time_interval");
  if (const auto statistics = node->child("Statistics"))
    output.statistics = {statistics->boolean("memory"), statistics->boolean("cell_occupy")};
  if (const auto summary = node->child("Summary")) output.summary = summary->boolean("enable");
  return output;
}

}  // namespace mpm::io
