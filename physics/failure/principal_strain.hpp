// Fails where the largest principal strain exceeds PriStrainMax, the smallest falls below PriStrainMin, or
// the shear strain gamma, their difference, exceeds ShearStrainMax (manual 3.2.3.4); a bound of 0 is off. The
// strain is logarithmic, of the deformation gradient (physics/failure/logarithmic_strain.hpp). Tested by
// tests/physics/principal_failure_test.cpp.
#pragma once

#include <string_view>

#include "physics/failure/logarithmic_strain.hpp"
#include "physics/failure/principal_stress.hpp"

namespace mpm::physics {

struct PrincipalStrainFailure {
  static constexpr std::string_view name = "PriStrain";
  static constexpr std::string_view summary = "principal strain or largest shear strain beyond its bound";
  static constexpr auto state = core::deformation_gradient_columns;

  double largest = 0, smallest = 0, shear = 0;

  static constexpr auto parameters() {
    using P = PrincipalStrainFailure;
    return std::array<Parameter<P>, 3>{{
        {&P::largest,
         {.name = "PriStrainMax",
          .required = true,
          .min = 0,
          .meaning = "largest principal strain (logarithmic); 0: off"}},
        {&P::smallest,
         {.name = "PriStrainMin",
          .required = true,
          .max = 0,
          .meaning = "smallest principal strain (logarithmic), < 0; 0: off"}},
        {&P::shear,
         {.name = "ShearStrainMax",
          .required = true,
          .min = 0,
          .meaning = "largest shear strain, the difference of the principal ones; 0: off"}},
    }};
  }

  template <class T>
  core::MaskOf<T> fails(const FailurePoint<T>& point) const {
    return beyond(principal_strains(point), point.threshold_factor, largest, smallest, shear);
  }
};

}  // namespace mpm::physics
