// The pressure of a material without an equation of state: linear elastic in volume, p = p - K tr(de) (thesis
// 2-97), which is p = K ln(rho/rho0) (2-58) in increments. Not an input type; K follows from Young and
// Poisson. The energy of a body placed at another density is the work from the reference density to it.
#pragma once

#include <array>
#include <string_view>

#include "physics/eos/point.hpp"

namespace mpm::physics {

struct ElasticBulk {
  static constexpr std::array<core::Column, 0> state{};
  using has_tangent = ElasticBulk;

  double bulk = 0;  ///< K, stress

  template <class T>
  LinearisedPressure<T> linearise(const EosPoint<T>& point) const {
    return {point.pressure - bulk * point.volumetric_strain, 0.0, bulk * point.relative_volume, 0.0};
  }

  /// p and E of a particle placed at the point's density.
  template <class T>
  void initialise(EosPoint<T>& point) const {
    using core::log;
    const T v = point.relative_volume, log_v = log(v);
    point.pressure = -bulk * log_v;
    point.energy = bulk * (v * log_v - v + 1.0);
  }

  /// Pressure of a failed particle: from the density alone, so that a gap must close before it carries
  /// pressure.
  template <class T>
  T broken_pressure(const EosPoint<T>& point) const {
    using core::log;
    return -bulk * log(point.relative_volume);
  }
};

}  // namespace mpm::physics
