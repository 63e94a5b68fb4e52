// The largest speeds of a batch or block, and the resulting time step limit.
#pragma once

#include <algorithm>
#include <limits>

#include "core/grid/brick_grid.hpp"
#include "core/material/batch.hpp"
#include "core/scene/scene.hpp"
#include "core/simd/lanes.hpp"

namespace mpm::core {

/// Largest stable time step of a scheme with these shape functions, over the time in which a wave crosses the
/// smallest cell edge. Above 1, since a particle's functions average over more than a cell; below, where the
/// strains follow the velocities with more noise. benchmarks/stability/limits.py found by bisection the
/// largest steps without growth of the energy (elastic block and fluid that drift across cells, copper bar
/// and shock); these are 2 to 5 % below, and linear functions with MUSL keep the thesis' 1. Over 100,000
/// steps (long_runs.py: an elastic block with the default viscosity) USL and USF need shorter ones, as a
/// particle that has crept to the edge of a cell is unstable there; their limits are the largest that held.
/// With USAVG `linear` has the step at which one particle in a cell does not gain energy, either; CPDI2
/// failed after 70,000 steps with 1.2, and not with 1.
///
///                 MUSL            USAVG           USF             USL
///                 block fluid bar, each
///   linear        0.95 0.99 1.3   1.2  1.0  1.3   1.2  1.2  1.3   0.67 0.64 0.73
///   SGMP          1.5  1.3  2.2   1.7  1.4  2.2   1.3  1.1  2.3   1.0  0.80 1.2
///   DDMP          1.5  1.0  1.7   1.4  1.1  1.7   0.64 0.95 1.7   0.99 0.77 1.1
///   uGIMP         1.5  1.0  1.5   1.5  1.3  1.6   0.77 1.2  1.7   0.80 0.73 0.77
///   cpGIMP        1.5  1.0  1.5   1.5  1.3  1.6   0.77 1.2  1.7   0.80 0.77 0.77
///   CPDI, CPDI2   1.6  1.0  1.6   1.6  1.3  1.7   0.80 1.2  1.7   0.80 0.77 0.77
///   quadratic     1.6  1.2  1.8   1.7  1.3  1.8   1.0  1.1  1.9   1.0  0.73 1.1
///   cubic         1.5  1.3  2.0   1.7  1.4  2.1   1.4  1.1  2.1   1.3  1.0  1.4
/// Over 100,000 steps USF: cpGIMP 0.6 (not 0.68); linear has a remedy of its own (face_traps.hpp); USL:
/// linear 0.24 (not 0.3), DDMP 0.58 (not 0.66), uGIMP and cpGIMP 0.56 (not 0.63). XPIC and FMPM allow longer
/// steps than FLIP (not linear with FMPM: fluid 0.87, stable at factor 1 by the weight of tension, below;
/// with USAVG FMPM has MUSL's limits: 1.1 in the fluid with GIMP and CPDI), affine transfers shorter ones,
/// with USAVG as with MUSL; fluid, the smaller of APIC and TPIC | AFLIP:
///   uGIMP, cpGIMP 0.73 | 0.64         0.64 | 0.67         0.23 | 0.2
///   quadratic     0.87 | 0.59         0.87 | 0.59         0.42 | below 0.2
///   cubic         1.1  | 0.77         1.1  | 0.80         0.44 | below 0.2
inline double wave_limit(ShapeFunction shape, Scheme scheme, Transfer transfer) {
  const auto by_scheme = [scheme](double musl, double usf, double usl) {
    return scheme == Scheme::usf ? usf : scheme == Scheme::usl ? usl : musl;
  };
  if (scheme == Scheme::usavg && !is_affine(transfer) && transfer != Transfer::fmpm) {
    switch (shape) {
      case ShapeFunction::sgmp:
      case ShapeFunction::cubic_bspline: return 1.3;
      case ShapeFunction::quadratic_bspline: return 1.25;
      case ShapeFunction::ddmp: return 1.05;
      case ShapeFunction::linear: return 0.85;
      case ShapeFunction::cpdi:
      case ShapeFunction::cpdi2: return 1;
      default: return 1.2;
    }
  }
  if (is_affine(transfer)) {
    const bool aflip = transfer == Transfer::aflip;
    switch (shape) {
      case ShapeFunction::quadratic_bspline:
        return aflip ? by_scheme(0.57, 0.57, 0.15) : by_scheme(0.85, 0.85, 0.4);
      case ShapeFunction::cubic_bspline:
        return aflip ? by_scheme(0.75, 0.75, 0.15) : by_scheme(1.1, 1.1, 0.42);
      default: return aflip ? by_scheme(0.62, 0.62, 0.15) : by_scheme(0.7, 0.62, 0.22);
    }
  }
  switch (shape) {
    case ShapeFunction::sgmp: return by_scheme(1.25, 1.1, 0.75);
    case ShapeFunction::ddmp: return by_scheme(1, 0.62, 0.57);
    case ShapeFunction::uniform_gimp: return by_scheme(1, 0.75, 0.55);
    case ShapeFunction::contiguous_particle_gimp: return by_scheme(1, 0.6, 0.55);
    case ShapeFunction::cpdi:
    case ShapeFunction::cpdi2: return by_scheme(1, 0.75, 0.7);
    case ShapeFunction::quadratic_bspline: return by_scheme(1.2, 0.95, 0.7);
    case ShapeFunction::cubic_bspline: return by_scheme(1.25, 1.1, 0.95);
    default: return by_scheme(1, 0.5, 0.24);
  }
}
/// With the consistent mass matrix, which does not smooth the nodes' forces. The least of the
/// measured, block and fluid: linear 0.3 (not 0.45), DDMP 0.37, GIMP 0.52, quadratic 0.57, cubic 0.65, SGMP
/// 0.77.
inline double consistent_wave_limit(ShapeFunction shape) {
  switch (shape) {
    case ShapeFunction::sgmp:
    case ShapeFunction::cubic_bspline: return 0.6;
    case ShapeFunction::quadratic_bspline: return 0.55;
    case ShapeFunction::uniform_gimp:
    case ShapeFunction::contiguous_particle_gimp: return 0.5;
    case ShapeFunction::ddmp: return 0.35;
    default: return 0.28;
  }
}
inline double wave_limit(const Scene& scene) {
  if (scene.solution.mass == MassMatrix::consistent) return consistent_wave_limit(scene.grid.shape);
  return wave_limit(scene.grid.shape, scene.solution.scheme, scene.solution.transfer);
}

/// Weight of a fluid's critical speed while it is in tension, which pulls particles together: functions with
/// kinks then gain energy below the limits above. Of a dam break (12,800 particles, a fluid that bears
/// tension) at a factor of 0.9 the energy grew by 24 % with linear functions and MUSL, 3.3 % with USF, 5.6 %
/// with uGIMP; with these weights it stays within 1 %.
inline double tension_weight(const Scene& scene) {
  const bool implicit = scene.solution.integration == Integration::implicit;
  if (implicit || scene.solution.scheme == Scheme::usl) return 1;
  if (scene.grid.shape == ShapeFunction::linear) return scene.solution.scheme == Scheme::musl ? 3 : 2.6;
  return scene.grid.shape == ShapeFunction::uniform_gimp ? 1.6 : 1;
}

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
