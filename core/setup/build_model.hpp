// From a checked scene to a rank's model: bodies, bricks, particles with their first state.
//
// Every rank makes its own share of every body's particles, twice: once to count them per brick, so that the
// bricks can be dealt out, and once to send each particle to the rank that owns its brick. No rank ever holds
// more than its share and a buffer of fixed size.
#pragma once

#include <memory>
#include <vector>

#include "core/model.hpp"
#include "core/step/exchange.hpp"

namespace mpm::core {

struct BodyPlan {
  std::string name;
  double expected_particles = 0;
  double bytes_per_particle = 0;
  std::vector<std::string_view> columns;  ///< beyond what every particle carries
};

/// What a scene will need, before anything is allocated.
struct ModelPlan {
  std::vector<BodyPlan> bodies;
  double particles = 0;
  double state_bytes = 0;  ///< all ranks
};

/// What the set-up refuses for reasons that stand in the input, found without making the particles but a few
/// of each body: bodies outside the grid, more particles than can be numbered, materials for bars, too many
/// cells, a first state that no run can start from. Memory and the number of ranks are a machine's matter.
/// The number of particles, an estimate. Throws InputErrors.
double check_setup(std::shared_ptr<const Scene> scene,
                   std::vector<std::unique_ptr<ConstitutiveModel>> materials,
                   const ColumnSet& output_columns);

/// Bodies without particles, an empty grid: enough to know the columns. `output_columns`: what outputs ask
/// for. Throws InputErrors for what does not fit the grid's limits.
Model prepare_model(std::shared_ptr<const Scene> scene,
                    std::vector<std::unique_ptr<ConstitutiveModel>> materials,
                    const ColumnSet& output_columns);

ModelPlan plan_of(const Model& model);

/// Make the particles. Throws InputErrors on every rank together for a body outside the grid, an identity or
/// a memory range exceeded, and a decomposition that does not fit. Collective.
void discretise(Model& model, Exchange& exchange);

/// First critical step and total energy, from the particles' first state; fills the clock. Collective.
void start_clock(Model& model, Exchange& exchange);

/// The grid's geometry as the scene states it.
GridGeometry geometry_of(const Scene& scene);

}  // namespace mpm::core
