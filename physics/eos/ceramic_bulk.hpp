// The pressure of JH2 (manual 3.2.1.15; Johnson and Holmquist 1994), not an input type:
//   p = K1 mu + K2 mu^2 + K3 mu^3 + dP for mu > 0,   K1 mu + dP for mu < 0
// dP is the bulking pressure, which the strength model stores. The energy of a body placed at another density
// is the work from the reference density to it. Tested by tests/physics/jh2_test.cpp.
#pragma once

#include <array>

#include "core/simd/math.hpp"
#include "physics/eos/point.hpp"

namespace mpm::physics {

struct CeramicBulk {
  static constexpr std::array state{core::Column::bulking_pressure};

  double k1 = 0, k2 = 0, k3 = 0;  ///< stress

  template <class T>
  LinearisedPressure<T> linearise(const EosPoint<T>& point) const {
    const T mu = point.compression, c = core::max(mu, 0.0);
    return {k1 * mu + c * c * (k2 + k3 * c) + point.bulking_pressure, 0.0, k1 + c * (2 * k2 + (3 * k3) * c),
            0.0};
  }

  template <class T>
  void initialise(EosPoint<T>& point) const {
    using core::log;
    // The integral of p d(mu)/(1 + mu)^2 from zero.
    const T u = 1.0 + point.compression, v = point.relative_volume, log_u = log(u);
    const T linear = log_u + v - 1.0;
    const T quadratic = point.compression - 2.0 * log_u - v + 1.0;
    const T cubic = 0.5 * (u * u - 1.0) - 3.0 * point.compression + 3.0 * log_u + v - 1.0;
    point.energy = k1 * linear + core::select(u > 1.0, k2 * quadratic + k3 * cubic, 0.0);
  }
};

}  // namespace mpm::physics
