// Von Mises plasticity with Voce's hardening, which saturates, and a linear part:
//   sigma_y = Yield0 + H epef + Q (1 - exp(-b epef))
// Radial return with the increment of the consistency condition; exact for one step of any size along a fixed
// direction. Tested by tests/physics/j2_test.cpp; a bar that necks: benchmarks/implicit/studies/necking.py.
#pragma once

#include <string_view>

#include "physics/strength/consistency.hpp"
#include "physics/strength/plasticity.hpp"

namespace mpm::physics {

struct Voce : MisesPlasticity {
  static constexpr std::string_view name = "Voce";
  static constexpr std::string_view summary = "elastic-plastic, von Mises, hardening that saturates";
  using has_tangent = Voce;
  static constexpr std::array state{core::Column::effective_plastic_strain};

  double saturation = 0;  ///< Q, stress
  double rate = 0;        ///< b
  double hardening = 0;   ///< H, stress

  static constexpr auto parameters() {
    return join(plastic_parameters<Voce>(),
                std::array<Parameter<Voce>, 3>{{
                    {&Voce::saturation,
                     {.name = "Q",
                      .required = true,
                      .min = 0,
                      .dimension = "stress",
                      .meaning = "rise of the yield stress at saturation"}},
                    {&Voce::rate,
                     {.name = "b",
                      .required = true,
                      .min = 0,
                      .meaning = "exponent: a plastic strain of 1/b makes 63 % of Q"}},
                    {&Voce::hardening,
                     {.name = "H",
                      .default_value = 0,
                      .min = 0,
                      .dimension = "stress",
                      .meaning = "linear hardening beside it, d(yield stress)/d(plastic strain)"}},
                }});
  }
  void prepare() { derive_moduli(); }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    elastic_step(point);
    const T trial = mises(point.s), strain = point.effective_plastic_strain;
    const FlowStress<T> threshold = flow_stress(strain);
    const T increment = plastic_increment(trial, threshold, threshold.value, shear, [&]<class X>(const X& x) {
      return flow_stress(X(core::as<X>(strain) + x));
    });
    return_to(point, trial, threshold.value, threshold.value, increment);
  }

 private:
  template <class T>
  FlowStress<T> flow_stress(const T& strain) const {
    using core::exp;
    const T left = saturation * exp((-rate) * strain);
    return {(yield0 + saturation) + hardening * strain - left, hardening + rate * left};
  }
};

}  // namespace mpm::physics
