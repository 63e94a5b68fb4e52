// Polynomial equation of state with a separate branch in tension (manual 3-45, 3-46):
//   mu >= 0: p = A1 mu + A2 mu^2 + A3 mu^3 + (B0 + B1 mu) E,   mu < 0: p = T1 mu + T2 mu^2 + B0 E
// Continuous at mu = 0, where the stiffness jumps from T1 to A1 + B1 E. For T2 > 0 the tension has a maximum
// at mu = -T1/(2 T2); the sound speed beyond is undefined and counted. Tested by
// tests/physics/polynomial2_test.cpp.
#pragma once

#include <string_view>

#include "physics/eos/point.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

struct Polynomial2 {
  static constexpr std::string_view name = "Polynomial2";
  static constexpr std::string_view summary = "polynomial, with other coefficients in tension";
  static constexpr std::array<core::Column, 0> state{};
  using has_tangent = Polynomial2;

  double a1 = 0, a2 = 0, a3 = 0;  ///< stress
  double b0 = 0, b1 = 0;
  double t1 = 0, t2 = 0;  ///< stress

  static constexpr auto parameters() {
    using P = Polynomial2;
    constexpr auto coefficient = [](double P::*member, std::string_view name, std::string_view dimension,
                                    std::string_view meaning) {
      return Parameter<P>{member,
                          {.name = name, .required = true, .dimension = dimension, .meaning = meaning}};
    };
    return std::array<Parameter<P>, 7>{{
        coefficient(&P::a1, "A1", "stress", "coefficient of mu in compression"),
        coefficient(&P::a2, "A2", "stress", "coefficient of mu^2 in compression"),
        coefficient(&P::a3, "A3", "stress", "coefficient of mu^3 in compression"),
        coefficient(&P::b0, "B0", "1", "coefficient of E"),
        coefficient(&P::b1, "B1", "1", "coefficient of mu E in compression"),
        coefficient(&P::t1, "T1", "stress", "coefficient of mu in tension"),
        coefficient(&P::t2, "T2", "stress", "coefficient of mu^2 in tension"),
    }};
  }

  template <class T>
  LinearisedPressure<T> linearise(const EosPoint<T>& point) const {
    const T c = core::max(point.compression, 0.0), t = core::min(point.compression, 0.0);
    const core::MaskOf<T> tension = point.compression < 0.0;
    return {c * (a1 + c * (a2 + c * a3)) + t * (t1 + t * t2), b0 + b1 * c,
            core::select(tension, t1 + (2 * t2) * t, a1 + c * (2 * a2 + (3 * a3) * c)),
            core::select(tension, 0.0, T(b1))};
  }
};

}  // namespace mpm::physics
