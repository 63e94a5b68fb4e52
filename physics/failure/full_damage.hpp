// Fails where a strength law's damage has reached one (manual 3-4, thesis 2-137), or the law's own threshold.
// Not an input type: every strength law that fails by damage includes it. With DamageRandom the threshold
// scatters, up to one at most (manual 3.2.4). Without damage nothing fails, whatever the threshold.
#pragma once

#include "physics/failure/point.hpp"

namespace mpm::physics {

struct FullDamage {
  static constexpr std::array state{core::Column::damage};

  double threshold = 1;
  bool scatters = false;

  template <class T>
  core::MaskOf<T> fails(const FailurePoint<T>& point) const {
    const core::MaskOf<T> damaged = point.damage > 0.0;
    if (!scatters) return (point.damage >= threshold) & damaged;
    return (point.damage >= core::min(point.threshold_factor * threshold, 1.0)) & damaged;
  }
};

}  // namespace mpm::physics
