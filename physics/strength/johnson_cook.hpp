// Johnson-Cook plasticity with heat and damage (manual 3-2 to 3-5, thesis 2-116 to 2-120, 2-136, 2-137):
//   sigma_y = (Yield0 + B epef^n)(1 + C ln(rate/epso))(1 - T*^m),  T* = (T - roomt)/(melt - roomt)
//   eps_f = (D1 + D2 exp(D3 sigma_m/sigma_eq))(1 + D4 ln(rate/epso))(1 + D5 T*^m)
//   damage = sum of d epef/eps_f
// Rate factors are 1 below epso. The increment solves the consistency condition with its own rate and
// adiabatic temperature. Molten material (T* = 1) has no shear strength. The particle fails at damage 1;
// smaller damage does not weaken it. The exponent m in the last factor is the manual's. Tested by
// tests/physics/johnson_cook_test.cpp.
#pragma once

#include <string>
#include <string_view>

#include "physics/strength/johnson_cook_flow.hpp"

namespace mpm::physics {

struct JohnsonCook : JohnsonCookPlasticity {
  static constexpr std::string_view name = "JohnsonCook";
  static constexpr std::string_view summary = "Johnson-Cook plasticity with adiabatic heating and damage";
  using has_tangent = JohnsonCook;
  static constexpr std::array state{core::Column::effective_plastic_strain, core::Column::temperature,
                                    core::Column::damage};

  double m = 0, melt = 0, roomt = 0;
  double specific_heat = 0;
  double d1 = 0, d2 = 0, d3 = 0, d4 = 0, d5 = 0;

  static constexpr auto parameters() {
    using P = JohnsonCook;
    return join(
        johnson_cook_parameters<P>(),
        std::array<Parameter<P>, 9>{{
            {&P::m,
             {.name = "m",
              .required = true,
              .min = 0,
              .min_open = true,
              .meaning = "thermal softening exponent"}},
            {&P::melt,
             {.name = "melt",
              .required = true,
              .min = 0,
              .min_open = true,
              .dimension = "temperature",
              .meaning = "melting temperature, > roomt"}},
            {&P::roomt,
             {.name = "roomt",
              .default_value = 293,
              .min = 0,
              .dimension = "temperature",
              .meaning = "room temperature, where softening begins; temperature at the start"}},
            {&P::specific_heat,
             {.name = "SpecHeat",
              .required = true,
              .min = 0,
              .min_open = true,
              .dimension = "energy/(mass temperature)",
              .meaning = "specific heat"}},
            {&P::d1, {.name = "D1", .meaning = "failure strain", .group = "damage"}},
            {&P::d2,
             {.name = "D2", .meaning = "failure strain: factor of the triaxiality term", .group = "damage"}},
            {&P::d3, {.name = "D3", .meaning = "failure strain: exponent of triaxiality", .group = "damage"}},
            {&P::d4, {.name = "D4", .meaning = "failure strain: strain rate", .group = "damage"}},
            {&P::d5, {.name = "D5", .meaning = "failure strain: temperature", .group = "damage"}},
        }});
  }
  std::string fault() const { return melt > roomt ? "" : "melt must be greater than roomt"; }
  void prepare() { derive_moduli(); }

  bool fails_by_damage() const { return d1 != 0 || d2 != 0 || d3 != 0 || d4 != 0 || d5 != 0; }
  bool carries(core::Column column) const { return column != core::Column::damage || fails_by_damage(); }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    const T before = mises(point.s), strain = point.effective_plastic_strain;
    elastic_step(point);
    const T trial = mises(point.s);
    const T softened = softening(point.temperature);
    const FlowStress<T> hardening = power_hardening(yield0, b, n, strain);
    const FlowStress<T> threshold{hardening.value * softened, hardening.slope * softened};
    const T start = core::max(before, threshold.value);
    const T heat = plastic_work_coefficient / (point.density * specific_heat);  // 3-5
    const T increment = plastic_increment(trial, threshold, start, shear, [&]<class X>(const X& x) {
      const X mean = core::as<X>(0.5 * (start + trial)), per_work = core::as<X>(heat);
      const X work = (mean - (1.5 * shear) * x) * x;
      const X temperature = core::as<X>(point.temperature) + per_work * work;
      const X heating = per_work * (mean - (3 * shear) * x);
      return power_hardening(yield0, b, n, X(core::as<X>(strain) + x)) * rate_factor(c, x, epso * point.dt) *
             softening(temperature, heating);
    });
    return_to(point, trial, start, threshold.value, increment);
    if (fails_by_damage()) accumulate_damage(point, increment);
  }

 private:
  template <class T>
  T softening(const T& temperature) const {
    return 1.0 - homologous_power(homologous_temperature(temperature, roomt, melt), m);
  }
  /// With the derivative along a path on which the temperature changes at the rate `heating`.
  template <class T>
  FlowStress<T> softening(const T& temperature, const T& heating) const {
    const T homologous = homologous_temperature(temperature, roomt, melt);
    const T power = homologous_power(homologous, m);
    const T slope = (-m / (melt - roomt)) * heating * power / homologous;
    return {1.0 - power, core::select((homologous > 0.0) & (homologous < 1.0), slope, 0.0)};
  }
  template <class T>
  void accumulate_damage(StrengthPoint<T>& point, const T& increment) const {
    using core::exp;
    using core::max;
    using core::min;
    // A molten particle has no stress to divide by; any flow breaks it under tension, but not under pressure.
    const T triaxiality = -point.pressure / max(point.yield_stress, 1e-6 * yield0);
    const T homologous = homologous_temperature(point.temperature, roomt, melt);
    const T failure_strain = (d1 + d2 * exp(d3 * triaxiality)) *
                             rate_factor(d4, increment, epso * point.dt).value *
                             (1.0 + d5 * homologous_power(homologous, m));
    // Parameters without a positive failure strain cause failure at the first flow.
    const T damage = point.damage + increment / max(failure_strain, 1e-6);
    point.damage = core::select(increment > 0.0, min(damage, 1.0), point.damage);
  }
};

}  // namespace mpm::physics
