// FLIP (Brackbill and Ruppel 1986; thesis 2-28, 2-42): particles map their momentum m v and take the nodal
// velocity increments, so that they keep the velocity components that the grid does not resolve. They move
// with the grid velocity. No columns beyond the mechanics.
//
// PIC (Harlow 1964): particles take the nodal velocities, and lose what the grid does not resolve. A blend
// takes the share f of FLIP: v = f (v + sum S dv) + (1 - f) sum S v. PIC's share acts once per step, so its
// damping grows as steps are made smaller.
#pragma once

#include "core/transfer/transfer.hpp"

namespace mpm::core {

/// m and m v of a block.
[[gnu::always_inline]] inline void particle_momentum(const ColumnLayout& layout, const double* block,
                                                     MappedRows& rows) {
  const auto col = [&](Column c) { return block + layout.offset(c); };
  for (int l = 0; l < block_lanes; l += real_width) {
    const Real m = load<Real>(col(Column::mass) + l);
    store(rows.mass + l, m);
    for (int a = 0; a < 3; ++a)
      store(rows.momentum[a] + l, m * load<Real>(col(next(Column::velocity_x, a)) + l));
  }
}

/// m sum S dv of a block: momentum of velocity increments at the nodes.
template <ShapePolicy S>
[[gnu::always_inline]] inline void increment_momentum(const typename S::Place& place,
                                                      const ColumnLayout& layout,
                                                      const typename S::Field& field, const double* block,
                                                      MappedRows& rows) {
  const typename S::Interpolation dv(place, field.increment());
  const auto m = load<Lanes<8>>(block + layout.offset(Column::mass));
  for (int a = 0; a < 3; ++a) store(rows.momentum[a], m * dv.value[a]);
}

struct Flip {
  static constexpr std::string_view name = "FLIP";
  static ColumnSet columns() { return {}; }
  using Rows = MappedRows;
  explicit Flip(const SolutionInput&) {}
  static double share_of_nodes(const TransferStep&) { return 0; }

  template <ShapePolicy S>
  [[gnu::always_inline]] static void momentum(const BrickFrame&, const typename S::Place&,
                                              const ColumnLayout& layout, const double* block, Rows& rows) {
    particle_momentum(layout, block, rows);
  }

  /// v += sum S dv.
  template <ShapePolicy S>
  void update_velocities(const BrickFrame&, const typename S::Place& place, const ColumnLayout& layout,
                         const typename S::Field& field, const TransferStep&, double* block) const {
    const typename S::Interpolation dv(place, field.increment());
    for (int a = 0; a < 3; ++a) {
      double* v = block + layout.offset(next(Column::velocity_x, a));
      store(v, load<Lanes<8>>(v) + dv.value[a]);
    }
  }
};
static_assert(TransferPolicy<Flip>);

/// PIC, and blends of FLIP and PIC.
struct FlipPic : Flip {
  static constexpr std::string_view name = "PIC";
  explicit FlipPic(const SolutionInput& solution)
      : Flip(solution), flip(solution.transfer == Transfer::pic ? 0 : solution.flip_fraction) {}
  double share_of_nodes(const TransferStep&) const { return 1 - flip; }

  template <ShapePolicy S>
  void update_velocities(const BrickFrame&, const typename S::Place& place, const ColumnLayout& layout,
                         const typename S::Field& field, const TransferStep&, double* block) const {
    using R = Lanes<8>;
    const typename S::Interpolation dv(place, field.increment()), u(place, field.velocity());
    for (int a = 0; a < 3; ++a) {
      double* v = block + layout.offset(next(Column::velocity_x, a));
      store(v, R(flip) * (load<R>(v) + dv.value[a]) + R(1 - flip) * u.value[a]);
    }
  }

  double flip;  ///< its share
};
static_assert(TransferPolicy<FlipPic>);

}  // namespace mpm::core
