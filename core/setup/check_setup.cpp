#include "core/setup/check_setup.hpp"

#include <algorithm>

#include "core/communication/solo.hpp"
#include "core/discretise/shape_check.hpp"
#include "core/particles/tile_order.hpp"
#include "core/setup/particle_creation.hpp"
#include "core/setup/prepare_model.hpp"
#include "core/setup/start.hpp"

namespace mpm::core {

namespace {

constexpr std::uint64_t most_units =
    1 << 16;  // units of a body that may be empty before the first with particles
constexpr double most_looked_at = 1 << 30;  // particles, each of which is created to be checked

/// A few particles of a body, whose initial state is like that of all others.
std::vector<Seed> sample_of(const SeedSource& source) {
  constexpr std::size_t few = 8;
  std::vector<Seed> seeds;
  for (std::uint64_t u = 0; u < std::min(source.units(), most_units) && seeds.empty(); ++u)
    source.generate(u, u + 1, seeds);
  seeds.resize(std::min(seeds.size(), few));
  return seeds;
}

/// Initialises a model of the samples alone, which throws the errors of a run's start.
void check_start(Model model, const std::vector<const BodyInput*>& inputs,
                 const std::vector<std::vector<Seed>>& samples) {
  const GridGeometry& geometry = model.grid->geometry();
  std::vector<BrickCount> counts;
  MigrationBuffer particles;
  std::vector<double> columns;
  for (std::size_t b = 0; b < samples.size(); ++b) {
    const ColumnLayout& layout = model.bodies[b].pool->layout();
    StartVelocity velocity(*inputs[b], model.clock.time);
    for (const Seed& s : samples[b]) {
      const Vec3<double>& x = s.position;
      if (!geometry.contains(x)) continue;
      fill_columns(layout, *inputs[b], velocity, s, static_cast<double>(s.identity), columns);
      counts.push_back({geometry.brick_at(x), 1});
      particles.add(counts.back().brick, static_cast<int>(b), columns.data(), layout.columns());
    }
  }
  SoloCommunication alone;
  alone.bricks.partition(*model.grid, counts, {});
  insert_particles(model, particles);
  sort_tiles(model);
  start_run(model, alone);
}

}  // namespace

double check_setup(std::shared_ptr<const Scene> scene,
                   std::vector<std::unique_ptr<ConstitutiveModel>> materials,
                   const ColumnSet& output_columns) {
  ErrorList wrong;
  const std::vector<const BodyInput*> inputs = active_bodies(*scene);
  std::vector<BodySeeds> bodies;
  double particles = 0;
  for (const BodyInput* input : inputs) {
    wrong.collect([&] { check_material_of(*scene, *input, *materials[input->material]); });
    wrong.collect([&] {
      bodies.push_back({bodies.size(), input, make_seed_source(*scene, *input), 0});
      particles += bodies.back().source->expected_particles();
    });
  }
  wrong.raise_if_any();
  refuse_uncounted(bodies, 0);
  SoloCommunication alone;
  if (particles <= most_looked_at) refuse_undefined_velocities(bodies, 0, 0, alone);
  const GridGeometry geometry = geometry_of(*scene);
  // A body whose box is inside has no particle outside; for the others every particle is checked.
  std::vector<std::vector<Seed>> samples;
  std::vector<BodySeeds> doubtful;
  for (BodySeeds& body : bodies) {
    samples.push_back(sample_of(*body.source));
    if (samples.back().empty() && body.source->units() <= most_units)
      wrong.add(no_particles(*scene, *body.input));
    const auto [lower, upper] = body.source->bounds();
    const bool inside = geometry.contains(lower) && geometry.contains(upper);
    if (inside || body.source->expected_particles() > most_looked_at) continue;
    doubtful.push_back(std::move(body));
  }
  wrong.raise_if_any();
  refuse_outside(*scene, geometry, count_seeds(geometry, doubtful, alone.reductions), alone);
  check_start(prepare_model(scene, std::move(materials), output_columns), inputs, samples);
  return particles;
}

}  // namespace mpm::core
