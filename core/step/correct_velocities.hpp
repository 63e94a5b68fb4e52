// XPIC and FMPM (core/transfer/corrected.hpp): the passes that add an order to the nodes' sums v(l). Part of
// passes_with.hpp.
#pragma once

#include "core/step/passes_with.hpp"

namespace mpm::core {

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::begin_corrections() {
  if constexpr (Traits::corrects) {
    correcting_ = transfer_.corrects(model_.clock.step + 1);
    if (!correcting_) return;
    corrected_.resize(static_cast<std::size_t>(record_count()) * seen_fields());
    begin_products();
  }
}

/// Order 1 from the updated nodes in at.nodes, the others from the increments that the particles have mapped;
/// to the nodes' sums, or a copy of them.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::add_order(Slot s, int order, std::int32_t component, std::size_t k, Scratch& at) {
  add_order(s, order, component, at, corrected_nodes(s, k));
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::add_order([[maybe_unused]] Slot s, [[maybe_unused]] int order,
                                 [[maybe_unused]] std::int32_t component, [[maybe_unused]] Scratch& at,
                                 [[maybe_unused]] double* to) {
  if constexpr (Traits::corrects) {
    if (order == 1)
      return begin_correction(!transfer_.of_end, faces(s), shared_.nodes(), at.nodes.data(), to);
    sum<NodeArray::third>(momentum_shared_, s, component, at, at.sums.data());
    continue_correction(faces(s), at.sums.data(), shared_.nodes(), to);
  }
}

/// Order 1 of the fields that a brick sees, from the velocities that contact leaves.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::begin_orders(Slot s, Scratch& at) {
  const bool meets = has_meetings(s);
  if (meets) take_fields_of_end(s, at);
  for_each_seen_field(s, [&](std::int32_t component, std::size_t k) {
    if (meets)
      std::ranges::copy(at.fields[k].motion, at.nodes.data());
    else
      sum_and_update_nodes(s, component, at);
    add_order(s, 1, component, k, at);
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::correct_velocities([[maybe_unused]] int order) {
  if constexpr (Traits::corrects) {
    if (!correcting_) return;
    // All nodes first: their sums read the contributions of the order before, which are then replaced.
    for_bricks(0, model_.grid->owned(), [&](Slot s, Scratch& at) {
      if (order == 2) return begin_orders(s, at);
      for_each_seen_field(
          s, [&](std::int32_t component, std::size_t k) { add_order(s, order - 1, component, k, at); });
    });
    map_bricks<mapped::correction>([&](Slot s, Scratch& at) {
      for_each_own_field(s, [&](std::int32_t component) {
        map_product(s, component, corrected_nodes(s, seen_number(s, component)), at);
      });
    });
    masses_known_ = true;
  }
}

/// The sums v(m) of the fields in at.fields, whose motion is that of the end of the step, into
/// at.corrected_fields. sums(k): the nodes' sums without the last order, which is added to them.
template <ShapePolicy S, TransferPolicy T>
template <class F>
void PassesWith<S, T>::take_corrected_fields(Slot s, Scratch& at, F sums) {
  at.corrected_fields.resize(at.fields.size());
  for (std::size_t k = 0; k < at.fields.size(); ++k) {
    FieldNodes& field = at.corrected_fields[k];
    field.component = at.fields[k].component;
    field.motion = at.fields[k].motion;
    if (orders_ == 1) std::ranges::copy(field.motion, at.nodes.data());
    double* const corrected = sums(k);
    add_order(s, orders_, field.component, at, corrected);
    copy_vector(shared_.nodes(), corrected, Motion::velocity_at, Motion::strain_velocity_at,
                field.motion.data());
  }
}

/// Where the fields in at.fields touch, contact acts on their sums v(m) too.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::meet_corrected(Slot s, Scratch& at) {
  take_corrected_fields(s, at, [&](std::size_t k) { return corrected_nodes(s, k); });
  contact_->resolve(*model_.grid, s, Contact::Velocity::of_correction, at.corrected_fields, at.contact);
  for (std::size_t k = 0; k < at.fields.size(); ++k) {
    copy_vector(shared_.nodes(), at.corrected_fields[k].motion.data(), Motion::strain_velocity_at,
                Motion::velocity_at, corrected_nodes(s, k));
  }
}

/// The motion of free rigid bodies on which the sums v(m) press.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::correct_rigid_motion() {
  if (!correcting_) return;
  find_rigid_motion(RigidStage::corrected, [this](Slot s, Scratch& at) {
    take_fields_of_end(s, at);
    take_corrected_fields(s, at, [&](std::size_t k) {
      at.orders.assign(corrected_nodes(s, k), corrected_nodes(s, k) + record_count());
      return at.orders.data();
    });
    return std::span(at.corrected_fields);
  });
  if (moves_corrected()) rigid_->move_corrected();
}

}  // namespace mpm::core
