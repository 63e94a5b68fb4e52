// First stage: the volume from the velocity gradient L (manual 3.10.5).
//   de = sym(L) dt;   by type: 0 V (1 + tr de), 1 as the background cell, 2 V exp(tr de), 3 V det(I + L dt),
//   4 V0 (1 + e_xx)(1 + e_yy)(1 + e_zz) of the accumulated strain, taken as a ratio from step to step,
//   5 V det(I + L dt/2)/det(I - L dt/2), of the deformation gradient in physics/material/deformation.hpp; no
//     use where one of the two is not positive.
// A volume that would become zero, negative or NaN keeps its old value and is counted; one outside the bounds
// of Volume min/max is set to the bound and counted.
//
// What has failed and bears no tension does not stretch: once its pressure is zero, its fragments keep their
// volume V and part, which opens a void v between them. Compression closes the void first:
//   V + v <- (V + v) ratio,   V <- min(V, V + v)
// Stretched instead, its density would leave the range of any equation of state. At p = a + gamma0 E, with E
// per unit initial volume, compression from V to V0 multiplies an energy by exp(gamma0 (V/V0 - 1)).
//
// A law that lets its material come apart may bound the volume: velocity gradients between particles that
// have lost touch say nothing of their volumes, and a lone particle's own one, which an affine transfer
// returns to it from the grid, never ends.
#pragma once

#include "core/material/batch.hpp"
#include "core/material/constitutive_model.hpp"
#include "core/simd/dual.hpp"
#include "physics/material/vectors.hpp"

namespace mpm::physics {

template <class T>
core::Mat3<T> load_gradient(const core::Batch& batch, int row) {
  const auto get = [&](int i) { return core::load<T>(batch.gradient[i] + row); };
  return {get(0), get(1), get(2), get(3), get(4), get(5), get(6), get(7), get(8)};
}

/// sym(L) dt
template <class T>
core::Sym3<T> strain_increment(const core::Mat3<T>& l, double dt) {
  const double half = 0.5 * dt;
  return {dt * l.xx, dt * l.yy, dt * l.zz, half * (l.xy + l.yx), half * (l.yz + l.zy), half * (l.xz + l.zx)};
}

/// Adds to the accumulated strain, whose six columns are adjacent, and returns its previous value.
template <class T>
core::Sym3<T> accumulate_strain(double* columns, const core::Sym3<T>& increment) {
  const T added[6] = {increment.xx, increment.yy, increment.zz, increment.xy, increment.yz, increment.xz};
  T old[6];
  for (int i = 0; i < 6; ++i) {
    old[i] = core::load<T>(columns + core::block_lanes * i);
    core::store(columns + core::block_lanes * i, old[i] + added[i]);
  }
  return {old[0], old[1], old[2], old[3], old[4], old[5]};
}

/// I + k L
template <class T>
core::Mat3<T> unit_plus(double k, const core::Mat3<T>& l) {
  return {1.0 + k * l.xx, k * l.xy, k * l.xz, k * l.yx,      1.0 + k * l.yy,
          k * l.yz,       k * l.zx, k * l.zy, 1.0 + k * l.zz};
}

/// V^{n+1}/V^n. `strain` is the increment, `accumulated` its sum before it (update type 4 only).
template <class T>
T volume_ratio(int update_type, const core::Mat3<T>& l, double dt, const core::Sym3<T>& strain,
               const core::Sym3<T>& accumulated, const T& cell_strain) {
  using core::exp;
  switch (update_type) {
    case 1: return 1.0 + cell_strain;
    case 2: return exp(trace(strain));
    case 3: return determinant(unit_plus(dt, l));
    case 4: {
      const core::Sym3<T> old = accumulated, now = accumulated + strain;
      return (1.0 + now.xx) * (1.0 + now.yy) * (1.0 + now.zz) /
             ((1.0 + old.xx) * (1.0 + old.yy) * (1.0 + old.zz));
    }
    case 5: {
      const T ahead = determinant(unit_plus(0.5 * dt, l)), behind = determinant(unit_plus(-0.5 * dt, l));
      return core::select((ahead > 0.0) & (behind > 0.0), ahead / behind, 0.0);
    }
    default: return 1.0 + trace(strain);
  }
}

/// The volume limited to Volume min/max, which are factors of the volume at reference density.
template <class T>
T limit_volume(core::Batch& batch, const core::UpdateOptions& options, double reference_density,
               const T& mass, const T& volume, int row) {
  using core::max;
  using core::min;
  const T reference = mass * (1 / reference_density);
  T held = volume;
  if (options.volume_min > 0) held = max(held, options.volume_min * reference);
  if (options.volume_max > 0) held = min(held, options.volume_max * reference);
  const core::MaskOf<T> moved = held != volume;
  if (core::any(moved)) batch.events.volume_limited += count<T>(moved, row, batch.particles);
  return held;
}

/// Divides the volume of failed particles without pressure between their fragments and the void, whose
/// columns it updates; `stretched` is the volume of the others.
template <class T>
T part_fragments(core::Batch& batch, double* block, int row, const T& old_volume, const T& ratio,
                 const T& stretched) {
  using core::Column;
  const core::ColumnLayout& layout = *batch.layout;
  double* const gap = block + layout.offset(Column::void_volume);
  const T failed = core::load<T>(block + layout.offset(Column::failed));
  const T pressure = core::load<T>(block + layout.offset(Column::pressure));
  const core::MaskOf<T> loose = (failed > 0.5) & (pressure == 0.0);
  if (!core::any(loose)) return stretched;
  const T whole = (old_volume + core::load<T>(gap)) * core::select(ratio > 0.0, ratio, T(1.0));
  const T fragments = core::min(whole, old_volume);
  core::store(gap, core::select(loose, whole - fragments, 0.0));
  const T strain = core::load<T>(batch.volumetric_strain + row);
  core::store(batch.volumetric_strain + row, core::select(loose, fragments / old_volume - 1.0, strain));
  return core::select(loose, fragments, stretched);
}

/// What a material makes of the motion.
struct KinematicRules {
  double reference_density = 0;
  bool parts = false;         ///< what has failed bears no tension, and opens voids
  double largest_volume = 0;  ///< that motion leads to, over m/rho0; 0: no bound
};

/// Fills volumetric_strain (of the material, without voids) and old_volume of the batch; updates the volume,
/// the accumulated strains where the layout has them, and the voids.
template <class T>
[[gnu::noinline, gnu::flatten]] void update_kinematics(core::Batch& batch, const core::UpdateOptions& options,
                                                       const KinematicRules& rules) {
  using core::Column;
  const core::ColumnLayout& layout = *batch.layout;
  const int mass_at = layout.offset(Column::mass), volume_at = layout.offset(Column::volume);
  const int strain_at = layout.offset(Column::strain_xx);
  const bool limits = options.volume_min > 0 || options.volume_max > 0;
  const double dt = batch.dt;
  const int type = options.volume_update;

  for_each_vector<T, parts_of_kinematics>(batch, [&](double* block, int row) {
    const core::Mat3<T> l = load_gradient<T>(batch, row);
    const core::Sym3<T> strain = strain_increment(l, dt);
    core::store(batch.volumetric_strain + row, trace(strain));
    core::Sym3<T> accumulated{0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    if (strain_at >= 0) accumulated = accumulate_strain(block + strain_at, strain);
    const T cell_strain = type == 1 ? core::load<T>(batch.cell_volumetric_strain + row) : T(0.0);

    const T old_volume = core::load<T>(block + volume_at);
    const T ratio = volume_ratio(type, l, dt, strain, accumulated, cell_strain);
    const core::MaskOf<T> unusable = !(ratio > 0.0);
    if (core::any(unusable)) {
      batch.events.negative_volume += count<T>(unusable, row, batch.particles);
      batch.vanishing |= lanes_of<T>(unusable, row, batch.particles);
    }
    T volume = core::select(unusable, old_volume, old_volume * ratio);
    if (rules.largest_volume > 0) {
      const T largest = core::load<T>(block + mass_at) * (rules.largest_volume / rules.reference_density);
      volume = core::min(volume, core::max(old_volume, largest));
    }
    if (core::derivatives_of<T> == 0 && rules.parts)
      volume = part_fragments<T>(batch, block, row, old_volume, ratio, volume);
    if (limits) {
      volume =
          limit_volume(batch, options, rules.reference_density, core::load<T>(block + mass_at), volume, row);
    }
    core::store(batch.old_volume + row, old_volume);
    core::store(block + volume_at, volume);
  });
}

}  // namespace mpm::physics
