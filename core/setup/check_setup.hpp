// Checks of a run's set-up without running it.
#pragma once

#include <memory>
#include <vector>

#include "core/material/constitutive_model.hpp"
#include "core/scene/scene.hpp"

namespace mpm::core {

/// Finds the set-up errors that follow from the input alone, creating only a few particles of each body:
/// bodies outside the grid, more particles than can be numbered, one-dimensional materials in other bodies,
/// too many cells, an invalid initial state. Memory and the number of ranks depend on the machine and are not
/// checked. Returns the estimated number of particles. Throws InputErrors.
double check_setup(std::shared_ptr<const Scene> scene,
                   std::vector<std::unique_ptr<ConstitutiveModel>> materials,
                   const ColumnSet& output_columns);

}  // namespace mpm::core
