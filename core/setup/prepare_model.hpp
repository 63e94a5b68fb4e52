// From a checked scene to a model whose bodies and grid are known and that holds no particles yet.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/model.hpp"

namespace mpm::core {

/// Bodies without particles, an empty grid: enough to know the columns. `output_columns`: what outputs ask
/// for. Throws InputErrors for what does not fit the grid's limits.
Model prepare_model(std::shared_ptr<const Scene> scene,
                    std::vector<std::unique_ptr<ConstitutiveModel>> materials,
                    const ColumnSet& output_columns);

/// Throws InputErrors where a body and its material do not go together.
void check_material_of(const Scene& scene, const BodyInput& input, const ConstitutiveModel& material);

/// The grid's geometry as the scene states it.
GridGeometry geometry_of(const Scene& scene);

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

ModelPlan plan_of(const Model& model);

}  // namespace mpm::core
