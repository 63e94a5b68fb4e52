#include "core/setup/prepare_model.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "core/contact/component_contact.hpp"
#include "core/discretise/seeds.hpp"
#include "core/expressions/formula.hpp"
#include "core/implicit/time_rule.hpp"
#include "core/scene/limits.hpp"
#include "core/step/passes.hpp"
#include "core/step/speeds.hpp"

namespace mpm::core {

GridGeometry geometry_of(const Scene& scene) {
  GridGeometry g;
  double density = 0;
  for (const MaterialInput& m : scene.materials)
    density += m.reference_density / static_cast<double>(scene.materials.size());
  for (int a = 0; a < 3; ++a) {
    const GridAxis& axis = scene.grid.axes[static_cast<std::size_t>(a)];
    g.origin[a] = axis.min;
    g.cell[a] = axis.cell_size;
    g.inverse_cell[a] = 1 / axis.cell_size;
    g.cells[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(axis.cells);
    g.boundary[static_cast<std::size_t>(2 * a)] = axis.lower;
    g.boundary[static_cast<std::size_t>(2 * a + 1)] = axis.upper;
    if (static_cast<std::int64_t>(axis.cells) > most_cells_per_axis) {
      throw InputErrors(scene.grid.source, "Grid",
                        fmt::format("{} cells along {} exceed the limit of {} per axis; use larger cells",
                                    axis.cells, "xyz"[a], most_cells_per_axis));
    }
  }
  g.site = site_of(scene);
  g.mass_cutoff = scene.grid.mass_cutoff * density * g.cell_volume();
  return g;
}

namespace {

bool made_of_bars(const Geometry& geometry) {
  return std::holds_alternative<BarMeshGeometry>(geometry) ||
         std::holds_alternative<BarLinesGeometry>(geometry) ||
         std::holds_alternative<BarNetGeometry>(geometry);
}

void refuse_bar_material(const Scene& scene, const BodyInput& input, const ConstitutiveModel& material) {
  if (!material.uniaxial() || made_of_bars(input.geometry)) return;
  throw InputErrors(
      input.source, "Body",
      fmt::format(
          "material `{}` is for bars only, but body `{}` is of type \"{}\": give it a material without _1D",
          scene.materials[input.material].name, input.name, input.type));
}

void refuse_temperature(const BodyInput& input, const ConstitutiveModel& material) {
  if (!input.initial_temperature || material.columns({}).has(Column::temperature)) return;
  throw InputErrors(
      input.source, "InitialTemperature",
      fmt::format("material `{}` of body `{}` has no temperature: give it SpecHeat and a law with heating, "
                  "CoefficientOfThermalConductivity or TemperatureCoefficient, or remove InitialTemperature",
                  material.name(), input.name));
}

/// The components of the initial position that expressions of the run use.
ColumnSet columns_of_expressions(const BodyInput& input) {
  ColumnSet columns;
  const auto add = [&](const Expressions& expressions) {
    for (const Expression& e : expressions) {
      const VariableSet uses = Formula::check(e.text).uses;
      for (int a = 0; a < 3; ++a)
        if (uses[static_cast<std::size_t>(3 + a)]) columns.add(next(Column::first_x, a));
    }
  };
  add(input.prescribed_velocity_expressions);
  if (input.body_force) add(input.body_force->expressions);
  return columns;
}

/// Implicit steps need the derivative of the stress, and move rigid bodies as the input says.
void refuse_implicit(const Scene& scene, const BodyInput& input, const ConstitutiveModel& material) {
  if (scene.solution.integration != Integration::implicit) return;
  if (material.rigid()) {
    if (input.prescribed_velocity || input.constrain_rigid_position) return;
    throw InputErrors(
        input.source, "Body",
        fmt::format("rigid body '{}' has no prescribed motion: with implicit steps give it a velocity "
                    "(vx, vy, vz with PrescribedVelocity; 0 0 0 holds it)",
                    input.name));
  }
  const auto refuse = [&](std::string_view why) {
    throw InputErrors(input.source, "Body",
                      fmt::format("material '{}' of body '{}' is not available with implicit steps: {}",
                                  material.name(), input.name, why));
  };
  const auto& implicit = scene.solution.implicit;
  if (material.columns({}).has(Column::burn_fraction))
    refuse("explosives burn in explicit steps alone; remove Solution@Integration");
  const bool fluid = !material.uniaxial() && !(material.initial_shear_speed() > 0);
  if (implicit && implicit->quasistatic() && fluid)
    refuse(
        "without stiffness in shear nothing decides where it is at rest; use Implicit@type \"dynamic\" "
        "or \"semi\"");
  if (material.conductivity() > 0)
    refuse(
        "heat is conducted in explicit steps alone; set CoefficientOfThermalConductivity to 0, or remove "
        "Solution@Integration");
  if (implicit && implicit->difference_tangent) return;
  const std::string fault = material.tangent_fault();
  if (!fault.empty())
    refuse(fault + ". Implicit@jacobian \"differences\" takes its derivatives by differences");
}

}  // namespace

void check_material_of(const Scene& scene, const BodyInput& input, const ConstitutiveModel& material) {
  ErrorList wrong;
  wrong.collect([&] { refuse_bar_material(scene, input, material); });
  wrong.collect([&] { refuse_temperature(input, material); });
  wrong.collect([&] { refuse_implicit(scene, input, material); });
  wrong.raise_if_any();
}

Model prepare_model(std::shared_ptr<const Scene> scene,
                    std::vector<std::unique_ptr<ConstitutiveModel>> materials,
                    const ColumnSet& output_columns) {
  Model model;
  model.scene = scene;
  model.materials = std::move(materials);
  const SolutionInput& solution = scene->solution;
  model.scheme = solution.scheme;
  model.options.volume_update = static_cast<int>(solution.volume.update);
  model.options.volume_min = solution.volume.min.value_or(0);
  model.options.volume_max = solution.volume.max.value_or(0);
  if (solution.integration == Integration::implicit) {
    // Exact for steps of any size; the artificial viscosity is a remedy of explicit shocks.
    model.options.volume_update = static_cast<int>(VolumeUpdate::mid_point);
    model.options.artificial_viscosity = false;
  }
  model.options.tension_weight = tension_weight(*scene, model.scheme);
  model.options.viscosity_in_wave_speed = !solution.time_step.ignore_viscosity;
  model.options.keep_strain =
      solution.volume.update == VolumeUpdate::accumulated_strain || output_columns.has(Column::strain_xx);
  const bool conducts =
      std::ranges::any_of(model.materials, [](const auto& material) { return material->conductivity() > 0; });
  model.grid = std::make_unique<BrickGrid>(geometry_of(*scene), node_block_of(*scene),
                                           node_arrays_of(*scene, model.scheme, conducts));
  const bool lags = solution.integration == Integration::implicit &&
                    TimeRule::lags(solution.implicit.value_or(ImplicitInput{}));
  BlockPools pools;
  for_each_active_body(*scene, [&](int component, const BodyInput& input) {
    Body body;
    body.name = input.name;
    body.component = component;
    body.material = static_cast<int>(input.material);
    body.model = model.materials[input.material].get();
    body.rigid = body.model->rigid();
    check_material_of(*scene, input, *body.model);
    body.no_output = input.no_output;
    body.prescribed_velocity = input.prescribed_velocity;
    ColumnSet columns = ColumnSet::mechanics();
    columns.add(body.model->columns(model.options));
    columns.add(output_columns);
    columns.add(shape_columns(*scene));
    columns.add(transfer_columns(*scene));
    if (lags && !body.rigid) columns.add_range(Column::acceleration_lag_x, 3);
    if (std::ranges::find(model.grid->geometry().boundary, Boundary::nonreflecting) !=
        model.grid->geometry().boundary.end())
      columns.add(Column::sound_speed);  // for the dashpots there
    columns.add(columns_of_expressions(input));
    body.pool = pools.of(columns);
    body.inertia_given = input.rigid_inertia && input.rigid_inertia->tensor;
    if (has_reaction(*scene, input))
      model.reactions.push_back(
          {static_cast<int>(model.bodies.size()), body.rigid && scene->contact.enable, {}});
    model.bodies.push_back(std::move(body));
  });
  model.ledger.body_eroded.resize(model.bodies.size());
  model.ledger.body_left.resize(model.bodies.size());
  return model;
}

ModelPlan plan_of(const Model& model) {
  ModelPlan plan;
  std::size_t b = 0;
  const int common = ColumnSet::mechanics().size();
  for_each_active_body(*model.scene, [&](int, const BodyInput& input) {
    const ColumnLayout& layout = model.bodies[b++].pool->layout();
    BodyPlan body;
    body.name = input.name;
    body.expected_particles = make_seed_source(*model.scene, input)->expected_particles();
    body.bytes_per_particle = layout.bytes_per_particle();
    for (int c = common; c < column_count; ++c) {
      if (layout.has(static_cast<Column>(c))) body.columns.push_back(name_of(static_cast<Column>(c)));
    }
    plan.particles += body.expected_particles;
    plan.state_bytes += body.expected_particles * body.bytes_per_particle;
    plan.bodies.push_back(std::move(body));
  });
  return plan;
}

}  // namespace mpm::core
