// Holmquist-Johnson-Cook concrete (Holmquist, Johnson and Cook 1993; manual 3-14 to 3-16, 3-59):
//   sigma_y/fc = [A (1 - D) + B p*^N] (1 + C ln rate*) <= SMax,   p* = p/fc, rate* = rate/epso
//   D = sum of (d epef + d mu_p)/max(D1 (p* + T*)^D2, EFMin),   T* = T/fc,   p >= -T (1 - D)
// The manual leaves p < 0 open: A (1 - D)(1 + p/T)(1 + C ln rate*), as in the IMPETUS manual
// (MAT_HJC_CONCRETE). The rate factor is 1 below epso. mu_p is the plastic compression that the equation of
// state of the same name has recorded up to the end of the previous step; with other equations it is zero.
// Material with D = 1 is rubble with the strength B p*^N: it fails only by DamageToFail (at
// FailureDamageThreshold) or ErosionByDamage. Tested by tests/physics/holmquist_johnson_cook_test.cpp.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "physics/eos/traits.hpp"
#include "physics/strength/brittle.hpp"

namespace mpm::physics {

struct HolmquistJohnsonCook : BrittlePlasticity {
  static constexpr std::string_view name = "HolmquistJohnsonCook";
  static constexpr std::string_view summary = "Holmquist-Johnson-Cook concrete";
  static constexpr std::array state{core::Column::effective_plastic_strain, core::Column::damage,
                                    core::Column::plastic_volumetric_strain, core::Column::history_0};

  double a = 0, b = 0, n = 0, c = 0;
  double fc = 0;  ///< stress
  double smax = 0;
  double d1 = 0, d2 = 0, efmin = 0;
  double t = 0;     ///< stress
  double epso = 0;  ///< 1/time
  double tensile_failure = 0, threshold = 0, erosion_by_damage = 0, erosion_by_pressure = 0;
  double tensile_damage = 0, damage_to_fail = 0, failure_damage = 1;
  bool crushes = false;  ///< the equation of state records plastic volumetric strain

  static constexpr auto parameters() {
    using P = HolmquistJohnsonCook;
    return join(
        brittle_parameters<P>(),
        std::array<Parameter<P>, 18>{{
            constant(&P::a, "A", "1", "cohesive strength"),
            constant(&P::b, "B", "1", "pressure hardening"),
            constant(&P::n, "N", "1", "pressure exponent"),
            constant(&P::c, "C", "1", "strain-rate constant"),
            constant(&P::fc, "fc", "stress", "uniaxial compressive strength", 0, true),
            constant(&P::smax, "SMax", "1", "largest normalised strength", 0, true),
            constant(&P::d1, "D1", "1", "strain to fracture: factor"),
            constant(&P::d2, "D2", "1", "strain to fracture: exponent of the pressure"),
            constant(&P::efmin, "EFMin", "1", "smallest strain to fracture"),
            constant(&P::t, "T", "stress", "tensile strength", 0, true),
            constant(&P::epso, "epso", "1/time", "reference strain rate: 1/s in the unit of time of the case",
                     0, true),
            flag(&P::tensile_failure, "TensileFailure",
                 "1: fails at the tension T (1 - D); 0: the tension is limited to it"),
            flag(&P::threshold, "Threshold", "1: no damage while the strain to fracture is below EFMin"),
            flag(&P::erosion_by_damage, "ErosionByDamage", "1: eroded when damage reaches 1"),
            flag(&P::erosion_by_pressure, "ErosionByPressure", "1: eroded when the tension exceeds T"),
            flag(&P::tensile_damage, "TensileDamage", "1: T (1 - D) instead of T in the strain to fracture"),
            flag(&P::damage_to_fail, "DamageToFail", "1: fails when damage reaches FailureDamageThreshold"),
            {&P::failure_damage,
             {.name = "FailureDamageThreshold",
              .default_value = 1,
              .min = 0,
              .meaning = "damage from which a particle joins the failed component, and with DamageToFail "
                         "fails"}},
        }});
  }
  void prepare() { derive_moduli(); }

  /// Takes from the equation of state's traits whether it crushes.
  std::string couple(const EosTraits& eos) {
    crushes = eos.columns.has(core::Column::plastic_volumetric_strain);
    return {};
  }
  bool carries(core::Column column) const {
    return crushes ||
           (column != core::Column::plastic_volumetric_strain && column != core::Column::history_0);
  }
  bool fails_by_damage() const { return damage_to_fail != 0; }
  double failing_damage() const { return std::min(failure_damage, 1.0); }
  bool erodes_by_damage() const { return erosion_by_damage != 0; }
  TensionRules tension_rules() const {
    TensionRules rules{.limited = true, .verdict = tensile_failure};
    if (erosion_by_pressure != 0) rules.erosion = t;
    return rules;
  }

  /// sigma_y
  template <class T>
  T strength(const T& pressure, const T& damage, const T& rate) const {
    const T compressed = a * (1.0 - damage) + b * power(T(pressure * (1 / fc)), n);
    const T stretched = a * (1.0 - damage) * core::max(1.0 + pressure * (1 / t), 0.0);
    const T quasistatic = core::select(pressure > 0.0, compressed, stretched);
    return fc * core::min(quasistatic * logarithmic_factor(c, rate), smax);
  }
  /// D1 (p* + T*)^D2
  template <class T>
  T fracture_strain(const T& pressure, const T& damage) const {
    const T tension = tensile_damage != 0 ? t * (1.0 - damage) : T(t);
    return d1 * power(T((pressure + tension) * (1 / fc)), d2);
  }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    elastic_step(point);
    const T increment =
        return_at_once(point, strength(point.pressure, point.damage, rate_over(point, epso)), T(shear));
    T strain = increment;
    if (crushes) {
      strain += core::max(point.plastic_volumetric_strain - point.history_0, 0.0);
      point.history_0 = point.plastic_volumetric_strain;
    }
    const T fracture = fracture_strain(point.pressure, point.damage);
    if (threshold != 0) strain = core::select(fracture < efmin, 0.0, strain);
    add_damage(point, strain, core::max(fracture, efmin));
    point.lowest_pressure = -t * (1.0 - point.damage);
  }
};

}  // namespace mpm::physics
