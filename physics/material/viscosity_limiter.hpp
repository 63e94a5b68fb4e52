// Limiter of the artificial viscosity (StrengthModel limiter="shock"): a factor alpha of both of its terms, 1
// in shocks and 0 where compression does not grow. L. Cullen and W. Dehnen, Inviscid smoothed particle
// hydrodynamics, MNRAS 408 (2010) 669, eqs. 13 to 18 with alpha_max = 1. With D = div v and S the deviator of
// the rate of deformation:
//   A = xi max(-dD/dt, 0),   xi = (b D)^2/((b D)^2 + S : S),   b = 2 (1 - R)^4
//   alpha_loc = min(w^2 A/v^2, 1) <= alpha,   dalpha/dt = 2 l v (alpha_loc - alpha)/h,   l = 0.05
// Theirs is alpha_loc = w^2 A/(v^2 + w^2 A), which is far from 1 in most shocks; the minimum is that of the
// code Phantom (D. J. Price et al., PASA 35 (2018) e031). Of the particle alone: R = sign D where theirs is a
// mean over neighbours, and dD/dt is the difference of two steps. h is the cell size, v = c + h max(-D, 0),
// and w = 6 h about twice the width of a shock. Shown by tests/physics/viscosity_limiter_test.cpp and
// tests/system/physics_line.py.
#pragma once

#include <limits>

#include "core/material/batch.hpp"
#include "physics/material/kinematics.hpp"

namespace mpm::physics {

/// w/h. Less takes viscosity from weak shocks; more leaves it to the noise of particles that cross cells.
inline constexpr double shock_width = 6;
/// What the column viscosity_factor holds before a particle's first step, in which dD/dt is unknown.
inline constexpr double factor_unknown = -1;

/// alpha at the end of the step; `volumetric_strain`: of the step, `sound_speed`: the one in the viscosity.
/// The columns viscosity_factor and velocity_divergence are those of the particle. Needs a cell size above 0.
template <class T>
T limit_viscosity(const core::Batch& batch, int row, double* factor, double* divergence,
                  const T& volumetric_strain, const T& sound_speed) {
  using core::max;
  using core::min;
  constexpr double lowest = std::numeric_limits<double>::min(), in_compression = 2 * 16;  // b at R = -1
  // The velocity changes once in a step, before the half of the strain at its end.
  const bool changed = batch.part != core::StrainPart::second_half;
  const double between = batch.part == core::StrainPart::first_half ? 2 * batch.dt : batch.dt;
  const double h = batch.cell_size, dt = batch.dt, width = shock_width * h, decay = 2 * 0.05 * dt;
  const T d = (1 / dt) * volumetric_strain, compression = max(-d, 0.0);
  const T alpha = core::load<T>(factor), before = core::load<T>(divergence);
  const core::Sym3<T> s = deviator(strain_increment(load_gradient<T>(batch, row), 1.0));
  // In the first step that of motion without forces along one axis, dD/dt = -D^2.
  const T growth =
      core::select(alpha < 0.0, compression * compression, max((1 / between) * (before - d), 0.0));
  const T signal = sound_speed + h * compression;
  const T weight = (in_compression * compression) * (in_compression * compression);
  const T source = (width * width) * growth * weight;
  const T local =
      changed ? min(source / max(signal * signal * (weight + contract(s, s)), lowest), 1.0) : T(0.0);
  const T kept = h / (h + decay * signal);  // backward Euler
  const T now = max(local, local + kept * (max(alpha, 0.0) - local));
  core::store(factor, now);
  if (changed) core::store(divergence, d);
  return now;
}

}  // namespace mpm::physics
