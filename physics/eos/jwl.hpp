// Jones-Wilkins-Lee equation of state of detonation products (manual 3-47; Lee, Hornig and Kury 1968):
//   p = A (1 - w/(R1 V)) exp(-R1 V) + B (1 - w/(R2 V)) exp(-R2 V) + w E/V,   V = 1/(1 + mu)
// E holds the chemical energy: E0 is the energy of detonation per initial volume. Its isentropes are
//   p = A exp(-R1 V) + B exp(-R2 V) + C V^-(1 + w)
// Limit: for large V it is the gas p = w E/V. A and B may be negative, as in fits to unreacted explosive;
// where such a fit has no real sound speed, this is counted. Tested by tests/physics/jwl_test.cpp.
#pragma once

#include <string_view>

#include "core/simd/math.hpp"
#include "physics/eos/point.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

struct Jwl {
  static constexpr std::string_view name = "JWL";
  static constexpr std::string_view summary = "Jones-Wilkins-Lee, detonation products";
  static constexpr std::array<core::Column, 0> state{};

  double a = 0, b = 0;    ///< stress
  double r1 = 0, r2 = 0;  ///< per relative volume
  double w = 0;

  static constexpr auto parameters() {
    return std::array<Parameter<Jwl>, 5>{{
        {&Jwl::a, {.name = "A", .required = true, .dimension = "stress", .meaning = "factor of exp(-R1 V)"}},
        {&Jwl::b, {.name = "B", .required = true, .dimension = "stress", .meaning = "factor of exp(-R2 V)"}},
        {&Jwl::r1,
         {.name = "R1", .required = true, .min = 0, .min_open = true, .meaning = "decay of the first term"}},
        {&Jwl::r2,
         {.name = "R2", .required = true, .min = 0, .min_open = true, .meaning = "decay of the second term"}},
        {&Jwl::w,
         {.name = "w",
          .required = true,
          .min = 0,
          .min_open = true,
          .meaning = "Grueneisen coefficient of the products"}},
    }};
  }

  template <class T>
  LinearisedPressure<T> linearise(const EosPoint<T>& point) const {
    using core::exp;
    const T v = point.relative_volume, density = 1.0 + point.compression;
    const T first = a * exp(-r1 * v), second = b * exp(-r2 * v);
    // dV/dmu = -V^2
    return {first * (1.0 - (w / r1) * density) + second * (1.0 - (w / r2) * density), w * density,
            first * (v * (r1 * v - w) - w / r1) + second * (v * (r2 * v - w) - w / r2), w};
  }
};

}  // namespace mpm::physics
