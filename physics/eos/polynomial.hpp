// Polynomial equation of state (manual 3-44, thesis 2-131), c2 and c6 acting in compression only:
//   p = c0 + c1 mu + c2 mu^2 + c3 mu^3 + (c4 + c5 mu + c6 mu^2) E
// A gamma-law gas is c4 = c5 = gamma - 1 (2-132), an inviscid liquid c1 = rho0 c0^2 (2-133).
// Tested by tests/physics/energy_test.cpp and laws_test.cpp.
#pragma once

#include <string_view>

#include "physics/eos/point.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

struct Polynomial {
  static constexpr std::string_view name = "Polynomial";
  static constexpr std::string_view summary = "polynomial in the compression, linear in the energy";
  static constexpr std::array<core::Column, 0> state{};
  using has_tangent = Polynomial;

  double c0 = 0, c1 = 0, c2 = 0, c3 = 0;  ///< stress
  double c4 = 0, c5 = 0, c6 = 0;

  static constexpr auto parameters() {
    using P = Polynomial;
    constexpr auto coefficient = [](double P::*member, std::string_view name, std::string_view dimension,
                                    std::string_view meaning) {
      return Parameter<P>{member,
                          {.name = name, .required = true, .dimension = dimension, .meaning = meaning}};
    };
    return std::array<Parameter<P>, 7>{{
        coefficient(&P::c0, "c0", "stress", "constant term"),
        coefficient(&P::c1, "c1", "stress", "coefficient of mu"),
        coefficient(&P::c2, "c2", "stress", "coefficient of mu^2 in compression"),
        coefficient(&P::c3, "c3", "stress", "coefficient of mu^3"),
        coefficient(&P::c4, "c4", "1", "coefficient of E"),
        coefficient(&P::c5, "c5", "1", "coefficient of mu E"),
        coefficient(&P::c6, "c6", "1", "coefficient of mu^2 E in compression"),
    }};
  }

  template <class T>
  LinearisedPressure<T> linearise(const EosPoint<T>& point) const {
    const T mu = point.compression, positive = core::max(mu, 0.0);
    return {c0 + mu * (c1 + mu * mu * c3) + c2 * positive * positive, c4 + c5 * mu + c6 * positive * positive,
            c1 + 3 * c3 * mu * mu + 2 * c2 * positive, c5 + 2 * c6 * positive};
  }
};

}  // namespace mpm::physics
