// The failure models. To add one: a file beside these, and its name here.
#pragma once

#include <variant>

#include "physics/failure/full_damage.hpp"
#include "physics/failure/minimum_pressure.hpp"
#include "physics/failure/plastic_strain.hpp"

namespace mpm::physics {

using FailureModel = std::variant<FullDamage, PlasticStrainFailure, MinimumPressureFailure>;

}  // namespace mpm::physics
