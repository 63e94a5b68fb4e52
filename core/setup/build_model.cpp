#include "core/setup/build_model.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <unistd.h>

#include "core/setup/memory.hpp"
#include "core/setup/particle_creation.hpp"
#include "core/setup/prepare_model.hpp"
#include "core/setup/start.hpp"

namespace mpm::core {

namespace {

/// Throws InputErrors on every rank if one of them needs more bytes than are available. `reserved`: the part
/// that has addresses but is not filled yet.
void refuse_above(double needed, double reserved, const ModelPlan& plan, const Model& model,
                  Reductions& ranks) {
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  const std::vector<std::string> hosts = ranks.gather(host);
  const auto here = std::count(hosts.begin(), hosts.end(), std::string(host));
  const double free =
      std::min(available_memory() / static_cast<double>(here), address_space_left() + reserved);
  if (ranks.smallest(free - needed) >= 0) return;
  const double most_needed = ranks.largest(needed), least_free = ranks.smallest(free);
  throw InputErrors(
      model.scene->components.front().source, "Component",
      fmt::format("about {:.3g} particles need {:.3g} GiB per rank, but only {:.3g} GiB are free; "
                  "use a larger dp or more machines",
                  plan.particles, most_needed / 1073741824.0, least_free / 1073741824.0));
}

void refuse_too_large(const Model& model, const ModelPlan& plan, Reductions& ranks) {
  // Particles, and half as much again for nodes and buffers.
  refuse_above(1.5 * plan.state_bytes / ranks.size(), 0, plan, model, ranks);
}

/// After the partition, with the memory of the nodes.
void refuse_too_large(const Model& model, const ModelPlan& plan, const SeedCount& count, Reductions& ranks) {
  std::int64_t bytes[1] = {count.block_bytes};
  ranks.sum(std::span<std::int64_t>(bytes));
  // Some of the particles are still in send buffers; of the bodies' memory, the input is already allocated.
  const auto particles = static_cast<double>(bytes[0]);
  const double under_way = std::min(16.0 * (1 << 20), particles);
  const MemoryNeed need = memory_need(model);
  refuse_above(particles / ranks.size() + under_way + need.bricks + 0.5 * need.bodies, need.bricks, plan,
               model, ranks);
}

/// Counts the bodies' particles and rejects numbers that exceed the limits. Collective.
SeedCount count_checked(const Model& model, std::span<const BodySeeds> seeds, Reductions& ranks) {
  const GridGeometry& geometry = model.grid->geometry();
  SeedCount count = count_seeds(geometry, seeds, ranks);
  refuse_empty(*model.scene, seeds, count, ranks);
  refuse_outside(*model.scene, geometry, count, ranks);
  refuse_undefined_velocities(seeds, model.next_identity, model.clock.time, ranks);
  return count;
}

}  // namespace

void build_model(Model& model, Communication& communication) {
  std::vector<std::size_t> all(model.bodies.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::vector<BodySeeds> seeds = seeds_of(model, all);
  refuse_uncounted(seeds, 0);
  const ModelPlan plan = plan_of(model);
  refuse_too_large(model, plan, communication);
  const SeedCount count = count_checked(model, seeds, communication);
  communication.bricks.partition(*model.grid, count.in_bricks(), model.scene->decomposition);
  refuse_too_large(model, plan, count, communication);
  create_particles(model, seeds, communication);
  start_run(model, communication);
}

void add_bodies(Model& model, std::span<const std::size_t> bodies, Communication& communication) {
  if (bodies.empty()) return;
  const std::vector<BodySeeds> seeds = seeds_of(model, bodies);
  refuse_uncounted(seeds, model.next_identity);
  const SeedCount count = count_checked(model, seeds, communication);
  std::vector<BrickCoord> wanted;
  for (const auto& [key, n] : count.bricks) wanted.push_back(brick_of_key(key));
  communication.bricks.activate(*model.grid, wanted);
  refuse_too_large(model, plan_of(model), count, communication);
  create_particles(model, seeds, communication);
  start_bodies(model, bodies, communication);
}

}  // namespace mpm::core
