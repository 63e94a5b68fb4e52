// Fails where a strength law's damage has reached one (manual 3-4, thesis 2-137). Not a type of the input: it
// comes with every strength law that carries damage.
#pragma once

#include "physics/failure/point.hpp"

namespace mpm::physics {

struct FullDamage {
  static constexpr std::array state{core::Column::damage};

  template <class T>
  core::MaskOf<T> fails(const FailurePoint<T>& point) const {
    return point.damage >= 1.0;
  }
};

}  // namespace mpm::physics
