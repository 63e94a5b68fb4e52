// The failure models of the input. To add one: a file beside these, and its name here.
#pragma once

#include "physics/failure/geometric_strain.hpp"
#include "physics/failure/minimum_pressure.hpp"
#include "physics/failure/plastic_strain.hpp"
#include "physics/failure/principal_strain.hpp"
#include "physics/failure/principal_stress.hpp"
#include "physics/laws.hpp"

namespace mpm::physics {

using FailureModels = LawList<PlasticStrainFailure, MinimumPressureFailure, PrincipalStressFailure,
                              PrincipalStrainFailure, GeometricStrainFailure>;

}  // namespace mpm::physics
