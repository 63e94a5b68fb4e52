// Fails where a strength law's damage has reached one (manual 3-4, thesis 2-137), or a threshold that the law
// states. Not a type of the input: it comes with the strength laws that fail by damage.
#pragma once

#include "physics/failure/point.hpp"

namespace mpm::physics {

struct FullDamage {
  static constexpr std::array state{core::Column::damage};

  double threshold = 1;

  template <class T>
  core::MaskOf<T> fails(const FailurePoint<T>& point) const {
    return point.damage >= threshold;
  }
};

}  // namespace mpm::physics
