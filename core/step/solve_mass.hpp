// Solutions with the consistent mass matrix (core/transfer/consistent.hpp): the passes over particles and
// nodes of their iterations. Part of passes_with.hpp.
#pragma once

#include "core/step/passes_with.hpp"

namespace mpm::core {

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::begin_mass() {
  if constexpr (Traits::solves) {
    const auto owned = static_cast<std::size_t>(model_.grid->owned());
    solution_.resize(static_cast<std::size_t>(record_count()) * owned);
    direction_.resize(static_cast<std::size_t>(record_count()) * owned);
    begin_products();
  }
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::begin_solution([[maybe_unused]] Slot s, [[maybe_unused]] MassSystem system,
                                      [[maybe_unused]] Scratch& at) {
  if constexpr (Traits::solves) {
    const double cutoff = model_.grid->geometry().mass_cutoff;
    const int nodes = shared_.nodes();
    MotionVector from = Motion::velocity_at, stopped = Motion::velocity_at, u = Motion::velocity_at;
    switch (system) {
      case MassSystem::velocity_at_start:
        sum<NodeArray::second>(momentum_shared_, s, all_components, at, at.nodes.data());
        second_velocities(cutoff, at.nodes.data(), at.nodes.data(), faces(s), shared_.summed(),
                          at.nodes.data());
        from = stopped = Motion::strain_velocity_at;
        break;
      case MassSystem::velocity_at_end: sum_and_update_nodes(s, all_components, at); break;
      case MassSystem::increment:
        sum_and_update_nodes(s, all_components, at);
        from = u = Motion::increment_at;
        break;
      case MassSystem::new_velocity:
        recall_motion(moving_shared_.summed(), motion(s), at.nodes.data());
        sum<NodeArray::second>(momentum_shared_, s, all_components, at, at.sums.data());
        second_velocities(0, at.sums.data(), at.nodes.data(), faces(s), shared_.summed(), at.nodes.data());
        from = stopped = Motion::strain_velocity_at;
        break;
    }
    begin_mass_solution(faces(s), nodes, cutoff, at.nodes.data(), from, stopped, u, direction(s),
                        solution(s));
  }
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::end_solution([[maybe_unused]] Slot s, [[maybe_unused]] MassSystem system,
                                    [[maybe_unused]] Scratch& at) {
  if constexpr (Traits::solves) {
    if (system == MassSystem::increment && scheme_ == Scheme::usf) {
      sum_and_update_nodes(s, all_components, at);
      add_increment(faces(s), shared_.nodes(), at.nodes.data(), solution(s));
    }
    end_mass_solution(faces(s), solution(s));
  }
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::solve_mass([[maybe_unused]] MassSystem system) {
  if constexpr (Traits::solves) {
    const int owned = model_.grid->owned();
    const MotionVector u = system == MassSystem::increment ? Motion::increment_at : Motion::velocity_at;
    for_bricks(0, owned, [&](Slot s, Scratch& at) { begin_solution(s, system, at); });
    bool first = true;
    for (const MassIteration::Step& step : transfer_.iteration.steps()) {
      map_bricks<mapped::correction>(
          [&](Slot s, Scratch& at) { map_product(s, all_components, direction(s), at); });
      masses_known_ = true;
      halo_.end(*model_.grid);
      for_bricks(0, owned, [&](Slot s, Scratch& at) {
        sum_contributions<NodeArray::third>(*model_.grid, momentum_shared_, s, at.sums.data());
        advance_mass_solution(faces(s), shared_.nodes(), at.sums.data(), first, step, u, direction(s),
                              solution(s));
      });
      first = false;
    }
    for_bricks(0, owned, [&](Slot s, Scratch& at) { end_solution(s, system, at); });
  }
}

/// The solved velocities and increments in the place of the lumped ones in at.nodes.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::take_solved_motion([[maybe_unused]] Slot s, [[maybe_unused]] Scratch& at) {
  if constexpr (Traits::solves) {
    const int nodes = shared_.nodes();
    take_solution(nodes, solution(s), Motion::increment_at, Motion::increment_at, at.nodes.data());
    if (scheme_ == Scheme::usf || loads_.any())
      take_solution(nodes, solution(s), Motion::velocity_at, Motion::velocity_at, at.nodes.data());
  }
}

/// The solved velocity for the strain; with MUSL for the motion too.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::take_solved_strain([[maybe_unused]] Slot s, [[maybe_unused]] Scratch& at) {
  if constexpr (Traits::solves) {
    const int nodes = shared_.nodes();
    take_solution(nodes, solution(s), Motion::velocity_at, Motion::strain_velocity_at, at.nodes.data());
    if (scheme_ == Scheme::musl)
      take_solution(nodes, solution(s), Motion::velocity_at, Motion::velocity_at, at.nodes.data());
  }
}

}  // namespace mpm::core
