// FLIP (Brackbill and Ruppel 1986; thesis 2-28, 2-42): particles map their momentum m v and take the nodal
// velocity increments, so that they keep the velocity components that the grid does not resolve. They move
// with the grid velocity. No columns beyond the mechanics.
#pragma once

#include "core/transfer/transfer.hpp"

namespace mpm::core {

struct Flip {
  static constexpr std::string_view name = "FLIP";
  static ColumnSet columns() { return {}; }

  /// m and m v of a block.
  [[gnu::always_inline]] static void momentum(const ColumnLayout& layout, const double* block,
                                              MappedRows& rows) {
    const auto col = [&](Column c) { return block + layout.offset(c); };
    for (int l = 0; l < block_lanes; l += real_width) {
      const Real m = load<Real>(col(Column::mass) + l);
      store(rows.mass + l, m);
      for (int a = 0; a < 3; ++a)
        store(rows.momentum[a] + l, m * load<Real>(col(next(Column::velocity_x, a)) + l));
    }
  }

  /// v += sum S dv.
  template <ShapePolicy S>
  static void update_velocities(const typename S::Place& place, const ColumnLayout& layout,
                                const typename S::Field& field, double* block) {
    const typename S::Interpolation dv(place, field.increment());
    for (int a = 0; a < 3; ++a) {
      double* v = block + layout.offset(next(Column::velocity_x, a));
      store(v, load<Lanes<8>>(v) + dv.value[a]);
    }
  }
};
static_assert(TransferPolicy<Flip>);

}  // namespace mpm::core
