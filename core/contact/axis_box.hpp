// A box along the axes, and which particles are in it.
#pragma once

#include <cmath>

#include "core/particles/columns.hpp"
#include "core/simd/lanes.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

struct AxisBox {
  Vec3<double> lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};  ///< length

  void add(const AxisBox& other) {
    for (int a = 0; a < 3; ++a) {
      lower[a] = std::fmin(lower[a], other.lower[a]);
      upper[a] = std::fmax(upper[a], other.upper[a]);
    }
  }
  bool contains(const Vec3<double>& x) const {
    bool in = true;
    for (int a = 0; a < 3; ++a) in &= lower[a] <= x[a] && x[a] <= upper[a];
    return in;
  }
  /// By so many cells to each side, and a little more for round-off.
  AxisBox wider(double cells, const Vec3<double>& cell) const {
    const Vec3<double> by = (cells + 1e-6) * cell;
    return {lower - by, upper + by};
  }
  /// Bit mask of a block's particles in it.
  unsigned lanes(const ColumnLayout& layout, const double* block, int used) const {
    using Lane = Lanes<block_lanes>;
    const double* x = block + layout.offset(Column::position_x);
    unsigned mask = (1u << used) - 1;
    for (int a = 0; a < 3; ++a) {
      const Lane at = load<Lane>(x + a * block_lanes);
      mask &= bits((at >= Lane(lower[a])) & (at <= Lane(upper[a])));
    }
    return mask;
  }
};

}  // namespace mpm::core
