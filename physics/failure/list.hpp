// The failure models. To add one: a file beside these, and its name here.
#pragma once

#include <variant>

#include "physics/failure/full_damage.hpp"
#include "physics/failure/geometric_strain.hpp"
#include "physics/failure/minimum_pressure.hpp"
#include "physics/failure/plastic_strain.hpp"
#include "physics/failure/principal_strain.hpp"
#include "physics/failure/principal_stress.hpp"

namespace mpm::physics {

using FailureModel = std::variant<FullDamage, PlasticStrainFailure, MinimumPressureFailure,
                                  PrincipalStressFailure, PrincipalStrainFailure, GeometricStrainFailure>;

}  // namespace mpm::physics
