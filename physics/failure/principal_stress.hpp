// Fails where the largest principal stress exceeds PriStressMax, the smallest falls below PriStressMin, or
// half their difference exceeds ShearStressMax (manual 3.2.3.3); a bound of 0 is off. The stress is s - p I,
// without the artificial viscosity, which is not a material stress. Tested by
// tests/physics/principal_failure_test.cpp.
#pragma once

#include <string_view>

#include "core/tensor/principal.hpp"
#include "physics/failure/point.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

/// Bounds on the principal values x >= y >= z of a tensor and on the difference x - z.
template <class T>
core::MaskOf<T> beyond(const core::Vec3<T>& principal, const T& factor, double largest, double smallest,
                       double difference) {
  core::MaskOf<T> fails{};
  if (largest > 0) fails = fails | (principal.x > factor * largest);
  if (smallest < 0) fails = fails | (principal.z < factor * smallest);
  if (difference > 0) fails = fails | (principal.x - principal.z > factor * difference);
  return fails;
}

struct PrincipalStressFailure {
  static constexpr std::string_view name = "PriStress";
  static constexpr std::string_view summary = "principal stress or largest shear stress beyond its bound";
  static constexpr std::array<core::Column, 0> state{};

  double largest = 0, smallest = 0, shear = 0;

  static constexpr auto parameters() {
    using P = PrincipalStressFailure;
    return std::array<Parameter<P>, 3>{{
        {&P::largest,
         {.name = "PriStressMax",
          .required = true,
          .min = 0,
          .dimension = "stress",
          .meaning = "largest principal stress (tension); 0: off"}},
        {&P::smallest,
         {.name = "PriStressMin",
          .required = true,
          .max = 0,
          .dimension = "stress",
          .meaning = "smallest principal stress (compression), < 0; 0: off"}},
        {&P::shear,
         {.name = "ShearStressMax",
          .required = true,
          .min = 0,
          .dimension = "stress",
          .meaning = "largest shear stress, half the difference of the principal ones; 0: off"}},
    }};
  }

  template <class T>
  core::MaskOf<T> fails(const FailurePoint<T>& point) const {
    const T& p = point.pressure;
    const core::Sym3<T> stress{point.s.xx - p, point.s.yy - p, point.s.zz - p,
                               point.s.xy,     point.s.yz,     point.s.xz};
    return beyond(core::principal_values(stress), point.threshold_factor, largest, smallest, 2 * shear);
  }
};

}  // namespace mpm::physics
