// Particles to grid (thesis 2-31, 2-32, 2-38): the contribution of one block to its brick's nodes. Reference
// version: tests/support/reference_stepper.
#pragma once

#include "core/step/site_averages.hpp"
#include "core/transfer/transfer.hpp"

namespace mpm::core {

/// Rows of V sigma of a block, sigma = s - (p + q) I.
[[gnu::always_inline]] inline void stress_rows(const ColumnLayout& layout, const double* block,
                                               MappedRows& rows) {
  const auto col = [&](Column c) { return block + layout.offset(c); };
  for (int l = 0; l < block_lanes; l += real_width) {
    const Real v = load<Real>(col(Column::volume) + l);
    const Real p_total =
        load<Real>(col(Column::pressure) + l) + load<Real>(col(Column::viscous_pressure) + l);
    for (int a = 0; a < 3; ++a)
      store(rows.stress[a] + l, v * (load<Real>(col(next(Column::s_xx, a)) + l) - p_total));
    for (int a = 3; a < 6; ++a) store(rows.stress[a] + l, v * load<Real>(col(next(Column::s_xx, a)) + l));
  }
}

/// Adds the first `used` particles of a block to a brick's S::Sums; `pressures`: the mean pressures with
/// which they act, null where each acts with its own.
template <ShapePolicy S, TransferPolicy T, NodeFields what>
[[gnu::always_inline]] inline void add_block(const BrickFrame& frame, const typename S::Place& place,
                                             const ColumnLayout& layout, const double* block, int used,
                                             typename S::template Scatter<what>& running, double* records,
                                             const SiteAverages* pressures = nullptr) {
  typename T::Rows rows;
  if constexpr (maps_momentum(what)) T::template momentum<S>(frame, place, layout, block, rows);
  if constexpr (maps_force(what)) {
    stress_rows(layout, block, rows);
    if (pressures != nullptr) pressures->average_pressures(sites_of(place), layout, block, rows);
  }
  add_particles(running, frame, place, used, rows, records);
}

}  // namespace mpm::core
