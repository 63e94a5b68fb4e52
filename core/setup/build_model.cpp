#include "core/setup/build_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <unistd.h>

#include "core/discretise/seeds.hpp"
#include "core/discretise/shape_check.hpp"
#include "core/scene/limits.hpp"
#include "core/setup/first_step.hpp"
#include "core/setup/memory.hpp"
#include "core/step/conduction.hpp"
#include "core/step/migration.hpp"
#include "core/step/passes.hpp"
#include "core/step/speeds.hpp"
#include "core/step/totals.hpp"
#include "core/threads.hpp"

namespace mpm::core {

namespace {

constexpr std::uint64_t units_in_run = 16;       // of a body, next to each other, that one rank makes
constexpr std::size_t seeds_in_piece = 1 << 14;  // seeds that a rank makes between two sends

/// This rank's share of a body's units, in pieces: f(seeds). Every ranks-th run of units is ours.
template <class F>
void for_each_piece(const SeedSource& source, int rank, int ranks, F f) {
  const std::uint64_t units = source.units();
  const auto stride = units_in_run * static_cast<std::uint64_t>(ranks);
  std::vector<Seed> seeds;
  for (std::uint64_t first = units_in_run * static_cast<std::uint64_t>(rank); first < units;
       first += stride) {
    for (std::uint64_t u = first; u < std::min(first + units_in_run, units); ++u) {
      source.generate(u, u + 1, seeds);
      if (seeds.size() < seeds_in_piece) continue;
      f(seeds);
      seeds.clear();
    }
  }
  if (!seeds.empty()) f(seeds);
}

void fill_columns(const ColumnLayout& layout, const Body& body, const BodyInput& input, const Seed& seed,
                  double identity, std::vector<double>& columns) {
  columns.assign(static_cast<std::size_t>(layout.columns()), 0.0);
  const auto set = [&](Column c, double v) {
    columns[static_cast<std::size_t>(layout.offset(c) / block_lanes)] = v;
  };
  for (int a = 0; a < 3; ++a) {
    set(next(Column::position_x, a), seed.position[static_cast<std::size_t>(a)]);
    const double v = body.prescribed_velocity ? (*body.prescribed_velocity)[a]
                                              : input.initial_velocity[static_cast<std::size_t>(a)];
    set(next(Column::velocity_x, a), v);
  }
  set(Column::mass, seed.mass);
  set(Column::volume, seed.volume);
  set(Column::identity, identity);
  if (input.initial_temperature && layout.has(Column::temperature))
    set(Column::temperature, *input.initial_temperature);
}

/// Counts per brick and per body, and the first seed outside the grid in words.
struct Census {
  std::map<BrickKey, std::int64_t> bricks;
  std::vector<std::int64_t> bodies;  ///< of all particles, outside the grid too
  std::int64_t block_bytes = 0;  ///< of the blocks that hold them: in every brick of every body, full but one
  std::int64_t outside = 0;
  std::string first_outside;
};

/// Without a model only those outside the grid are counted.
Census take_census(const GridGeometry& geometry, const std::vector<std::unique_ptr<SeedSource>>& sources,
                   const std::vector<const BodyInput*>& inputs, const Exchange& exchange,
                   const Model* model) {
  Census census;
  census.bodies.resize(sources.size());
  std::map<BrickKey, std::int64_t> bricks;  // of one body
  for (std::size_t b = 0; b < sources.size(); ++b) {
    bricks.clear();
    for_each_piece(*sources[b], exchange.rank(), exchange.size(), [&](const std::vector<Seed>& seeds) {
      census.bodies[b] += static_cast<std::int64_t>(seeds.size());
      for (const Seed& s : seeds) {
        const Vec3<double> x{s.position[0], s.position[1], s.position[2]};
        if (geometry.contains(x)) {
          if (model != nullptr) ++bricks[key_of(geometry.brick_at(x))];
          continue;
        }
        ++census.outside;
        if (census.first_outside.empty()) {
          census.first_outside =
              fmt::format("{}:{}: <Body name=\"{}\">: a particle at ({:.6g}, {:.6g}, {:.6g})",
                          inputs[b]->source.file, inputs[b]->source.line, inputs[b]->name, x.x, x.y, x.z);
        }
      }
    });
    if (model == nullptr) continue;
    const auto block =
        static_cast<std::int64_t>(sizeof(double)) * model->bodies[b].pool->layout().block_doubles();
    for (const auto& [key, n] : bricks) {
      census.bricks[key] += n;
      census.block_bytes += (n + block_lanes - 1) / block_lanes * block;
    }
  }
  return census;
}

void refuse_outside(const Scene& scene, const GridGeometry& g, const Census& census, Exchange& exchange) {
  std::int64_t outside[1] = {census.outside};
  exchange.sum(std::span<std::int64_t>(outside));
  if (outside[0] == 0) return;
  std::string first;
  for (const std::string& line : exchange.gather(census.first_outside)) {
    if (first.empty()) first = line;
  }
  throw InputErrors(
      scene.grid.source, "Grid",
      fmt::format("{} particles lie outside the grid [{:.6g}, {:.6g}] x [{:.6g}, {:.6g}] x [{:.6g}, {:.6g}]; "
                  "enlarge the grid or move the body. The first: {}",
                  outside[0], g.origin.x, g.origin.x + double(g.cells[0]) * g.cell.x, g.origin.y,
                  g.origin.y + double(g.cells[1]) * g.cell.y, g.origin.z,
                  g.origin.z + double(g.cells[2]) * g.cell.z, first));
}

/// Of the bodies that were too large to be tried before (shape_check.hpp).
void refuse_empty(const Scene& scene, const Census& census, const std::vector<const BodyInput*>& inputs,
                  Exchange& exchange) {
  std::vector<std::int64_t> particles = census.bodies;
  exchange.sum(std::span<std::int64_t>(particles));
  Complaints wrong;
  for (std::size_t b = 0; b < inputs.size(); ++b)
    if (particles[b] == 0) wrong.add(no_particles(scene, *inputs[b]));
  wrong.raise_if_any();
}

/// The sources of all bodies; throws every complaint about any of them.
std::vector<std::unique_ptr<SeedSource>> sources_of(const Scene& scene,
                                                    const std::vector<const BodyInput*>& inputs) {
  Complaints wrong;
  std::vector<std::unique_ptr<SeedSource>> sources;
  for (const BodyInput* input : inputs)
    wrong.collect([&] { sources.push_back(make_seed_source(scene, *input)); });
  wrong.raise_if_any();
  return sources;
}

/// Throws InputErrors where the bodies' identities together cannot be numbered; names the largest body.
void refuse_uncounted(const std::vector<std::unique_ptr<SeedSource>>& sources,
                      const std::vector<const BodyInput*>& inputs) {
  double identities = 0, particles = 0;
  std::size_t largest = 0;
  for (std::size_t b = 0; b < sources.size(); ++b) {
    identities += static_cast<double>(sources[b]->identities());
    particles += sources[b]->expected_particles();
    if (sources[b]->identities() > sources[largest]->identities()) largest = b;
  }
  if (identities < static_cast<double>(identity_limit)) return;
  throw InputErrors(
      inputs[largest]->source, "Body",
      fmt::format(
          "the lattices of the bodies, body `{}`'s above all, have {} places to number, more than can "
          "be told apart (2^53), for about {:.3g} particles; use a larger dp",
          inputs[largest]->name,
          sources[largest]->identities() >= identity_limit ? "at least 9.01e+15"
                                                           : fmt::format("{:.3g}", identities),
          particles));
}

/// Throws InputErrors on every rank if one of them needs more bytes than it can have. `reserved`: of these,
/// what has its addresses already and is not filled yet.
void refuse_above(double needed, double reserved, const ModelPlan& plan, const Model& model,
                  Exchange& exchange) {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  const std::vector<std::string> hosts = exchange.gather(host);
  const auto here = std::count(hosts.begin(), hosts.end(), std::string(host));
  const double free =
      std::min(available_memory() / static_cast<double>(here), address_space_left() + reserved);
  double shortest[3] = {free - needed, -needed, free};
  exchange.minimum(shortest);
  if (shortest[0] >= 0) return;
  throw InputErrors(
      model.scene->components.front().source, "Component",
      fmt::format("about {:.3g} particles need {:.3g} GiB per rank, but only {:.3g} GiB are free; "
                  "use a larger dp or more machines",
                  plan.particles, -shortest[1] / 1073741824.0, shortest[2] / 1073741824.0));
}

void refuse_too_large(const Model& model, const ModelPlan& plan, Exchange& exchange) {
  // Particles, and half as much again for nodes and what is on its way.
  refuse_above(1.5 * plan.state_bytes / exchange.size(), 0, plan, model, exchange);
}

/// Once it is known which bricks are whose: with what the nodes need, too.
void refuse_too_large(const Model& model, const ModelPlan& plan, const Census& census, Exchange& exchange) {
  std::int64_t bytes[1] = {census.block_bytes};
  exchange.sum(std::span<std::int64_t>(bytes));
  // Of the particles, some are on their way to their bricks; of what bodies take, the input is there already.
  const auto particles = static_cast<double>(bytes[0]);
  const double under_way = std::min(16.0 * (1 << 20), particles);
  const MemoryNeed need = memory_need(model);
  refuse_above(particles / exchange.size() + under_way + need.bricks + 0.5 * need.bodies, need.bricks, plan,
               model, exchange);
}

void deal_out(Model& model, const std::vector<std::unique_ptr<SeedSource>>& sources,
              const std::vector<const BodyInput*>& inputs, Exchange& exchange) {
  std::vector<int> columns_of;
  for (const Body& b : model.bodies) columns_of.push_back(b.pool->layout().columns());
  double base = 0;
  for (std::size_t b = 0; b < sources.size(); ++b) {
    const Body& body = model.bodies[b];
    const ColumnLayout& layout = body.pool->layout();
    Travellers travellers;
    std::vector<double> columns;
    const auto send = [&] {
      exchange.scatter(*model.grid, travellers, columns_of);
      insert_travellers(model, travellers);
      travellers.clear();
    };
    for_each_piece(*sources[b], exchange.rank(), exchange.size(), [&](const std::vector<Seed>& seeds) {
      for (const Seed& s : seeds) {
        fill_columns(layout, body, *inputs[b], s, base + static_cast<double>(s.identity), columns);
        const BrickCoord to = model.grid->geometry().brick_at({s.position[0], s.position[1], s.position[2]});
        travellers.add(to, static_cast<int>(b), columns.data(), layout.columns());
      }
      exchange.any(true);
      send();
    });
    // The others may have more pieces than we: keep receiving until all are through.
    while (exchange.any(false)) send();
    base += static_cast<double>(sources[b]->identities());
  }
  model.next_identity = static_cast<std::uint64_t>(base);
}

/// Cohorts in the order of cells and, within a cell, of identities, however they arrived.
void settle(Model& model) {
  BrickGrid& grid = *model.grid;
  for_each_by_threads(0, grid.owned(), 4, [&](int s) {
    Brick& brick = grid.brick(static_cast<Slot>(s));
    for (Cohort& cohort : brick.cohorts) {
      BlockPool& pool = *model.bodies[static_cast<std::size_t>(cohort.body)].pool;
      sort_by_identity(pool, cohort);
      sort_by_cell(grid, brick.coord, pool, cohort);
    }
  });
}

/// f(batch) for every batch of this rank's particles, with positions, masses and volumes in place.
template <class F>
void for_each_batch(Model& model, F f) {
  BrickGrid& grid = *model.grid;
  for (int s = 0; s < grid.owned(); ++s) {
    for (const Cohort& cohort : grid.brick(static_cast<Slot>(s)).cohorts) {
      Body& body = model.bodies[static_cast<std::size_t>(cohort.body)];
      for (std::size_t first = 0; first < cohort.blocks.size(); first += batch_blocks) {
        Batch batch{};
        batch.layout = &body.pool->layout();
        batch.cell_size = grid.geometry().smallest_cell();
        batch.grid = &grid.geometry();
        batch.blocks = static_cast<int>(std::min<std::size_t>(batch_blocks, cohort.blocks.size() - first));
        batch.particles =
            static_cast<int>(std::min<std::size_t>(batch_particles, cohort.count - block_lanes * first));
        for (int b = 0; b < batch.blocks; ++b)
          batch.block[b] = body.pool->block(cohort.blocks[first + static_cast<std::size_t>(b)]);
        f(body, batch);
      }
    }
  }
}

}  // namespace

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
      throw InputErrors(
          scene.grid.source, "Grid",
          fmt::format("{} cells along {} are more than the {} that a grid may have; use larger cells",
                      axis.cells, "xyz"[a], most_cells_per_axis));
    }
  }
  g.mass_cutoff = scene.grid.mass_cutoff * density * g.cell_volume();
  return g;
}

bool made_of_bars(const Geometry& geometry) {
  return std::holds_alternative<BarMeshGeometry>(geometry) ||
         std::holds_alternative<BarLinesGeometry>(geometry) ||
         std::holds_alternative<BarNetGeometry>(geometry);
}

namespace {

void refuse_bar_material(const Scene& scene, const BodyInput& input, const ConstitutiveModel& material) {
  if (!material.uniaxial() || made_of_bars(input.geometry)) return;
  throw InputErrors(input.source, "Body",
                    fmt::format("material `{}` is for bars, and body `{}` of type \"{}\" has none: give it a "
                                "material without _1D",
                                scene.materials[input.material].name, input.name, input.type));
}

void refuse_temperature(const BodyInput& input, const ConstitutiveModel& material) {
  if (!input.initial_temperature || material.columns({}).has(Column::temperature)) return;
  throw InputErrors(
      input.source, "InitialTemperature",
      fmt::format("material `{}` of body `{}` carries no temperature: give it SpecHeat and a law "
                  "that heats, CoefficientOfThermalConductivity or TemperatureCoefficient, or "
                  "leave InitialTemperature out",
                  material.name(), input.name));
}

}  // namespace

Model prepare_model(std::shared_ptr<const Scene> scene,
                    std::vector<std::unique_ptr<ConstitutiveModel>> materials,
                    const ColumnSet& output_columns) {
  Model model;
  model.scene = scene;
  model.materials = std::move(materials);
  const SolutionInput& solution = scene->solution;
  model.options.volume_update = static_cast<int>(solution.volume.update);
  model.options.volume_min = solution.volume.min.value_or(0);
  model.options.volume_max = solution.volume.max.value_or(0);
  model.options.viscosity_in_wave_speed = !solution.time_step.ignore_viscosity;
  model.options.keep_strain =
      solution.volume.update == VolumeUpdate::accumulated_strain || output_columns.has(Column::strain_xx);
  const bool conducts =
      std::ranges::any_of(model.materials, [](const auto& material) { return material->conductivity() > 0; });
  model.grid = std::make_unique<BrickGrid>(geometry_of(*scene), node_block_of(*scene),
                                           node_arrays_of(*scene, conducts));
  BlockPools pools;
  for_each_active_body(*scene, [&](int component, const BodyInput& input) {
    Body body;
    body.name = input.name;
    body.component = component;
    body.material = static_cast<int>(input.material);
    body.model = model.materials[input.material].get();
    body.rigid = body.model->rigid();
    refuse_bar_material(*scene, input, *body.model);
    refuse_temperature(input, *body.model);
    body.no_output = input.no_output;
    if (input.prescribed_velocity) { body.prescribed_velocity = to_vec(*input.prescribed_velocity); }
    ColumnSet columns = ColumnSet::mechanics();
    columns.add(body.model->columns(model.options));
    columns.add(output_columns);
    columns.add(transfer_columns(*scene));
    if (std::ranges::find(model.grid->geometry().boundary, Boundary::nonreflecting) !=
        model.grid->geometry().boundary.end())
      columns.add(Column::sound_speed);  // of the dashpots there
    body.pool = pools.of(columns);
    model.bodies.push_back(std::move(body));
  });
  model.books.body_eroded.resize(model.bodies.size());
  model.books.body_left.resize(model.bodies.size());
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

namespace {

using Sources = std::vector<std::unique_ptr<SeedSource>>;

constexpr std::uint64_t most_units = 1 << 16;  // of a body, that may be empty before the first with particles

/// A few particles of a body, whose first state is like that of all others.
std::vector<Seed> sample_of(const SeedSource& source) {
  constexpr std::size_t few = 8;
  std::vector<Seed> seeds;
  for (std::uint64_t u = 0; u < std::min(source.units(), most_units) && seeds.empty(); ++u)
    source.generate(u, u + 1, seeds);
  seeds.resize(std::min(seeds.size(), few));
  return seeds;
}

/// Starts a model of the samples alone, which throws what the start of a run would.
void check_start(Model model, const std::vector<const BodyInput*>& inputs,
                 const std::vector<std::vector<Seed>>& samples) {
  const GridGeometry& geometry = model.grid->geometry();
  std::vector<BrickCount> counts;
  Travellers travellers;
  std::vector<double> columns;
  for (std::size_t b = 0; b < samples.size(); ++b) {
    const ColumnLayout& layout = model.bodies[b].pool->layout();
    for (const Seed& s : samples[b]) {
      const Vec3<double> x{s.position[0], s.position[1], s.position[2]};
      if (!geometry.contains(x)) continue;
      fill_columns(layout, model.bodies[b], *inputs[b], s, static_cast<double>(s.identity), columns);
      counts.push_back({geometry.brick_at(x), 1});
      travellers.add(counts.back().brick, static_cast<int>(b), columns.data(), layout.columns());
    }
  }
  SoloExchange alone;
  alone.partition(*model.grid, counts, {});
  insert_travellers(model, travellers);
  settle(model);
  start_clock(model, alone);
}

}  // namespace

double check_setup(std::shared_ptr<const Scene> scene,
                   std::vector<std::unique_ptr<ConstitutiveModel>> materials,
                   const ColumnSet& output_columns) {
  Complaints wrong;
  const std::vector<const BodyInput*> inputs = active_bodies(*scene);
  Sources sources;
  double particles = 0;
  for (const BodyInput* input : inputs) {
    wrong.collect([&] { refuse_bar_material(*scene, *input, *materials[input->material]); });
    wrong.collect([&] { refuse_temperature(*input, *materials[input->material]); });
    wrong.collect([&] {
      sources.push_back(make_seed_source(*scene, *input));
      particles += sources.back()->expected_particles();
    });
  }
  wrong.raise_if_any();
  refuse_uncounted(sources, inputs);
  const GridGeometry geometry = geometry_of(*scene);
  // Whose box is inside has no particle outside; of the others every particle is looked at, in a few seconds.
  constexpr double most_looked_at = 1 << 30;
  std::vector<std::vector<Seed>> samples;
  Sources doubtful;
  std::vector<const BodyInput*> owners;
  for (std::size_t b = 0; b < sources.size(); ++b) {
    samples.push_back(sample_of(*sources[b]));
    if (samples.back().empty() && sources[b]->units() <= most_units)
      wrong.add(no_particles(*scene, *inputs[b]));
    const auto [lower, upper] = sources[b]->bounds();
    const bool inside = geometry.contains({lower[0], lower[1], lower[2]}) &&
                        geometry.contains({upper[0], upper[1], upper[2]});
    if (inside || sources[b]->expected_particles() > most_looked_at) continue;
    doubtful.push_back(std::move(sources[b]));
    owners.push_back(inputs[b]);
  }
  wrong.raise_if_any();
  SoloExchange alone;
  refuse_outside(*scene, geometry, take_census(geometry, doubtful, owners, alone, nullptr), alone);
  check_start(prepare_model(scene, std::move(materials), output_columns), inputs, samples);
  return particles;
}

void discretise(Model& model, Exchange& exchange) {
  const std::vector<const BodyInput*> inputs = active_bodies(*model.scene);
  const std::vector<std::unique_ptr<SeedSource>> sources = sources_of(*model.scene, inputs);
  refuse_uncounted(sources, inputs);
  const ModelPlan plan = plan_of(model);
  refuse_too_large(model, plan, exchange);
  const GridGeometry& geometry = model.grid->geometry();
  const Census census = take_census(geometry, sources, inputs, exchange, &model);
  refuse_empty(*model.scene, census, inputs, exchange);
  refuse_outside(*model.scene, geometry, census, exchange);
  std::vector<BrickCount> counts;
  for (const auto& [key, n] : census.bricks) counts.push_back({brick_of_key(key), n});
  exchange.partition(*model.grid, counts, model.scene->decomposition);
  refuse_too_large(model, plan, census, exchange);
  deal_out(model, sources, inputs, exchange);
  settle(model);
  arrange_blocks(model);
}

void start_clock(Model& model, Exchange& exchange) {
  Fastest fastest;
  for_each_batch(model, [&](Body& body, Batch& batch) {
    body.model->initialise(batch, model.options);
    for (int i = 0; i < batch.particles; ++i)
      fastest.offer(static_cast<int>(&body - model.bodies.data()), batch, i);
  });
  refuse_undefined(model, exchange);
  double critical[1] = {std::min(critical_step(*model.grid, fastest.speed), conduction_step(model))};
  exchange.minimum(critical);
  model.clock.critical_dt = model.clock.first_critical_dt = critical[0];
  refuse_endless(model, fastest, exchange);
  const Totals totals = compute_totals(model, exchange);
  model.initial_energy = totals.kinetic + totals.internal;
  if (!std::isfinite(model.initial_energy)) {
    throw InputErrors(
        model.scene->components.front().source, "Component",
        "the energies of all particles together are beyond the range of numbers: check the units");
  }
}

}  // namespace mpm::core
