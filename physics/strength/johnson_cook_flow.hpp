// The factors of the Johnson-Cook flow stress (manual 3-2, thesis 2-116), each with its derivative with
// respect to the plastic strain increment x of a step:
//   hardening A + B (epef + x)^n,   rate 1 + C ln(max(x/(dt epso), 1)),   heat 1 - T*^m
// Below the reference rate epso the rate factor is 1: otherwise the logarithm would make a slow material
// weaker than A and, at rest, remove its strength.
#pragma once

#include <array>

#include "core/simd/dual.hpp"
#include "physics/strength/consistency.hpp"
#include "physics/strength/plasticity.hpp"

namespace mpm::physics {

struct JohnsonCookPlasticity : MisesPlasticity {  // yield0 is A
  double b = 0;                                   ///< stress
  double n = 0;
  double c = 0;
  double epso = 0;  ///< 1/time
};

template <class Law>
constexpr auto johnson_cook_parameters() {
  return join(
      plastic_parameters<Law>(),
      std::array<Parameter<Law>, 4>{{
          {&Law::b,
           {.name = "B", .required = true, .min = 0, .dimension = "stress", .meaning = "hardening constant"}},
          {&Law::n, {.name = "n", .required = true, .min = 0, .meaning = "hardening exponent"}},
          {&Law::c, {.name = "C", .required = true, .min = 0, .meaning = "strain-rate constant"}},
          {&Law::epso,
           {.name = "epso",
            .required = true,
            .min = 0,
            .min_open = true,
            .dimension = "1/time",
            .meaning = "reference strain rate: 1/s in the unit of time of the case"}},
      }});
}

template <class T>
FlowStress<T> power_hardening(double a, double b, double n, const T& strain) {
  using core::exp;
  using core::log;
  using core::max;
  // x^n as exp(n ln x); at zero strain the term vanishes and its slope, infinite for n < 1, is not used.
  const T held = max(strain, 1e-300);
  const T term = core::select(strain > 0.0, b * exp(n * log(held)), n > 0 ? 0.0 : b);
  return {a + term, n * term / held};
}

template <class T>
FlowStress<T> rate_factor(double c, const T& increment, double reference_increment) {
  using core::log;
  using core::max;
  const T held = max(increment, reference_increment);
  return {1.0 + c * log(held * (1 / reference_increment)),
          core::select(increment > reference_increment, c / held, 0.0)};
}

/// (T - T_room)/(T_melt - T_room), limited to [0, 1].
template <class T>
T homologous_temperature(const T& temperature, double room, double melt) {
  return core::min(core::max((temperature - room) * (1 / (melt - room)), 0.0), 1.0);
}

template <class T>
T homologous_power(const T& homologous, double m) {
  using core::exp;
  using core::log;
  return exp(m * log(homologous));  // log(0) = -infinity, so that 0^m = 0
}

template <class T>
FlowStress<T> operator*(const FlowStress<T>& a, const FlowStress<T>& b) {
  return {a.value * b.value, a.value * b.slope + a.slope * b.value};
}

}  // namespace mpm::physics
