// Laws of a user's own, one of each family, in the style of the built-in ones.
#pragma once

#include "physics/registry.hpp"
#include "physics/strength/plasticity.hpp"

namespace mine {

using mpm::core::Column;
using mpm::physics::Parameter;

/// IsoHarden over again, so that the numbers can be compared.
struct Hardening : mpm::physics::MisesPlasticity {
  static constexpr std::string_view name = "MyHardening";
  static constexpr std::string_view summary = "von Mises with linear hardening, a user's own";
  static constexpr std::array state{Column::effective_plastic_strain};
  double slope = 0;  ///< d(yield stress)/d(plastic strain)

  static constexpr auto parameters() {
    return mpm::physics::join(mpm::physics::plastic_parameters<Hardening>(),
                              std::array<Parameter<Hardening>, 1>{{
                                  {&Hardening::slope,
                                   {.name = "Slope",
                                    .required = true,
                                    .min = 0,
                                    .dimension = "stress",
                                    .meaning = "growth of the yield stress with plastic strain"}},
                              }});
  }
  void prepare() { derive_moduli(); }
  template <class T>
  void update(mpm::physics::StrengthPoint<T>& point) const {
    using mpm::core::max;
    elastic_step(point);
    const T trial = mises(point.s);
    const T yield = yield0 + slope * point.effective_plastic_strain;
    const T increment = max(trial - yield, 0.0) * (1 / (3 * shear + slope));
    radial_return(point, trial, yield, yield + slope * increment, increment);
  }
};

/// Polynomial2 with few coefficients: p = A1 mu + A2 mu^2 + B0 E, in tension without the second.
struct Bulk {
  static constexpr std::string_view name = "MyBulk";
  static constexpr std::string_view summary = "quadratic in the compression, with heat";
  static constexpr std::array<Column, 0> state{};
  double a1 = 0, a2 = 0, b0 = 0;

  static constexpr auto parameters() {
    return std::array<Parameter<Bulk>, 3>{{
        {&Bulk::a1,
         {.name = "A1",
          .required = true,
          .min = 0,
          .min_open = true,
          .dimension = "stress",
          .meaning = "bulk modulus"}},
        {&Bulk::a2,
         {.name = "A2",
          .default_value = 0,
          .dimension = "stress",
          .meaning = "quadratic term",
          .any_number = true}},
        {&Bulk::b0,
         {.name = "B0", .default_value = 0, .min = 0, .max = 5, .meaning = "Grueneisen coefficient"}},
    }};
  }
  template <class T>
  mpm::physics::LinearisedPressure<T> linearise(const mpm::physics::EosPoint<T>& point) const {
    const T mu = mpm::core::max(point.compression, 0.0), tension = mpm::core::min(point.compression, 0.0);
    return {mu * (a1 + a2 * mu) + tension * a1, T(b0), a1 + (2 * a2) * mu, T(0.0)};
  }
};

/// PlaStrain over again.
struct Limit {
  static constexpr std::string_view name = "MyLimit";
  static constexpr std::string_view summary = "plastic strain above a limit";
  static constexpr std::array state{Column::effective_plastic_strain};
  double limit = 0;

  static constexpr auto parameters() {
    return std::array<Parameter<Limit>, 1>{{
        {&Limit::limit,
         {.name = "limit",
          .required = true,
          .min = 0,
          .min_open = true,
          .meaning = "plastic strain at failure"}},
    }};
  }
  template <class T>
  mpm::core::MaskOf<T> fails(const mpm::physics::FailurePoint<T>& point) const {
    return point.effective_plastic_strain > point.threshold_factor * limit;
  }
};

inline mpm::physics::Registry laws() {
  return mpm::physics::Registry().add<Hardening>().add<Bulk>().add<Limit>();
}

}  // namespace mine
