// Brittle materials along the simplest path: compressed at once to a volume, then sheared at that volume
// without spin, so that the pressure stands still and the von Mises stress is sqrt(3) s_xy.
#pragma once

#include <cmath>

#include "physics/point/point_driver.hpp"

namespace mpm::tests {

/// Equal compression in all directions to V/V0, in `steps` steps.
inline void compress_to(physics::PointDriver& point, double relative_volume, int steps = 1, double dt = 1) {
  const double start = point.volume_ratio();
  for (int i = 1; i <= steps; ++i) {
    const double target = start + (relative_volume - start) * i / steps;
    const double rate = (target / point.volume_ratio() - 1) / dt / 3;
    point.step({rate, 0, 0, 0, rate, 0, 0, 0, rate}, dt);
  }
}

/// Pure shear by an equivalent strain sqrt(2/3 e':e') in one step.
inline void shear_by(physics::PointDriver& point, double equivalent_strain, double dt = 1) {
  const double e = 0.5 * std::sqrt(3.0) * equivalent_strain / dt;
  point.step({0, e, 0, e, 0, 0, 0, 0, 0}, dt);
}

}  // namespace mpm::tests
