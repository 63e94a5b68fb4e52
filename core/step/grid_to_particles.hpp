// Grid to particles: moves one block with the nodes of its brick (thesis 2-28, 2-42, 2-43) and finds the
// particles that have left the brick.
#pragma once

#include "core/shape/shape.hpp"

namespace mpm::core {

/// x += dt sum S v.
template <ShapePolicy S>
inline void move_with_grid(const typename S::Place& place, const ColumnLayout& layout,
                           const typename S::Field& field, double dt, double* block) {
  const typename S::Interpolation v(place, field.velocity());
  for (int a = 0; a < 3; ++a) {
    double* x = block + layout.offset(next(Column::position_x, a));
    store(x, load<Lanes<8>>(x) + Lanes<8>(dt) * v.value[a]);
  }
}

/// What a block takes of the nodes' motion: the gradient of the strain velocity, and its displacement.
template <ShapePolicy S>
struct MotionOfBlock {
  const typename S::Place& place;
  const typename S::Field& field;
  template <class Rows>
  [[gnu::always_inline]] void gradient(const BrickFrame& frame, Rows& rows, int at) const {
    S::gradient(frame, place, field, rows, at);
  }
  [[gnu::always_inline]] void move(const ColumnLayout& layout, double dt, double* block) const {
    move_with_grid<S>(place, layout, field, dt, block);
  }
};
template <ShapePolicy S>
requires requires { typename S::Sample; }
struct MotionOfBlock<S> : S::Sample {
  using S::Sample::Sample;
};

/// Bit mask of the lanes outside the brick (a NaN counts as outside).
inline unsigned lanes_outside(const BrickFrame& frame, const ColumnLayout& layout, const double* block,
                              int used) {
  unsigned outside = 0;
  const double* x[3] = {block + layout.offset(Column::position_x), block + layout.offset(Column::position_y),
                        block + layout.offset(Column::position_z)};
  for (int l = 0; l < block_lanes; l += real_width) {
    auto inside = Real(0.0) <= Real(0.0);
    for (int a = 0; a < 3; ++a) {
      const Real s = GridGeometry::scaled(load<Real>(x[a] + l), frame.origin[a], frame.inverse_cell[a]) -
                     Real(frame.first_site[a]);
      inside = inside & (s >= Real(frame.lowest[a])) & (s < Real(frame.beyond[a]));
    }
    if (all(inside)) continue;
    for (int i = 0; i < real_width && l + i < used; ++i) {
      outside |= static_cast<unsigned>(!test(inside, i)) << (l + i);
    }
  }
  return outside;
}

}  // namespace mpm::core
