// Johnson-Holmquist ceramics and glass, JH-2 (Johnson and Holmquist 1994; manual 3-35, 3-36), with
// P* = p/Phel, T* = T/Phel and the rate factor f = 1 + C ln(rate/epso), 1 below epso:
//   sigma_y = Shel [(1 - D) A (P* + T*)^N f + D min(B P*^M f, SFMax)],   D = sum of d epef/(D1 (P* + T*)^D2)
//   p = K1 mu + K2 mu^2 + K3 mu^3 + dP  (mu < 0: K1 mu + dP), no lower than -T (1 - D), K1 = the bulk modulus
//   dP <- sqrt((K1 mu + dP)^2 + 2 beta K1 dU) - K1 mu,  dU = (sigma_y^2 before - after)/(6 G)
// where dU is for the strength lost to damage in the step. dP is constant in expansion and grows in
// compression only. The manual limits the tension only through the name of T: T (1 - D) is the limit of its
// HJC. The pressure is CeramicBulk's, so an EquationOfState is rejected. Tested by
// tests/physics/jh2_test.cpp.
#pragma once

#include <string_view>

#include "physics/eos/ceramic_bulk.hpp"
#include "physics/strength/brittle.hpp"

namespace mpm::physics {

struct JH2 : BrittlePlasticity {
  static constexpr std::string_view name = "JH2";
  static constexpr std::string_view summary = "Johnson-Holmquist ceramics (JH-2), pressure included";
  static constexpr std::array state{core::Column::effective_plastic_strain, core::Column::damage,
                                    core::Column::bulking_pressure};
  static constexpr bool own_pressure = true;

  double a = 0, b = 0, c = 0, m = 0, n = 0;
  double epso = 0;  ///< 1/time
  double t = 0;     ///< stress
  double sfmax = 1e20;
  double shel = 0, phel = 0;  ///< stress
  double beta = 0;
  double d1 = 0, d2 = 0;
  double k2 = 0, k3 = 0;         ///< stress
  double reference_density = 0;  ///< derived

  static constexpr auto parameters() {
    using P = JH2;
    return join(
        brittle_parameters<P>(),
        std::array<Parameter<P>, 15>{{
            constant(&P::a, "A", "1", "intact strength"),
            constant(&P::b, "B", "1", "fractured strength"),
            constant(&P::c, "C", "1", "strain-rate constant"),
            constant(&P::m, "M", "1", "exponent of the fractured strength"),
            constant(&P::n, "N", "1", "exponent of the intact strength"),
            constant(&P::epso, "epso", "1/time", "reference strain rate: 1/s in the unit of time of the case",
                     0, true),
            constant(&P::t, "T", "stress", "largest hydrostatic tension"),
            {&P::sfmax,
             {.name = "SFMax",
              .default_value = 1e20,
              .min = 0,
              .min_open = true,
              .meaning = "largest normalised fractured strength"}},
            constant(&P::shel, "Shel", "stress", "equivalent stress at the Hugoniot elastic limit", 0, true),
            constant(&P::phel, "Phel", "stress", "pressure at the Hugoniot elastic limit", 0, true),
            {&P::beta,
             {.name = "beta",
              .required = true,
              .min = 0,
              .max = 1,
              .meaning = "fraction of the elastic energy released by damage that is converted to pressure"}},
            constant(&P::d1, "D1", "1", "strain to fracture: factor"),
            constant(&P::d2, "D2", "1", "strain to fracture: exponent of the pressure"),
            constant(&P::k2, "K2", "stress", "quadratic term of the pressure", -core::unbounded),
            constant(&P::k3, "K3", "stress", "cubic term of the pressure", -core::unbounded),
        }});
  }
  void prepare(double density) {
    derive_moduli();
    reference_density = density;
  }

  CeramicBulk own_eos() const { return {bulk, k2, k3}; }
  TensionRules tension_rules() const { return {.limited = true}; }

  /// sigma_y as intact + (fractured - intact) D
  template <class T>
  struct Strengths {
    T intact, fractured;
    T at(const T& damage) const { return (1.0 - damage) * intact + damage * fractured; }
  };
  template <class T>
  Strengths<T> strengths(const T& pressure, const T& rate) const {
    const T factor = logarithmic_factor(c, rate);
    const T p = pressure * (1 / phel);
    return {(shel * a) * power(T(p + t / phel), n) * factor,
            shel * core::min(core::select(p > 0.0, b * power(p, m) * factor, 0.0), sfmax)};
  }
  template <class T>
  T fracture_strain(const T& pressure) const {
    return d1 * power(T((pressure + t) * (1 / phel)), d2);
  }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    elastic_step(point);
    const Strengths<T> both = strengths(point.pressure, rate_over(point, epso));
    const T damage = point.damage, before = both.at(damage);
    const T increment = return_at_once(point, before, T(shear));
    add_damage(point, increment, fracture_strain(point.pressure));
    bulk_up(point, point.damage > damage, before, both.at(point.damage));
    point.lowest_pressure = -t * (1.0 - point.damage);
  }

 private:
  /// Part of the elastic shear energy released by the loss of strength becomes pressure. Zero without new
  /// damage, despite round-off: the square root would amplify it.
  template <class T>
  void bulk_up(StrengthPoint<T>& point, core::MaskOf<T> damaged, const T& before, const T& after) const {
    const T elastic = bulk * (point.density * (1 / reference_density) - 1.0);  // K1 mu
    const T lost = (before * before - after * after) * (1 / (6 * shear));
    const T old = elastic + point.bulking_pressure;
    const T bulking = sqrt(old * old + (2 * beta * bulk) * core::max(lost, 0.0)) - elastic;
    point.bulking_pressure =
        core::select(damaged & (elastic > 0.0) & (lost > 0.0), bulking, point.bulking_pressure);
  }
};

}  // namespace mpm::physics
