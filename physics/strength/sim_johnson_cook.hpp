// Johnson-Cook plasticity without temperature (manual 3-6):
//   sigma_y = (Yield0 + B epef^n)(1 + C ln(rate/epso)), the rate factor 1 below the reference rate epso
// The increment solves the consistency condition with its own rate. Shown by tests/physics/johnson_cook_test.cpp.
#pragma once

#include <string_view>

#include "physics/strength/johnson_cook_flow.hpp"
#include "physics/strength/plasticity.hpp"

namespace mpm::physics {

struct SimJohnsonCook : MisesPlasticity {
  static constexpr std::string_view name = "SimJohnsonCook";
  static constexpr std::string_view summary = "Johnson-Cook plasticity without temperature";
  static constexpr std::array state{core::Column::effective_plastic_strain};

  double b = 0, n = 0, c = 0;
  double epso = 0;  ///< 1/time

  static constexpr auto parameters() {
    return join(plastic_parameters<SimJohnsonCook>(), johnson_cook_parameters<SimJohnsonCook>());
  }
  void prepare() { derive_moduli(); }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    elastic_step(point);
    const T trial = mises(point.s), strain = point.effective_plastic_strain;
    const auto flow = [&](const T& x) {
      return power_hardening(yield0, b, n, T(strain + x)) * rate_factor(c, x, epso * point.dt);
    };
    const T start = power_hardening(yield0, b, n, strain).value;
    const T increment = plastic_increment(trial, start, shear, flow);
    const T reached = core::select(increment > 0.0, trial - (3 * shear) * increment, start);
    radial_return(point, trial, plastic_start(before, start), reached, increment);
  }
};

}  // namespace mpm::physics
