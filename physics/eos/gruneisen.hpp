// Mie-Grueneisen equation of state about the Hugoniot Us = C0 + S1 up (manual 3-48 to 3-51, thesis 2-127 to
// 2-130):
//   p = pH (1 - gamma mu/2) + gamma0 E,   gamma = gamma0/(1 + mu),   in tension p = rho0 C0^2 mu + gamma0 E
//   pH = rho0 C0^2 mu (1 + mu) / (1 - (S1 - 1) mu)^2,   or its cubic expansion where simplified = 1
// Limit: pH has a pole at mu = 1/(S1 - 1), where the shock speed is infinite; the compression is kept below
// it. Tested by tests/physics/gruneisen_test.cpp.
#pragma once

#include <limits>
#include <string_view>

#include "physics/eos/point.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

struct Gruneisen {
  static constexpr std::string_view name = "Gruneisen";
  static constexpr std::string_view summary = "Mie-Grueneisen about a linear shock Hugoniot";
  static constexpr std::array<core::Column, 0> state{};
  using has_tangent = Gruneisen;

  double c0 = 0;
  double s1 = 0;
  double gamma0 = 0;
  double simplified = 0;
  double stiffness = 0;                                                ///< rho0 C0^2, derived
  double compression_limit = std::numeric_limits<double>::infinity();  ///< derived

  static constexpr auto parameters() {
    return std::array<Parameter<Gruneisen>, 4>{{
        {&Gruneisen::c0,
         {.name = "C0",
          .required = true,
          .min = 0,
          .min_open = true,
          .dimension = "velocity",
          .meaning = "intercept of the shock Hugoniot"}},
        {&Gruneisen::s1,
         {.name = "S1", .required = true, .min = 0, .meaning = "slope of the shock Hugoniot"}},
        {&Gruneisen::gamma0,
         {.name = "gamma0", .required = true, .min = 0, .meaning = "Grueneisen coefficient"}},
        {&Gruneisen::simplified,
         {.name = "simplified",
          .default_value = 0,
          .min = 0,
          .max = 1,
          .integer = true,
          .meaning = "1: cubic expansion of the Hugoniot"}},
    }};
  }
  void prepare(double reference_density) {
    stiffness = reference_density * c0 * c0;
    // At 95 % of the pole pH is some 400 times its value without the pole: far beyond any use of the law.
    if (simplified == 0 && s1 > 1) compression_limit = 0.95 / (s1 - 1);
  }

  template <class T>
  LinearisedPressure<T> linearise(const EosPoint<T>& point) const {
    using core::max;
    using core::min;
    const T mu = max(point.compression, 0.0);
    const T tension = min(point.compression, 0.0);
    if (simplified != 0) return cubic(mu, tension, point.relative_volume);
    const T r = 1.0 / (1.0 - (s1 - 1) * mu);
    const T n = mu * (1.0 + (1 - 0.5 * gamma0) * mu);
    const T slope = 1.0 + (2 - gamma0) * mu + 2 * (s1 - 1) * n * r;
    return {stiffness * (n * r * r + tension), gamma0, stiffness * (r * r) * slope, 0.0};
  }

 private:
  template <class T>
  LinearisedPressure<T> cubic(const T& mu, const T& tension, const T& v) const {
    const double c2 = 2 * s1 - 1, c3 = (s1 - 1) * (3 * s1 - 1);
    const T hugoniot = mu * (1.0 + mu * (c2 + mu * c3));
    const T slope = 1.0 + mu * (2 * c2 + mu * (3 * c3));
    const T factor = 1.0 - 0.5 * gamma0 * mu * v;  // and d(mu v)/dmu = v^2
    return {stiffness * (hugoniot * factor + tension), gamma0,
            stiffness * (slope * factor - 0.5 * gamma0 * hugoniot * v * v), 0.0};
  }
};

}  // namespace mpm::physics
