// From a checked scene to a model with bodies and grid but without particles.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/model.hpp"

namespace mpm::core {

/// Creates bodies without particles and an empty grid, which determine the columns. `output_columns`: those
/// that outputs need. Throws InputErrors where the grid's limits are exceeded.
Model prepare_model(std::shared_ptr<const Scene> scene,
                    std::vector<std::unique_ptr<ConstitutiveModel>> materials,
                    const ColumnSet& output_columns);

/// Throws InputErrors where a material does not suit its body.
void check_material_of(const Scene& scene, const BodyInput& input, const ConstitutiveModel& material);

/// The grid's geometry from the scene.
GridGeometry geometry_of(const Scene& scene);

struct BodyPlan {
  std::string name;
  double expected_particles = 0;
  double bytes_per_particle = 0;
  std::vector<std::string_view> columns;  ///< beyond those of every particle
};

/// What a scene will need, computed before any allocation.
struct ModelPlan {
  std::vector<BodyPlan> bodies;
  double particles = 0;
  double state_bytes = 0;  ///< over all ranks
};

ModelPlan plan_of(const Model& model);

}  // namespace mpm::core
