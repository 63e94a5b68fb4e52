// Fails where the pressure falls below pmin < 0, a hydrostatic tension (manual 3.2.3.2, thesis 2-135).
#pragma once

#include <string_view>

#include "physics/failure/point.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

struct MinimumPressureFailure {
  static constexpr std::string_view name = "Pmin";
  static constexpr std::string_view summary = "pressure below pmin (spall)";
  static constexpr std::array<core::Column, 0> state{};

  double pmin = 0;

  static constexpr auto parameters() {
    return std::array<Parameter<MinimumPressureFailure>, 1>{{
        {&MinimumPressureFailure::pmin,
         {.name = "pmin",
          .required = true,
          .max = 0,
          .max_open = true,
          .dimension = "stress",
          .meaning = "lowest pressure (tension)"}},
    }};
  }

  template <class T>
  core::MaskOf<T> fails(const FailurePoint<T>& point) const {
    return point.pressure < point.threshold_factor * pmin;
  }
};

}  // namespace mpm::physics
