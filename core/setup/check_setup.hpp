// What a run would refuse at its start, without a run.
#pragma once

#include <memory>
#include <vector>

#include "core/material/constitutive_model.hpp"
#include "core/scene/scene.hpp"

namespace mpm::core {

/// What the set-up refuses for reasons that stand in the input, found without making the particles but a few
/// of each body: bodies outside the grid, more particles than can be numbered, materials for bars, too many
/// cells, a first state that no run can start from. Memory and the number of ranks are a machine's matter.
/// The number of particles, an estimate. Throws InputErrors.
double check_setup(std::shared_ptr<const Scene> scene,
                   std::vector<std::unique_ptr<ConstitutiveModel>> materials,
                   const ColumnSet& output_columns);

}  // namespace mpm::core
