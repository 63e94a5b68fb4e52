// Fourth stage, where the material can fail: every failure model evaluates the same state, and the worst
// verdict counts (manual 3.2.3: any one suffices). Verdicts and the column `failed`: 0 intact, 1 failed, 2 to
// be eroded by the step. A particle that fails loses its deviatoric stress and the pressure that FailedType
// excludes; the elastic energy of both remains as heat. What it loses has not moved a node since the step
// before, so that its half of the step's trapezoidal work is taken back. The wave speed keeps the intact
// value for this one step, which is conservative.
#pragma once

#include <variant>

#include "physics/failure/point.hpp"
#include "physics/history.hpp"
#include "physics/material/failed_state.hpp"
#include "physics/material/strength_stage.hpp"

namespace mpm::physics {

/// Sets `verdict` to at least 1 (2 where the model erodes) where the model fails. `scatters`: the particles
/// have their own threshold factors.
template <class T, class Model>
[[gnu::noinline, gnu::flatten]] void judge(const core::Batch& batch, const Model& model, bool erodes,
                                           bool scatters, double* verdict) {
  const core::ColumnLayout& layout = *batch.layout;
  const History<Model, FailurePoint<T>> history(model, layout);
  const int pressure_at = layout.offset(core::Column::pressure);
  const int factor_at = scatters ? layout.offset(core::Column::threshold_factor) : -1;
  const double sentence = erodes ? 2 : 1;
  for_each_vector<T>(batch, [&](const double* block, int row) {
    FailurePoint<T> point{load_deviator<T>(block, layout), core::load<T>(block + pressure_at)};
    history.load(block, point);
    if (factor_at >= 0) point.threshold_factor = core::load<T>(block + factor_at);
    const T before = core::load<T>(verdict + row);
    core::store(verdict + row, core::select(model.fails(point), core::max(before, sentence), before));
  });
}

/// Failure by the verdicts: the state, the stress and the energy of the particles that fail in this step.
template <class T>
[[gnu::noinline, gnu::flatten]] void apply_failure(core::Batch& batch, const FailedRules& rules,
                                                   double reference_density, const double* verdict) {
  using core::Column;
  const core::ColumnLayout& layout = *batch.layout;
  const int failed_at = layout.offset(Column::failed), pressure_at = layout.offset(Column::pressure);
  const int q_at = layout.offset(Column::viscous_pressure),
            energy_at = layout.offset(Column::internal_energy);
  const int mass_at = layout.offset(Column::mass), volume_at = layout.offset(Column::volume);
  for_each_vector<T>(batch, [&](double* block, int row) {
    const T sentence = core::load<T>(verdict + row), before = core::load<T>(block + failed_at);
    if (!core::any(sentence > before)) return;
    core::store(block + failed_at, core::max(sentence, before));
    const auto fresh = (sentence > 0.5) & (before < 0.5);
    batch.events.failed += count<T>(fresh, row, batch.particles);
    const T kept = core::select(fresh, 0.0, T(1.0)), lost = 1.0 - kept;
    const core::Sym3<T> s = load_deviator<T>(block, layout);
    const T p = core::load<T>(block + pressure_at), q = core::load<T>(block + q_at);
    const T allowed = core::select(fresh, allowed_pressure(rules, p), p);
    const T volume = core::load<T>(block + volume_at), old_volume = core::load<T>(batch.old_volume + row);
    const T per_v0 = reference_density / core::load<T>(block + mass_at);
    const T work =
        0.25 * (volume + old_volume) * contract(lost * s, strength_point<T>(batch, block, row).strain) -
        0.5 * (volume - old_volume) * (p - allowed + batch.new_viscosity() * lost * q);
    core::store(block + energy_at, core::load<T>(block + energy_at) - per_v0 * work);
    store_deviator(block, layout, kept * s);
    core::store(block + pressure_at, allowed);
    core::store(block + q_at, kept * q);
  });
}

}  // namespace mpm::physics
