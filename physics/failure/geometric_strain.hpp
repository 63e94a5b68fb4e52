// Fails, and with Erosion is deleted, where the instantaneous geometric strain exceeds ErosionStrain (manual
// 3.2.3.5, which names it and gives no equation): the effective strain of the current deformation, which
// unlike an accumulated strain can also decrease (ANSYS Explicit Dynamics Guide 2024 R2, 11.13: from the
// global strain components of the cycle),
//   e_eff = sqrt(2/3 e':e'),   e the logarithmic strain (physics/failure/logarithmic_strain.hpp).
// A bound of 0 disables the criterion. Tested by tests/physics/principal_failure_test.cpp.
#pragma once

#include <string_view>

#include "physics/failure/logarithmic_strain.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

struct GeometricStrainFailure {
  static constexpr std::string_view name = "InstGeoStrain";
  static constexpr std::string_view summary =
      "effective strain of the present deformation above ErosionStrain";
  static constexpr auto state = core::deformation_gradient_columns;

  double erosion_strain = 0;

  static constexpr auto parameters() {
    using P = GeometricStrainFailure;
    return std::array<Parameter<P>, 1>{{
        {&P::erosion_strain,
         {.name = "ErosionStrain",
          .required = true,
          .min = 0,
          .meaning = "instantaneous geometric strain at failure; 0: off"}},
    }};
  }

  template <class T>
  core::MaskOf<T> fails(const FailurePoint<T>& point) const {
    core::MaskOf<T> never{};
    if (erosion_strain == 0) return never;
    const core::Vec3<T> e = principal_strains(point);
    const T mean = (1.0 / 3.0) * (e.x + e.y + e.z);
    const core::Vec3<T> d{e.x - mean, e.y - mean, e.z - mean};
    return sqrt((2.0 / 3.0) * dot(d, d)) > point.threshold_factor * erosion_strain;
  }
};

}  // namespace mpm::physics
