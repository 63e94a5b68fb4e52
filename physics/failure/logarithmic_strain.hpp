// Principal values of the logarithmic strain e = ln V, V^2 = F F^T (Hencky). It equals the sum of strain
// increments where the axes are fixed, is invariant under rotation, returns to zero with the shape, and its
// trace is ln(V/V0).
#pragma once

#include <limits>

#include "core/simd/math.hpp"
#include "core/tensor/principal.hpp"
#include "physics/failure/point.hpp"

namespace mpm::physics {

/// x >= y >= z
template <class T>
core::Vec3<T> principal_strains(const FailurePoint<T>& point) {
  using core::log;
  const core::Vec3<T> x{point.f_xx, point.f_xy, point.f_xz}, y{point.f_yx, point.f_yy, point.f_yz},
      z{point.f_zx, point.f_zy, point.f_zz};
  const core::Vec3<T> squared =
      core::principal_values(core::Sym3<T>{dot(x, x), dot(y, y), dot(z, z), dot(x, y), dot(y, z), dot(x, z)});
  // A stretch below the round-off of the largest one may be computed as zero or less.
  const auto strain = [](const T& square) {
    return 0.5 * log(core::max(square, std::numeric_limits<double>::min()));
  };
  return {strain(squared.x), strain(squared.y), strain(squared.z)};
}

}  // namespace mpm::physics
