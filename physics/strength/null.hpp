// Fluids: no elastic shear stress, pressure from the equation of state (manual 3.2.1.8).
//   ck = 0: Newtonian, tau = mu * rate in simple shear;  ck > 0: power law, tau = ck * rate^nn
// In tensor form s = 2 eta D' with eta = mu or ck g^(nn - 1), g = sqrt(2 D':D') the shear rate. The manual
// prints s = mu D' (3-7) and calls mu the dynamic viscosity, which is the same if its shear components mean
// g. Limit: for nn < 1 the viscosity of a fluid almost at rest is that of the rate 1e-8/dt. Tested by
// tests/physics/fluid_test.cpp.
#pragma once

#include <string_view>

#include "core/simd/math.hpp"
#include "physics/parameter.hpp"
#include "physics/strength/point.hpp"

namespace mpm::physics {

struct Null {
  static constexpr std::string_view name = "Null";
  static constexpr std::string_view summary = "fluid: Newtonian or power law, no shear strength";
  static constexpr std::array<core::Column, 0> state{};

  double mu = 0;  ///< stress time
  double ck = 0;  ///< stress time^nn
  double nn = 1;

  static constexpr auto parameters() {
    return std::array<Parameter<Null>, 3>{{
        {&Null::mu,
         {.name = "mu",
          .default_value = 0,
          .min = 0,
          .dimension = "stress time",
          .meaning = "dynamic viscosity of a Newtonian fluid, ck 0"}},
        {&Null::ck,
         {.name = "ck",
          .default_value = 0,
          .min = 0,
          .dimension = "stress time^nn",
          .meaning = "consistency of a power-law fluid; 0: Newtonian"}},
        {&Null::nn,
         {.name = "nn",
          .default_value = 1,
          .min = 0,
          .min_open = true,
          .meaning = "power-law exponent: < 1 shear thinning, > 1 shear thickening"}},
    }};
  }
  bool is_viscous() const { return mu > 0 || ck > 0; }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    const T eta = viscosity(point);
    point.s = (2 / point.dt * eta) * point.strain;
    point.viscosity = eta;
  }

 private:
  template <class T>
  T viscosity(const StrengthPoint<T>& point) const {
    if (!(ck > 0)) return mu;
    const T step = sqrt(2.0 * contract(point.strain, point.strain));  // g dt
    return ck * core::pow(core::max(step, 1e-8) * (1 / point.dt), nn - 1);
  }
};

}  // namespace mpm::physics
