// Riedel-Hiermaier-Thoma concrete (Riedel, Thoma and Hiermaier 1999; manual 3-21 to 3-34), p* = p/fc:
//   Yfail = fc Y(p/Fr) R3 Fr,   Yel = fc Y(p/(Fr Fe)) R3 Fr Fe Fcap,   Yres = fc min(B p*^M, SFMax)
//   until Yfail is reached:  min(Yel + 3 G epef/PREFACT, Yfail), which is 3-29 with 3-30;
//   then: (1 - D) Yfail + D Yres,   D = sum of d epef/max(D1 (p* + ft/fc)^D2, EFMin),   G (1 - D + SHRATD D)
// Y, R3, Fr, Fe, Fcap: see below. Rates are over 3e-5 (compression) and 3e-6 (tension) epso, with epso one
// per second; below them Fr is 1. The cap ends at Pcrush of the equation of state. No pressure is lower than
// (1 - D) Fr times the tip of Y, as in LS-DYNA's law 272 (Borrvall and Riedel 2011). The manual's ft and fs
// are on the compressive meridian: other directions are lower by R3. D = 1 leaves the residual strength.
// Tested by tests/physics/rht_test.cpp.
#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "physics/eos/traits.hpp"
#include "physics/strength/brittle.hpp"

namespace mpm::physics {

/// cos(theta) of the Lode angle theta, 0 <= theta <= pi/3, from cos(3 theta) = x within -1 and 1. With
/// cos(theta) = 1/2 + u: u^2 (6 + 4 u) = 1 + x, Newton's method for its root u sqrt(6 + 4 u) = sqrt(1 + x).
template <class T>
T cosine_of_lode_angle(const T& x) {
  const T root = sqrt(core::max(1.0 + x, 0.0));
  T u = root * (1 / std::sqrt(7.0));
  for (int i = 0; i < 5; ++i) {
    const T w = sqrt(6.0 + 4.0 * u);
    u = u - (u * w - root) / (w + 2.0 * u / w);
  }
  return 0.5 + u;
}

/// det s
template <class T>
T third_invariant(const core::Sym3<T>& s) {
  return s.xx * (s.yy * s.zz - s.yz * s.yz) - s.xy * (s.xy * s.zz - s.yz * s.xz) +
         s.xz * (s.xy * s.yz - s.yy * s.xz);
}

struct RHT : BrittlePlasticity {
  static constexpr std::string_view name = "RHT";
  static constexpr std::string_view summary = "Riedel-Hiermaier-Thoma concrete";
  static constexpr std::array state{core::Column::effective_plastic_strain, core::Column::damage};
  static constexpr bool follows_strain_rate = true;

  double fc = 0;          ///< stress
  double ft = 0, fs = 0;  ///< over fc
  double a = 0, n = 0, q20 = 0, bq = 0;
  double prefact = 0, tensrat = 0, comprat = 0;
  double b = 0, m = 0, alpha = 0, delta = 0;
  double epso = 0;  ///< 1/time
  double sfmax = 1e20, cap_flag = 1;
  double d1 = 0, d2 = 0, efmin = 0, shratd = 0;
  double cap_end = 0;  ///< pressure at the end of the cap over fc, of the equation of state

  static constexpr auto parameters() {
    using P = RHT;
    return join(
        brittle_parameters<P>(),
        std::array<Parameter<P>, 21>{{
            constant(&P::fc, "fc", "stress", "uniaxial compressive strength", 0, true),
            constant(&P::ft, "ft_fc", "1", "tensile over compressive strength", 0, true),
            constant(&P::fs, "fs_fc", "1", "shear over compressive strength, > ft_fc", 0, true),
            constant(&P::a, "A", "1", "failure surface: factor", 0, true),
            constant(&P::n, "N", "1", "failure surface: exponent of the pressure", 0, true),
            constant(&P::q20, "Q20", "1", "tensile over compressive meridian at no pressure", 0, true),
            constant(&P::bq, "BQ", "1", "growth of that ratio with pressure", -core::unbounded),
            constant(&P::prefact, "PREFACT", "1", "elastic over elastic less plastic shear modulus", 0, true),
            {&P::tensrat,
             {.name = "TENSRAT",
              .required = true,
              .min = 0,
              .max = 1,
              .min_open = true,
              .meaning = "elastic limit over strength, tension"}},
            {&P::comprat,
             {.name = "COMPRAT",
              .required = true,
              .min = 0,
              .max = 1,
              .min_open = true,
              .meaning = "elastic limit over strength, compression"}},
            constant(&P::b, "B", "1", "residual strength: factor"),
            constant(&P::m, "M", "1", "residual strength: exponent of the pressure"),
            constant(&P::alpha, "alpha", "1", "rate exponent, compression"),
            constant(&P::delta, "delta", "1", "rate exponent, tension"),
            constant(&P::epso, "epso", "1/time",
                     "unit of the strain rate: 1/s in the unit of time of the case", 0, true),
            {&P::sfmax,
             {.name = "SFMax",
              .default_value = 1e20,
              .min = 0,
              .min_open = true,
              .meaning = "largest normalised residual strength"}},
            flag(&P::cap_flag, "CapFlag", "1: the elastic limit is capped at Pcrush of the EquationOfState",
                 1),
            constant(&P::d1, "D1", "1", "strain to fracture: factor"),
            constant(&P::d2, "D2", "1", "strain to fracture: exponent of the pressure"),
            constant(&P::efmin, "EFMin", "1", "smallest strain to fracture"),
            {&P::shratd,
             {.name = "SHRATD",
              .required = true,
              .min = 0,
              .max = 1,
              .meaning = "shear modulus of the fractured over that of the intact material"}},
        }});
  }
  std::string fault() const {
    return fs > ft ? ""
                   : "fs_fc must be greater than ft_fc: the failure surface would have no tip in tension";
  }
  void prepare() { derive_moduli(); }
  std::string couple(const EosTraits& eos) {
    if (cap_flag == 0) return {};
    if (eos.crush_pressure) {
      cap_end = *eos.crush_pressure / fc;
      if (cap_end > 1.0 / 3) return {};
    }
    return "CapFlag 1 needs an EquationOfState with a crush pressure above fc/3 (PAlpha); set CapFlag to 0 "
           "without";
  }
  TensionRules tension_rules() const { return {.limited = true}; }

  /// Y of 3-24, the compressive meridian over fc
  template <class T>
  T compressive_meridian(const T& p) const {
    const T tension = fs + (3 * (fs / ft - 1)) * p;
    const T shear_to_compression = fs + (3 * (1 - fs)) * p;
    const T compression = a * power(T(p + (std::pow(1 / a, 1 / n) - 1.0 / 3)), n);
    return core::max(
        core::select(p < 1.0 / 3, core::select(p < 0.0, tension, shear_to_compression), compression), 0.0);
  }
  /// From `tensile` at p = -ft/3 to `compressive` at fc/3, constant outside.
  template <class T>
  T between(const T& p, const T& tensile, const T& compressive) const {
    const T share = core::min(core::max((3.0 * p + ft) * (1 / (1 + ft)), 0.0), 1.0);
    return tensile + share * (compressive - tensile);
  }
  /// Fr of 3-22 for a strain rate over epso
  template <class T>
  T rate_factor(const T& p, const T& rate) const {
    using core::pow;
    return between(p, T(pow(core::max(rate * (1 / 3e-6), 1.0), delta)),
                   T(pow(core::max(rate * (1 / 3e-5), 1.0), alpha)));
  }
  /// R3 of 3-23 (Willam and Warnke 1975) for the direction of a deviatoric stress
  template <class T>
  T meridian_ratio(const T& p, const core::Sym3<T>& s, const T& equivalent) const {
    using core::max;
    using core::min;
    const T cube = equivalent * equivalent * equivalent;
    const T cos3 = core::select(cube > 0.0, 13.5 * third_invariant(s) / cube, 0.0);
    const T c = cosine_of_lode_angle(T(min(max(cos3, -1.0), 1.0)));
    const T q = min(max(q20 + bq * p, 0.5), 1.0);
    const T e = 1.0 - q * q, f = 2.0 * q - 1.0, g = 4.0 * e * c * c;
    return (2.0 * e * c + f * sqrt(max(g + 5.0 * q * q - 4.0 * q, 0.0))) / (g + f * f);
  }
  /// Fcap of 3-27
  template <class T>
  T cap(const T& p) const {
    if (cap_flag == 0) return 1.0;
    const T share = core::min(core::max((p - 1.0 / 3) * (1 / (cap_end - 1.0 / 3)), 0.0), 1.0);
    return sqrt(1.0 - share * share);
  }

  template <class T>
  struct Surfaces {
    T elastic, failure, residual, tip;  ///< tip: the pressure where the failure surface ends
  };
  /// For the pressure, the direction of s (with von Mises stress `equivalent`) and the rate over epso.
  template <class T>
  Surfaces<T> surfaces(const T& pressure, const core::Sym3<T>& s, const T& equivalent, const T& rate) const {
    const T p = pressure * (1 / fc);
    const T fr = rate_factor(p, rate), fe = between(p, T(tensrat), T(comprat));
    const T direction = fc * meridian_ratio(p, s, equivalent) * fr;
    return {direction * fe * cap(p) * compressive_meridian(T(p / (fr * fe))),
            direction * compressive_meridian(T(p / fr)),
            fc * core::min(core::select(p > 0.0, b * power(p, m), 0.0), sfmax),
            (-fc * fs * ft / (3 * (fs - ft))) * fr};
  }
  template <class T>
  T fracture_strain(const T& pressure) const {
    return core::max(d1 * power(T(pressure * (1 / fc) + ft), d2), efmin);
  }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    using core::max;
    using core::select;
    const T modulus = shear * (1.0 - (1 - shratd) * point.damage);
    point.s = point.s + (2.0 * modulus) * point.strain;
    point.shear_modulus = modulus;
    const T trial = mises(point.s);
    const Surfaces<T> y = surfaces(point.pressure, point.s, trial, rate_over(point, epso));

    // Hardening 3 G/PREFACT up to the failure surface, then softening, with the damage at the beginning of
    // the step.
    const double hardening = 3 * shear / prefact;
    const T before = core::min(y.elastic + hardening * point.effective_plastic_strain, y.failure);
    const T hardened = max(trial - before, 0.0) * (1 / (3 * shear + hardening));
    const core::MaskOf<T> intact = point.damage <= 0.0;
    const core::MaskOf<T> below = before + hardening * hardened < y.failure;
    const T strength =
        select(intact, y.failure, (1.0 - point.damage) * y.failure + point.damage * y.residual);
    const T flow = max(trial - strength, 0.0) / (3.0 * modulus);
    const T increment = select(intact & below, hardened, flow);
    const T after = select(intact & below, before + hardening * hardened, strength);
    radial_return(point, trial, select(intact, before, strength), after, increment);

    const T to_failure = (y.failure - before) * (1 / hardening);
    const T damaging = select(intact, select(below, 0.0, max(increment - to_failure, 0.0)), increment);
    add_damage(point, damaging, fracture_strain(point.pressure));
    point.lowest_pressure = (1.0 - point.damage) * y.tip;
  }
};

}  // namespace mpm::physics
