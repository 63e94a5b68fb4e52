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

/// Order 1 from the updated nodes in at.nodes, the others from the increments that the particles have mapped.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::add_order([[maybe_unused]] Slot s, [[maybe_unused]] int order,
                                 [[maybe_unused]] std::int32_t component, [[maybe_unused]] std::size_t k,
                                 [[maybe_unused]] Scratch& at) {
  if constexpr (Traits::corrects) {
    double* const to = corrected_nodes(s, k);
    if (order == 1)
      return begin_correction(!transfer_.of_end, faces(s), shared_.nodes(), at.nodes.data(), to);
    sum<NodeArray::third>(momentum_shared_, s, component, at, at.sums.data());
    continue_correction(faces(s), at.sums.data(), shared_.nodes(), to);
  }
}

/// Order 1 of the fields that a brick sees, from the velocities that contact leaves. What contact does there
/// is booked when the particles take it.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::begin_orders(Slot s, Scratch& at) {
  const auto update = [&](std::int32_t component, std::size_t) { sum_and_update_nodes(s, component, at); };
  const bool meets = has_meetings(s);
  if (meets) {
    ContactSums unbooked;
    take_fields(s, at, update);
    contact_->resolve(*model_.grid, s, Contact::Velocity::of_end, at.fields, unbooked);
  }
  for_each_seen_field(s, [&](std::int32_t component, std::size_t k) {
    if (meets)
      std::ranges::copy(at.fields[k].motion, at.nodes.data());
    else
      update(component, k);
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

/// The sums v(m) of the fields in at.fields, whose motion is that of the end of the step; where the fields
/// touch, contact acts on these sums too.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::meet_corrected([[maybe_unused]] Slot s, [[maybe_unused]] Scratch& at) {
  if constexpr (Traits::corrects) {
    constexpr int velocity = Motion::velocity_at, strain_velocity = Motion::strain_velocity_at;
    at.corrected_fields.resize(at.fields.size());
    for (std::size_t k = 0; k < at.fields.size(); ++k) {
      FieldNodes& field = at.corrected_fields[k];
      field.component = at.fields[k].component;
      field.motion = at.fields[k].motion;
      if (orders_ == 1) std::ranges::copy(field.motion, at.nodes.data());
      add_order(s, orders_, field.component, k, at);
      const double* corrected = corrected_nodes(s, k);
      for (int n = 0; n < record_count(); n += node_doubles)
        std::copy_n(corrected + n + velocity, 3, field.motion.data() + n + strain_velocity);
    }
    contact_->resolve(*model_.grid, s, Contact::Velocity::of_correction, at.corrected_fields, at.contact);
    for (std::size_t k = 0; k < at.fields.size(); ++k) {
      const double* resolved = at.corrected_fields[k].motion.data();
      for (int n = 0; n < record_count(); n += node_doubles)
        std::copy_n(resolved + n + strain_velocity, 3, corrected_nodes(s, k) + n + velocity);
    }
  }
}

}  // namespace mpm::core
