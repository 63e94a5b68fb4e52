// Fails where the effective plastic strain exceeds epmax (manual 3.2.3.1, thesis 2-134).
#pragma once

#include <string_view>

#include "physics/failure/point.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

struct PlasticStrainFailure {
  static constexpr std::string_view name = "PlaStrain";
  static constexpr std::string_view summary = "effective plastic strain above epmax";
  static constexpr std::array state{core::Column::effective_plastic_strain};

  double epmax = 0;

  static constexpr auto parameters() {
    return std::array<Parameter<PlasticStrainFailure>, 1>{{
        {&PlasticStrainFailure::epmax,
         {.name = "epmax",
          .required = true,
          .min = 0,
          .min_open = true,
          .meaning = "effective plastic strain at failure"}},
    }};
  }

  template <class T>
  core::MaskOf<T> fails(const FailurePoint<T>& point) const {
    return point.effective_plastic_strain > point.threshold_factor * epmax;
  }
};

}  // namespace mpm::physics
