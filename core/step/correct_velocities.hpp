// XPIC and FMPM (core/transfer/corrected.hpp): the passes that add an order to the nodes' sums v(l). Part of
// passes_with.hpp.
#pragma once

#include "core/step/passes_with.hpp"

namespace mpm::core {

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::begin_corrections() {
  if constexpr (corrects) {
    correcting_ = transfer_.corrects(model_.clock.step + 1);
    if (correcting_)
      corrected_.resize(static_cast<std::size_t>(record_count()) *
                        static_cast<std::size_t>(model_.grid->owned()));
  }
}

/// Order 1 from the updated nodes in at.nodes, the others from the increments that the particles have mapped.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::add_order([[maybe_unused]] Slot s, [[maybe_unused]] int order,
                                 [[maybe_unused]] Scratch& at) {
  if constexpr (corrects) {
    if (order == 1)
      return begin_correction(!transfer_.of_end, faces(s), shared_.nodes(), at.nodes.data(),
                              corrected_nodes(s));
    sum_contributions<NodeArray::third>(*model_.grid, momentum_shared_, s, at.sums.data());
    continue_correction(faces(s), at.sums.data(), shared_.nodes(), corrected_nodes(s));
  }
}

/// Maps m sum S dv of the brick's particles, dv being the increments of these records.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::map_increments([[maybe_unused]] Slot s, [[maybe_unused]] const double* increments,
                                      [[maybe_unused]] Scratch& at) {
  if constexpr (corrects || solves) {
    constexpr NodeFields what = mapped::correction;
    const BrickFrame frame = this->frame(s);
    const int doubles = record_doubles(what.array) * shared_.nodes();
    double* contributions = model_.grid->contributions(what.array, s);
    std::fill_n(contributions, doubles, 0.0);
    typename S::template Sums<what> sums(contributions);
    typename S::template Scatter<what> cell;
    cell.clear();
    at.corrected.take_motion(increments);
    for_each_block(s, all_components, columns_to_mass,
                   [&](int, std::size_t, int, const ColumnLayout& layout, double* block, int used) {
                     const Place place(frame, layout, block);
                     MappedRows rows;
                     increment_momentum<S>(place, layout, at.corrected, block, rows);
                     add_particles(cell, frame, place, used, rows, sums.records);
                   });
    cell.flush(frame, sums.records);
    sums.finish(frame);
    if constexpr (S::node_block != NodeBlockShape{}) faces(s).fold(what, contributions);
  }
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::correct_velocities([[maybe_unused]] int order) {
  if constexpr (corrects) {
    if (!correcting_) return;
    // All nodes first: their sums read the contributions of the order before, which are then replaced.
    for_bricks(0, model_.grid->owned(), [&](Slot s, Scratch& at) {
      if (order == 2) sum_and_update_nodes(s, all_components, at);
      add_order(s, order - 1, at);
    });
    map_bricks<mapped::correction>([&](Slot s, Scratch& at) { map_increments(s, corrected_nodes(s), at); });
  }
}

}  // namespace mpm::core
