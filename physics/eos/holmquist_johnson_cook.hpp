// Pressure of Holmquist-Johnson-Cook concrete (Holmquist, Johnson and Cook 1993; manual 3-53 to 3-58). With
// mu_m the largest compression so far and m(mu) = (mu - MuLock)/(1 + MuLock):
//   mu_m <= MuCrush   p = Kel mu,   Kel = PCrush/MuCrush
//   mu_m <= mu_plock  p = PCrush + Ktr (mu_m - MuCrush) + [(1 - F) Kel + F K1](mu - mu_m),
//                     Ktr = (PLock - PCrush)/(mu_plock - MuCrush), F = (mu_m - MuCrush)/(mu_plock - MuCrush)
//   beyond            p = K1 m + K2 m^2 + K3 m^3 at mu_m, + K1 [m(mu) - m(mu_m)]
// Loading is mu = mu_m. mu_plock is where the third line reaches PLock; the manual's 3-56 is that value for
// K2 = K3 = 0 and otherwise causes a jump in the pressure. mu_p, the compression that remains after unloading
// to p = 0, is recorded for the strength model's damage until the pores are closed. No heat. The tension
// limit is the strength model's. Tested by tests/physics/holmquist_johnson_cook_test.cpp.
#pragma once

#include <string>
#include <string_view>

#include "physics/eos/point.hpp"
#include "physics/parameter_rows.hpp"

namespace mpm::physics {

struct HolmquistJohnsonCookBulk {
  static constexpr std::string_view name = "HolmquistJohnsonCook";
  static constexpr std::string_view summary = "crushing and locking concrete, stiffer in unloading";
  static constexpr std::array state{core::Column::max_compression, core::Column::plastic_volumetric_strain};

  double p_crush = 0;  ///< stress
  double mu_crush = 0;
  double k1 = 0, k2 = 0, k3 = 0;  ///< stress
  double p_lock = 0;              ///< stress
  double mu_lock = 0;
  double poisson = 0;
  double elastic = 0, transition = 0, mu_plock = 0;  ///< Kel, Ktr, derived

  static constexpr auto parameters() {
    using P = HolmquistJohnsonCookBulk;
    constexpr auto positive = [](double P::*member, std::string_view name, std::string_view dimension,
                                 std::string_view meaning) {
      return Parameter<P>{member,
                          {.name = name,
                           .required = true,
                           .min = 0,
                           .min_open = true,
                           .dimension = dimension,
                           .meaning = meaning}};
    };
    return std::array<Parameter<P>, 8>{{
        positive(&P::p_crush, "PCrush", "stress", "pressure where pores begin to close"),
        positive(&P::mu_crush, "MuCrush", "1", "compression at PCrush"),
        positive(&P::k1, "K1", "stress", "linear term of the dense material"),
        {&P::k2,
         {.name = "K2",
          .required = true,
          .dimension = "stress",
          .meaning = "quadratic term of the dense material"}},
        {&P::k3,
         {.name = "K3",
          .required = true,
          .dimension = "stress",
          .meaning = "cubic term of the dense material"}},
        positive(&P::p_lock, "PLock", "stress", "pressure where all pores are closed, > PCrush"),
        positive(&P::mu_lock, "MuLock", "1", "compression of the dense material at no pressure"),
        {&P::poisson, poisson_row("accepted but not used: the shear modulus is that of the strength model")},
    }};
  }
  std::string fault() const {
    if (!(p_lock > p_crush)) return "PLock must be greater than PCrush";
    const double m = dense_compression();
    if (!(m > 0)) return "PLock is not reached by K1 m + K2 m^2 + K3 m^3: check K2 and K3";
    if (!(mu_lock + m * (1 + mu_lock) > mu_crush))
      return "MuCrush must be smaller than the locking compression";
    return {};
  }
  void prepare() {
    elastic = p_crush / mu_crush;
    mu_plock = mu_lock + dense_compression() * (1 + mu_lock);
    transition = (p_lock - p_crush) / (mu_plock - mu_crush);
  }

  template <class T>
  LinearisedPressure<T> linearise(EosPoint<T>& point) const {
    using core::max;
    const T mu = point.compression, top = max(point.max_compression, mu);
    const Branch<T> from = branch(top);
    // Compression after unloading; constant for the dense material.
    const T crushed = core::min(top, mu_plock);
    const Branch<T> pores = branch(crushed);
    const T left = core::select(crushed > mu_crush, crushed - pores.pressure / pores.unloading, 0.0);
    point.max_compression = top;
    point.plastic_volumetric_strain = max(point.plastic_volumetric_strain, left);
    const T stiffness = core::select(mu < top, from.unloading, max(from.unloading, from.loading));
    return {from.pressure + from.unloading * (mu - top), 0.0, stiffness, 0.0};
  }

 private:
  template <class T>
  struct Branch {
    T pressure, loading, unloading;
  };
  /// On the virgin curve at the compression mu: pressure, its slope, and the slope of unloading from there.
  template <class T>
  Branch<T> branch(const T& mu) const {
    using core::select;
    const double locked = 1 / (1 + mu_lock);
    const T f = (mu - mu_crush) * (1 / (mu_plock - mu_crush));
    const T m = core::max((mu - mu_lock) * locked, 0.0);
    const core::MaskOf<T> crushing = mu > mu_crush, dense = mu > mu_plock;
    return {select(dense, m * (k1 + m * (k2 + m * k3)),
                   select(crushing, p_crush + transition * (mu - mu_crush), elastic * mu)),
            select(dense, locked * (k1 + m * (2 * k2 + m * (3 * k3))),
                   select(crushing, T(transition), T(elastic))),
            select(dense, T(locked * k1), select(crushing, elastic + f * (k1 - elastic), T(elastic)))};
  }
  double dense(double m) const { return m * (k1 + m * (k2 + m * k3)); }
  /// Smallest m with dense(m) = PLock; 0 if there is none below ten times the linear solution.
  double dense_compression() const {
    const double step = p_lock / k1 / 256;
    double low = 0;
    while (dense(low + step) < p_lock) {
      low += step;
      if (low > 2560 * step) return 0;
    }
    double high = low + step;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (dense(middle) < p_lock ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
};

}  // namespace mpm::physics
