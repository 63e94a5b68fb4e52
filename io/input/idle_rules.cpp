#include "io/input/idle_rules.hpp"

#include <algorithm>
#include <iterator>
#include <string>

#include "core/contact/component_contact.hpp"
#include "io/input/idle_places.hpp"

namespace mpm::io {

namespace {

using core::MaterialInput;
using core::Scene;
using Place = SettingPlace;

bool gaps_at_nodes(const Place& at) {
  return at.scene.contact.enable && at.scene.contact.distance == core::ContactInput::Distance::shared_node;
}
bool gaps_without_limit(const Place& at) {
  return at.scene.contact.enable && !gaps_at_nodes(at) && !at.scene.contact.measures_gaps();
}
const MaterialInput& material_of(const Scene& scene, const core::BodyInput& body) {
  return scene.materials[body.material];
}

bool unused_plane(const Place& at) {
  const std::string name = at.node.word("name");
  return !any_body(at.scene, [&](const core::BodyInput& body) {
    return body.work_plane && at.scene.work_planes[*body.work_plane].name == name;
  });
}

bool nothing_fails(const Place& at) {
  return at.scene.contact.enable && !any_body(at.scene, [&](const core::BodyInput& body) {
           return can_fail(material_of(at.scene, body));
         });
}

/// No particle joins the failed component, which damage suffices for.
bool nothing_joins(const Place& at) {
  return nothing_fails(at) && !any_body(at.scene, [&](const core::BodyInput& body) {
           return has_damage(material_of(at.scene, body).strength);
         });
}

bool operand(const Place& at) { return at.body->for_bool; }

bool nothing_explodes(const Place& at) {
  return !any_body(at.scene, [&](const core::BodyInput& body) {
    const core::LawInput& law = material_of(at.scene, body).strength;
    return law.type == "HighExpBurn" && law.value_or("beta", 2) != 1;
  });
}

bool no_free_face(const Place& at) { return !at.scene.grid.has_face(core::Boundary::free); }

bool all_rigid(const Place& at) {
  return !any_body(at.scene,
                   [&](const core::BodyInput& body) { return !core::is_rigid(material_of(at.scene, body)); });
}

bool no_pictures(const Place& at) {
  const auto& post = at.scene.output.post_processing;
  return !post || (!post->h5part && post->vtk == core::PostProcessingInput::Vtk::none);
}

/// Bodies take part, but none of them is written.
bool all_unseen(const Place& at) {
  const std::vector<const core::BodyInput*> bodies = core::active_bodies(at.scene);
  return !no_pictures(at) && !bodies.empty() && std::ranges::all_of(bodies, &core::BodyInput::no_output);
}

bool outside_grid(const Place& at) {
  constexpr const char* coordinates[] = {"x", "y", "z"};
  for (std::size_t a = 0; a < 3; ++a) {
    const core::GridAxis& axis = at.scene.grid.axes[a];
    const double x = at.node.real(coordinates[a]);
    if (x < axis.min || x > axis.max) return true;
  }
  return false;
}

bool steps_are_explicit(const Place& at) { return !steps_are_implicit(at); }
bool is_quasistatic(const Place& at) {
  return steps_are_implicit(at) && at.scene.solution.implicit && at.scene.solution.implicit->quasistatic();
}
/// A velocity given at the start, which quasi-static steps do not read.
bool velocity_is_lost(const Place& at) {
  return is_quasistatic(at) && !operand(at) && !at.body->prescribed_velocity &&
         !at.body->constrain_rigid_position;
}
bool step_is_given(const Place& at) {
  const core::TimeStepInput& step = at.scene.solution.time_step;
  return at.scene.contact.enable && !steps_are_implicit(at) && (step.specified > 0 || step.constant);
}

bool has_free_rigid(const Place& at) {
  return at.scene.contact.enable && any_body(at.scene, [&](const core::BodyInput& body) {
           return core::is_rigid(material_of(at.scene, body)) && !body.prescribed_velocity &&
                  !body.constrain_rigid_position;
         });
}
/// No two components have these two materials.
bool never_meet(const Place& at) {
  const auto has = [&](const core::ComponentInput& component, std::string_view material) {
    return std::ranges::any_of(component.bodies, [&](const core::BodyInput& body) {
      return material_of(at.scene, body).name == material;
    });
  };
  const std::string first = at.node.word("mat1"), second = at.node.word("mat2");
  for (const core::ComponentInput& one : at.scene.components)
    for (const core::ComponentInput& other : at.scene.components)
      if (&one != &other && has(one, first) && has(other, second)) return false;
  return true;
}
bool has_box(const Node& node) {
  constexpr const char* faces[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  return std::ranges::any_of(faces, [&](const char* face) { return node.find(face) != nullptr; });
}
/// Its first row is after the end of the run.
template <class Points>
bool begins_late(const Place& at, const Points& points) {
  return !points.empty() && points.front().time >= at.scene.solution.end_time;
}

std::vector<IdleRule> rules_of_the_run() {
  static constexpr std::string_view no_contact = "used only by Contact, which is off";
  static constexpr std::string_view no_weights =
      "with contact_normal=\"regression\" the particles of both bodies give the normal";
  static constexpr std::string_view no_part = "an operand of Bool bodies takes no part in the run";
  return {
      {"Solution/Implicit", {}, steps_are_explicit, "used only with Integration=\"impl\""},
      {"Solution/Implicit",
       {"newmark_beta", "newmark_gamma"},
       [](const Place& at) {
         const core::ImplicitInput& input = *at.scene.solution.implicit;
         return input.type != core::ImplicitType::dynamic || input.rule != core::ImplicitRule::newmark;
       },
       "used only by Newmark's rule of dynamic problems"},
      {"Solution/Implicit",
       {"spectral_radius"},
       [](const Place& at) {
         const core::ImplicitInput& input = *at.scene.solution.implicit;
         return input.type != core::ImplicitType::dynamic ||
                input.rule != core::ImplicitRule::generalised_alpha;
       },
       "used only by rule=\"generalised_alpha\" of dynamic problems"},
      {"Solution/Implicit",
       {"rule"},
       [](const Place& at) { return at.scene.solution.implicit->type != core::ImplicitType::dynamic; },
       "used only by type=\"dynamic\""},
      {"Solution/Implicit",
       {"max_newton", "atol"},
       [](const Place& at) { return at.scene.solution.implicit->linearised(); },
       "type=\"semi\" solves one linear system per step, to rtol"},
      {"Solution/Implicit",
       {"gravity_ramp"},
       [](const Place& at) { return at.scene.solution.gravity == core::Vec3<double>{}; },
       "there is no Gravity"},
      {"Solution/TimeStep", {}, steps_are_implicit, "implicit steps take their length from Implicit"},
      {"Friction", {}, contact_is_off, no_contact},
      {"Friction/Coefficient",
       {},
       [](const Place& at) { return !contact_is_off(at) && never_meet(at); },
       "no two components have these materials"},
      {"WorkPlane", {}, unused_plane, "no body uses this work plane"},
      {"Component", {"normal_vector_weight"}, contact_is_off, no_contact},
      {"Component", {"normal_vector_weight"}, regression, no_weights},
      {"Component",
       {"normal_vector_weight"},
       [](const Place& at) {
         return at.scene.contact.enable && at.scene.contact.automatic_weights && !regression(at);
       },
       "auto_normal_vector_weight=\"1\" gives the weights"},
      {"Contact",
       {"auto_normal_vector_weight", "normal_vector_excluding_failure_particle"},
       regression,
       no_weights},
      {"Contact",
       {"distance_type"},
       gaps_without_limit,
       "without min_distance bodies touch at all nodes that both reach, up to two cells apart; give "
       "min_distance=\"0.5\" with distance_type 1, 0.05 with 2"},
      {"Contact",
       {"failure_to_component"},
       nothing_joins,
       "no body has a material that can fail; give it a FailureModel"},
      {"Contact",
       {"normal_vector_excluding_failure_particle"},
       [](const Place& at) { return nothing_fails(at) && !regression(at); },
       "no body has a material that can fail"},
      {"Contact", {"contact_time_step"}, step_is_given, "TimeStep specified or const decides the step"},
      {"Contact", {"min_distance"}, gaps_at_nodes, "used only with distance_type=\"1\" or \"2\""},
      {"Component/Body",
       {"ForBoolBody"},
       [](const Place& at) { return operand(at) && !at.operands->contains(at.body); },
       "no Bool body uses this body, and it takes no part in the run"},
      {"Component/Body", {"density"}, operand, "the density of the Bool body applies"},
      {"Component/Body/InitialVelocity", {}, operand, no_part},
      {"Component/Body/InitialTemperature", {}, operand, no_part},
      {"Component/Body/PrescribedVelocity", {}, operand, no_part},
      {"Component/Body/PrescribedAcceleration", {}, operand, no_part},
      {"Component/Body/HarmExcit", {}, operand, no_part},
      {"Component/Body/BodyForce", {}, operand, no_part},
      {"Component/Body/Traction", {}, operand, no_part},
      {"Component/Body/RigidInertia", {}, operand, no_part},
      {"Component/Body/ConstrainRigidPosition", {}, operand, no_part},
      {"Component/Body/BodyContrl", {}, operand, no_part},
      {"Component/Body/InitialVelocity",
       {"vx", "vy", "vz"},
       [](const Place& at) { return at.body->prescribed_velocity.has_value(); },
       "PrescribedVelocity replaces it from the start"},
      {"Component/Body/InitialVelocity",
       {"vx", "vy", "vz"},
       velocity_is_lost,
       "quasi-static steps have no inertia"},
      {"Component/Body/PrescribedAcceleration/Coefficient",
       {"crx", "cry", "crz"},
       [](const Place& at) {
         return at.body->prescribed_acceleration->angular_amplitude == core::Vec3<double>{};
       },
       "multiplies arx, ary, arz, which are 0"},
      {"Component/Body/PrescribedAcceleration",
       {},
       [](const Place& at) {
         return !operand(at) && begins_late(at, at.body->prescribed_acceleration->points);
       },
       "its first Coefficient is after EndTime"},
      {"Component/Body/HarmExcit/EndTime",
       {},
       [](const Place& at) {
         return !operand(at) && at.node.real("x") < 0 && at.node.real("y") < 0 && at.node.real("z") < 0;
       },
       "the load ends before the run starts"},
      {"Component/Body/Traction",
       {"ramp"},
       [](const Place& at) { return !has_box(at.node); },
       "without a box there is no face across which the load falls to zero"},
      {"Component/Body/ConstrainRigidPosition",
       {},
       [](const Place& at) { return !at.body->constrain_rigid_position; },
       "0 is equivalent to omitting the element: a rigid body follows PrescribedVelocity, or without it "
       "moves freely"},
      {"Component/Body/BodyContrl", {"NoOutput"}, no_pictures, "no PostProcessing writes particles"},
      {"Detonation", {}, nothing_explodes, "no body has a HighExpBurn material with beta 0 or 2"},
      {"Detonation/Item",
       {"time"},
       [](const Place& at) { return at.node.real("time") >= at.scene.solution.end_time; },
       "the run ends before"},
      {"Grid/Cell/MovingGrid",
       {"*"},
       [](const Place& at) { return !at.scene.grid.moving.enable; },
       "MovingGrid is off"},
      {"Grid/DynamicCell",
       {"enable", "clear_steps"},
       [](const Place&) { return true; },
       "only cells with particles are stored in any case"},
      {"Contact", {"*"}, contact_is_off, "Contact is off"},
      {"Solution",
       {"near_boundary_stop"},
       no_free_face,
       "applies only to grid faces with boundary=\"0\", and there are none"},
      {"Solution",
       {"xpic_order", "xpic_interval"},
       [](const Place& at) { return !core::is_corrected(at.scene.solution.transfer); },
       "used only with transfer XPIC and FMPM"},
      {"Solution",
       {"mass"},
       [](const Place& at) {
         return at.scene.solution.mass == core::MassMatrix::consistent && all_rigid(at);
       },
       "it does not apply to rigid bodies"},
      {"Solution/TimeStep",
       {"factor", "const", "NotConsiderVisForCp"},
       [](const Place& at) { return at.scene.solution.time_step.specified > 0; },
       "the specified step is used instead"},
      {"Solution/Volume", {}, all_rigid, "rigid bodies keep their volume"},
      {"Solution/LimitVelocity", {}, all_rigid, "it does not apply to rigid bodies"},
      {"Solution/Volumetric", {"averaging"}, all_rigid, "rigid bodies keep their volume"},
      {"Solution/Volumetric",
       {"relaxation"},
       [](const Place& at) { return at.scene.solution.averaging == core::VolumeAveraging::none; },
       "used only with averaging=\"cell\""},
      {"Solution/DynamicRelax",
       {},
       [](const Place& at) { return all_rigid(at) && !has_free_rigid(at); },
       "it applies to deformable bodies, and with Contact to free rigid ones"},
      {"Solution/DynamicRelax",
       {},
       [](const Place& at) { return is_quasistatic(at) && !all_rigid(at); },
       "quasi-static steps have no velocities to damp"},
      {"Solution/OpenMPSetting",
       {"directionofdecomposition"},
       [](const Place&) { return true; },
       "bricks of cells are shared among the threads"},
      {"Output/PostProcessing", {}, no_pictures, "neither h5part nor vtk_data requests a file"},
      {"Output/PostProcessing", {}, all_unseen, "every body has NoOutput: its files have no particles"},
      {"Output/TimeHistory/Point", {}, outside_grid, "the point is outside of the grid: its columns are 0"},
      {"Output/Restart",
       {},
       [](const Place& at) { return *at.scene.output.restart_interval > at.scene.solution.end_time; },
       "the interval is longer than the run: no restart file is written at intervals"},
      {"Output/Summary", {"enable"}, [](const Place&) { return true; }, "Job.summary.json is always written"},
      {"DomainDecomposition",
       {"dimension0", "dimension1", "dimension2"},
       [](const Place& at) { return at.scene.decomposition.method == core::PartitionMethod::metis; },
       "method metis does not use them, except that their product must be the number of ranks"},
  };
}

}  // namespace

const std::vector<IdleRule>& idle_rules() {
  static const std::vector<IdleRule> table = [] {
    std::vector<IdleRule> all = idle_rules_of_materials();
    std::ranges::copy(rules_of_the_run(), std::back_inserter(all));
    return all;
  }();
  return table;
}

}  // namespace mpm::io
