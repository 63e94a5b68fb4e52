// The largest speeds of a batch or block, and the resulting time step limit.
#pragma once

#include <algorithm>
#include <limits>

#include "core/grid/brick_grid.hpp"
#include "core/material/batch.hpp"
#include "core/simd/lanes.hpp"
#include "core/step/wave_limit.hpp"

namespace mpm::core {

/// Largest stable step without the scene's factor (thesis 2-51, 2-74): the smallest cell edge over the
/// largest (Q + sqrt(Q^2 + c^2))/wave_limit + |v|.
inline double critical_step(const BrickGrid& grid, double fastest) {
  return fastest > 0 ? grid.geometry().smallest_cell() / fastest : std::numeric_limits<double>::infinity();
}

/// Maximum of `most` and the first `used` lanes.
inline double largest_lane(Real value, int used, double most) {
  double each[real_width];
  store(each, value);
  for (int i = 0; i < std::min(used, real_width); ++i) most = std::max(most, each[i]);
  return most;
}

/// Squared speeds of a block's particles from a lane on.
inline Real squared_speed(const ColumnLayout& layout, const double* block, int lane) {
  const double* v = block + layout.offset(Column::velocity_x) + lane;
  const Real x = load<Real>(v), y = load<Real>(v + block_lanes), z = load<Real>(v + 2 * block_lanes);
  return x * x + y * y + z * z;
}

/// The largest wave speed of the batch.
inline double fastest_wave(const Batch& batch) {
  double most = 0;
  for (int i = 0; i < batch.particles; i += real_width)
    most = largest_lane(load<Real>(batch.critical_speed + i), batch.particles - i, most);
  return most;
}

/// Maximum of `most` and of the particles' wave speed times `weight` plus speed. The square root is taken
/// only where the sum may exceed `most`, which a comparison of squares with a margin for rounding decides.
inline double fastest_particle(const Batch& batch, double weight, double most) {
  for (int i = 0; i < batch.particles; i += real_width) {
    const Real wave = Real(weight) * load<Real>(batch.critical_speed + i), room = Real(most) - wave;
    const Real v2 = squared_speed(*batch.layout, batch.block[i / block_lanes], i % block_lanes);
    if (any((room < Real(0.0)) | (v2 > Real(1 - 1e-12) * room * room)))
      most = largest_lane(wave + sqrt(v2), batch.particles - i, most);
  }
  return most;
}

}  // namespace mpm::core
