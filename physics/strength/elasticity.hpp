// Isotropic linear elasticity of the deviator, the base of most strength laws: Young and Poisson, the derived
// moduli, and the trial stress s + 2 G de' of the Jaumann rate form (thesis 2-93 to 2-95, 2-100).
#pragma once

#include <array>

#include "core/simd/dual.hpp"
#include "physics/parameter_rows.hpp"
#include "physics/strength/point.hpp"

namespace mpm::physics {

struct IsotropicElasticity {
  double young = 0;  ///< stress
  double poisson = 0;
  double shear = 0;  ///< G, derived
  double bulk = 0;   ///< K, derived

  void derive_moduli() {
    shear = young / (2 * (1 + poisson));
    bulk = young / (3 * (1 - 2 * poisson));
  }

  /// Replaces s by the trial stress.
  template <class T>
  void elastic_step(StrengthPoint<T>& point) const {
    point.s = point.s + T(2 * shear) * point.strain;
    point.shear_modulus = shear;
  }

  /// The same, and the trial pressure (2-97), for laws with `sets_pressure`.
  template <class T>
  void elastic_step_with_pressure(StrengthPoint<T>& point) const {
    elastic_step(point);
    point.pressure = point.pressure - bulk * point.volumetric_strain;
    point.bulk_modulus = bulk;
  }

  /// For laws with `sets_pressure`: sets the pressure of a new particle of relative volume v = V/V0 and
  /// returns its energy, the elastic work from the reference volume (as ElasticBulk does).
  template <class T>
  T place(StrengthPoint<T>& point, const T& v) const {
    using core::log;
    const T log_v = log(v);
    point.pressure = -bulk * log_v;
    return bulk * (v * log_v - v + 1.0);
  }
};

template <class Law>
constexpr auto elastic_parameters() {
  return std::array<Parameter<Law>, 2>{{{&Law::young, young_row}, {&Law::poisson, poisson_row()}}};
}

}  // namespace mpm::physics
