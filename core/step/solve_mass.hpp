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
    if constexpr (trilinear_on_lattice<S>)
      cell_masses_.resize(static_cast<std::size_t>(cell_mass_doubles) * owned);
    masses_known_ = !trilinear_on_lattice<S>;
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

/// The moments of the brick's cells, once per step.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::sum_cell_masses([[maybe_unused]] Slot s) {
  if constexpr (Traits::solves && trilinear_on_lattice<S>) {
    const BrickFrame frame = this->frame(s);
    double* moments = cell_masses(s);
    std::fill_n(moments, cell_mass_doubles, 0.0);
    cell_mass::Sums sums;
    for_each_block(s, all_components, columns_to_mass,
                   [&](std::size_t, std::size_t, int, const ColumnLayout& layout, double* block, int used) {
                     const Place place(frame, layout, block);
                     const double* m = block + layout.offset(Column::mass);
                     for (int i = 0; i < used; ++i) sums.add(place, i, m[i], moments);
                   });
    sums.flush(moments);
  }
}

/// Maps the product of the consistent mass with the directions: by cells, or by particles.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::map_product([[maybe_unused]] Slot s, [[maybe_unused]] Scratch& at) {
  if constexpr (Traits::solves && trilinear_on_lattice<S>) {
    constexpr NodeFields what = mapped::correction;
    const BrickFrame frame = this->frame(s);
    const double* moments = cell_masses(s);
    double* contributions = model_.grid->contributions(what.array, s);
    std::fill_n(contributions, record_doubles(what.array) * shared_.nodes(), 0.0);
    typename S::template Sums<what> sums(contributions);
    typename S::template Scatter<what> cell;
    at.corrected.take_motion(direction(s));
    const double* d = at.corrected.increment();
    for (int c = 0; c < cell_mass::cells; ++c, moments += cell_mass::doubles) {
      if (moments[cell_mass::in_use] == 0) continue;
      cell.clear();
      cell.node = cell_mass::lowest_point(c);
      cell_mass::multiply(moments, d, cell.node, cell.sums.px, cell.sums.py, cell.sums.pz);
      cell.flush(frame, sums.records);
    }
    sums.finish(frame);
    if constexpr (S::node_block != NodeBlockShape{}) faces(s).fold(what, contributions);
  } else if constexpr (Traits::solves) {
    map_increments(s, all_components, direction(s), at);
  }
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::solve_mass([[maybe_unused]] MassSystem system) {
  if constexpr (Traits::solves) {
    const int owned = model_.grid->owned();
    const MotionVector u = system == MassSystem::increment ? Motion::increment_at : Motion::velocity_at;
    for_bricks(0, owned, [&](Slot s, Scratch& at) {
      if (!masses_known_) sum_cell_masses(s);
      begin_solution(s, system, at);
    });
    masses_known_ = true;
    bool first = true;
    for (const MassIteration::Step& step : transfer_.iteration.steps()) {
      map_bricks<mapped::correction>([&](Slot s, Scratch& at) { map_product(s, at); });
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
