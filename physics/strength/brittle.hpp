// Common part of the brittle solids (HJC, RHT, JH2): the total strain rate in their strength, powers of
// pressures that may be negative, the radial return to a given strength, and damage as the sum of plastic
// strain over strain to fracture.
//
// The strength uses pressure and damage at the beginning of the step, as in every explicit code: the error is
// of first order in the step.
#pragma once

#include "core/simd/math.hpp"
#include "physics/strength/plasticity.hpp"
#include "physics/strength/tension.hpp"

namespace mpm::physics {

struct BrittlePlasticity : MisesPlasticity {
  /// Equivalent deviatoric strain rate sqrt(2/3 D':D') over the reference rate.
  template <class T>
  static T rate_over(const StrengthPoint<T>& point, double reference) {
    return sqrt((2.0 / 3.0) * contract(point.strain, point.strain)) * (1 / (reference * point.dt));
  }

  /// 1 + C ln(rate*), 1 below the reference rate.
  template <class T>
  static T logarithmic_factor(double c, const T& rate) {
    using core::log;
    return 1.0 + c * log(core::max(rate, 1.0));
  }

  /// x^y, with negative x treated as zero.
  template <class T>
  static T power(const T& x, double y) {
    using core::pow;
    return pow(core::max(x, 0.0), y);
  }

  /// Plastic strain increment for a trial stress above `strength`, and the return to it.
  template <class T>
  static T return_at_once(StrengthPoint<T>& point, const T& strength, const T& shear_modulus) {
    const T trial = mises(point.s);
    const T increment = core::max(trial - strength, 0.0) / (3.0 * shear_modulus);
    radial_return(point, trial, strength, strength, increment);
    return increment;
  }

  /// With a strain to fracture of zero, the material breaks at the first flow.
  template <class T>
  static void add_damage(StrengthPoint<T>& point, const T& increment, const T& fracture_strain) {
    const T damage = core::min(point.damage + increment / core::max(fracture_strain, 1e-30), 1.0);
    point.damage = core::select(increment > 0.0, damage, point.damage);
  }
};

/// As plastic_parameters, with the yield stress that the input format requires and these laws ignore.
template <class Law>
constexpr auto brittle_parameters() {
  auto table = plastic_parameters<Law>();
  for (auto& parameter : table) {
    if (parameter.info.name != "Yield0") continue;
    parameter.info.min_open = false;
    parameter.info.meaning = "required but not used: the strength follows from the constants below";
  }
  return table;
}

/// A required parameter, at least zero unless `min` is given.
template <class Law>
constexpr Parameter<Law> constant(double Law::*member, std::string_view name, std::string_view dimension,
                                  std::string_view meaning, double min = 0, bool min_open = false) {
  return {member,
          {.name = name,
           .required = true,
           .min = min,
           .min_open = min_open,
           .dimension = dimension,
           .meaning = meaning}};
}

/// A switch, off unless `preset` is set.
template <class Law>
constexpr Parameter<Law> flag(double Law::*member, std::string_view name, std::string_view meaning,
                              double preset = 0) {
  return {member,
          {.name = name, .default_value = preset, .min = 0, .max = 1, .integer = true, .meaning = meaning}};
}

}  // namespace mpm::physics
