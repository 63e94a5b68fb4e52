// The passes of the schemes (passes.hpp): which operations on a brick each does, in which order. Part of
// passes_with.hpp.
#pragma once

#include "core/step/passes_with.hpp"

namespace mpm::core {

template <ShapePolicy S, TransferPolicy T>
auto PassesWith<S, T>::interval_at_start() const -> StrainInterval {
  const double time = model_.clock.time;
  if (scheme_ == Scheme::usavg) return {strain_lag_, time, 0, StrainPart::second_half};
  return {dt, time + dt, -lag_ / dt};  // the velocities are yet to follow these stresses
}

template <ShapePolicy S, TransferPolicy T>
auto PassesWith<S, T>::interval_at_end() const -> StrainInterval {
  const double left = model_.clock.strain_lag, done = dt - left;
  return {done, model_.clock.time + done, (lag_ - left) / done,
          scheme_ == Scheme::usavg ? StrainPart::first_half : StrainPart::all};
}

/// Sums of all velocity fields, as if the bodies stuck to each other, into at.nodes.
template <ShapePolicy S, TransferPolicy T>
template <NodeArray of>
void PassesWith<S, T>::sum_fields(Slot s, Scratch& at) {
  const SharedNodes& shared = this->shared<of>();
  if (!contact_ || !contact_->meets(s)) return sum<of>(shared, s, all_components, at, at.nodes.data());
  std::fill_n(at.nodes.data(), at.nodes.size(), 0.0);
  for (const std::int32_t component : contact_->seen(s)) {
    sum<of>(shared, s, component, at, at.sums.data());
    for (std::size_t i = 0; i < at.nodes.size(); ++i) {
      const bool mapped = static_cast<int>(i % node_doubles) < record_doubles(of);
      if (mapped) at.nodes.data()[i] += at.sums.data()[i];
    }
  }
}

template <ShapePolicy S, TransferPolicy T>
double PassesWith<S, T>::largest_strain_rate(double above) {
  const BrickGrid& grid = *model_.grid;
  for (Scratch& w : scratch_) w.strain_rate = 0;
  for_bricks(0, grid.owned(), [&](Slot s, Scratch& at) {
    if (finds_ranges_ && !may_strain_faster(grid, ranges_, s, above)) return;
    const auto sum = [&]<NodeArray of>() {
      ContributionPrefetch<of>(grid, shared<of>(), s + 1, 1).next();
      sum_fields<of>(s, at);
    };
    if (strains_first(scheme_))
      sum.template operator()<NodeArray::sixth>();
    else
      sum.template operator()<NodeArray::first>();
    double* nodes = at.nodes.data();
    const double cutoff = grid.geometry().mass_cutoff;
    second_velocities(cutoff, nodes, nodes, faces(s), shared_.summed(), nodes);
    at.strain_rate = std::max(at.strain_rate, mpm::core::largest_strain_rate(
                                                  grid.shape(), grid.geometry().inverse_cell, cutoff, nodes));
  });
  double largest = 0;
  for (const Scratch& w : scratch_) largest = std::max(largest, w.strain_rate);
  return largest;
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_velocities_and_map_back() {
  motion_.resize(static_cast<std::size_t>(motion_doubles()) * seen_fields());
  map_bricks<Traits::mapped_back>([&](Slot s, Scratch& at) {
    const auto update = [&](std::int32_t component, std::size_t) { sum_and_update_nodes(s, component, at); };
    for_each_field(s, at, Contact::Velocity::of_end, update, [&](std::int32_t component, std::size_t k) {
      take_updated_nodes(s, component, k, at);
      if constexpr (Traits::can_keep_field) {
        if (keeps_field_) at.field.keep_velocity(reached(s), motion(s, k));
      }
      if (!keeps_field_) keep_motion(moving_shared_.summed(reached(s)), moving_nodes(s, k, at), motion(s, k));
      auto nodes = prefetch_nodes<NodeArray::first>(s);
      SpreadPrefetch room = prefetch_motion(s);
      const BrickFrame frame = this->frame(s, component);
      map_brick<Traits::mapped_back>(s, component, at,
                                     [&](int body, const Place& place, double* block, int used) {
                                       nodes.next();
                                       room.next();
                                       update_velocities(s, frame, body, place, block, used, at);
                                     });
    });
    if (contact_ && contact_->meets(s)) keep_motion_of_others(s, at);
    at.add_work_of_brick();
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_stress_and_move() {
  const BrickGrid& grid = *model_.grid;
  departing_.resize(static_cast<std::size_t>(grid.owned()));
  strain_ = interval_at_end();
  for_bricks(0, grid.owned(), [&](Slot s, Scratch& at) {
    const auto update = [&](std::int32_t component, std::size_t k) {
      const NodeMask* some = reached(s);
      if (!keeps_field_) recall_motion(moving_shared_.summed(some), motion(s, k), at.nodes.data());
      if constexpr (Traits::solves) return take_solved_strain(s, k, at);
      double *const sums = at.sums.data(), *const nodes = at.nodes.data();
      sum<NodeArray::second>(momentum_shared_, s, component, at, sums, some);
      if (takes_momenta(s)) return;
      constexpr bool maps_again = maps_mass(Traits::mapped_back);
      second_velocities(maps_again ? grid.geometry().mass_cutoff : 0, sums, maps_again ? sums : nodes,
                        faces(s), shared_.summed(some), nodes);
    };
    for_each_field(s, at, Contact::Velocity::of_strain_after_end, update,
                   [&](std::int32_t component, std::size_t k) {
                     const NodeMask* some = reached(s);
                     if constexpr (Traits::solves) move_with_strain(at);
                     if constexpr (Traits::can_keep_field) {
                       if (keeps_field_) at.field.recall_velocity(some, motion(s, k));
                     }
                     if (!keeps_field_) at.field.take_motion(at.nodes.data(), some);
                     take_strain(s, component, at.sums.data(), at);
                     auto nodes = prefetch_nodes<NodeArray::second>(s);
                     SpreadPrefetch room = prefetch_motion(s);
                     stress_of_brick<true>(s, component, at, [&] {
                       nodes.next();
                       room.next();
                     });
                   });
    keep_own_cells(s, at);
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_stress_and_map_forces() {
  const BrickGrid& grid = *model_.grid;
  critical_.assign(static_cast<std::size_t>(grid.owned()), 0.0);
  strain_ = interval_at_start();
  map_bricks<mapped::force>([&](Slot s, Scratch& at) {
    const auto map_forces = [&](std::int32_t component) {
      map_brick<mapped::force>(s, component, at, [](int, const Place&, double*, int) {});
    };
    if (strain_.dt == 0) return for_each_own_field(s, map_forces);
    const auto update = [&](std::int32_t component, [[maybe_unused]] std::size_t k) {
      const NodeMask* some = reached(s);
      double* const nodes = at.nodes.data();
      sum_start_held(s, component, at, nodes, some);
      if (takes_momenta(s)) return;
      second_velocities(grid.geometry().mass_cutoff, nodes, nodes, faces(s), shared_.summed(some), nodes);
      if constexpr (Traits::solves) take_solved_strain(s, k, at);
    };
    for_each_field(s, at, Contact::Velocity::of_strain, update, [&](std::int32_t component, std::size_t) {
      take_strain(s, component, at.nodes.data(), at);
      auto nodes = prefetch_nodes<NodeArray::sixth>(s);
      stress_of_brick<false>(s, component, at, [&] { nodes.next(); });
      map_forces(component);
    });
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_velocities_and_move() {
  const BrickGrid& grid = *model_.grid;
  departing_.resize(static_cast<std::size_t>(grid.owned()));
  for_bricks(0, grid.owned(), [&](Slot s, Scratch& at) {
    const auto update = [&](std::int32_t component, std::size_t) { sum_and_update_nodes(s, component, at); };
    for_each_field(s, at, Contact::Velocity::of_end, update, [&](std::int32_t component, std::size_t k) {
      take_updated_nodes(s, component, k, at);
      // The wave speeds are those of the stress pass; the largest of each brick serves for all of its
      // particles.
      at.statistics.fastest =
          std::max(at.statistics.fastest,
                   critical_[static_cast<std::size_t>(s)] + velocities_and_motion_of_brick(s, component, at));
    });
    keep_own_cells(s, at);
  });
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::update_all() {
  const BrickGrid& grid = *model_.grid;
  departing_.resize(static_cast<std::size_t>(grid.owned()));
  strain_ = interval_at_end();
  for_bricks(0, grid.owned(), [&](Slot s, Scratch& at) {
    const auto update = [&](std::int32_t component, std::size_t) { sum_and_update_nodes(s, component, at); };
    for_each_field(s, at, Contact::Velocity::of_end, update, [&](std::int32_t component, std::size_t k) {
      take_updated_nodes(s, component, k, at);
      velocities_of_brick(s, component, at);
      regularised_velocities(velocity_dt * (forces_.gravity + weight_of(s, component).acceleration), faces(s),
                             shared_.nodes(), at.nodes.data());
      at.field.take_strain(frame(s, component), at.nodes.data(), reached(s));
      auto nodes = prefetch_nodes<NodeArray::first>(s);
      stress_of_brick<true>(s, component, at, [&] { nodes.next(); });
    });
    keep_own_cells(s, at);
  });
}

template <ShapePolicy S, TransferPolicy T>
StepStatistics PassesWith<S, T>::take_statistics() {
  StepStatistics total;
  if (contact_) total.overlap = contact_->first_overlap();
  for (Scratch& w : scratch_) {
    total.fastest = std::max(total.fastest, w.statistics.fastest);
    total.limited += w.statistics.limited;
    total.domains += w.statistics.domains;
    total.events += w.statistics.events;
    total.vanishing.merge(w.statistics.vanishing);
    total.negative.merge(w.statistics.negative);
    total.work += w.statistics.work;
    total.internal_lead += w.statistics.internal_lead;
    total.reactions.resize(std::max(total.reactions.size(), w.statistics.reactions.size()));
    for (std::size_t r = 0; r < w.statistics.reactions.size(); ++r)
      total.reactions[r] += w.statistics.reactions[r];
    if (contact_) {
      total.contact += w.contact.record;
      total.fastest = std::max(total.fastest, contact_->speed_of_step(w.contact));
      w.contact = {};
    }
    w.statistics = {};
  }
  return total;
}

}  // namespace mpm::core
