// Johnson-Cook plasticity without temperature (manual 3-6):
//   sigma_y = (Yield0 + B epef^n)(1 + C ln(rate/epso)), the rate factor 1 below the reference rate epso
// The increment solves the consistency condition with its own rate. Tested by
// tests/physics/johnson_cook_test.cpp.
#pragma once

#include <string_view>

#include "physics/strength/johnson_cook_flow.hpp"

namespace mpm::physics {

struct SimJohnsonCook : JohnsonCookPlasticity {
  static constexpr std::string_view name = "SimJohnsonCook";
  static constexpr std::string_view summary = "Johnson-Cook plasticity without temperature";
  using has_tangent = SimJohnsonCook;
  static constexpr std::array state{core::Column::effective_plastic_strain};

  static constexpr auto parameters() { return johnson_cook_parameters<SimJohnsonCook>(); }
  void prepare() { derive_moduli(); }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    const T before = mises(point.s), strain = point.effective_plastic_strain;
    elastic_step(point);
    const T trial = mises(point.s);
    const FlowStress<T> threshold = power_hardening(yield0, b, n, strain);
    const T start = core::max(before, threshold.value);
    const T increment = plastic_increment(trial, threshold, start, shear, [&]<class X>(const X& x) {
      return power_hardening(yield0, b, n, X(core::as<X>(strain) + x)) * rate_factor(c, x, epso * point.dt);
    });
    return_to(point, trial, start, threshold.value, increment);
  }
};

}  // namespace mpm::physics
