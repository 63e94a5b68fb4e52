// Solutions with the consistent mass matrix (core/transfer/consistent.hpp): the passes over particles and
// nodes of their iterations, each velocity field by itself. Part of passes_with.hpp.
#pragma once

#include "core/step/passes_with.hpp"

namespace mpm::core {

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::begin_mass() {
  if constexpr (Traits::solves) {
    solution_.resize(static_cast<std::size_t>(record_count()) * seen_fields());
    direction_.resize(static_cast<std::size_t>(record_count()) * seen_fields());
    begin_products();
  }
}

/// The motion of the field number `k` at the end of the step with lumped mass, into at.nodes. Where fields
/// meet, it is that after contact, whose impulses balance the other forces, but without their blows
/// (contact_impulses.cpp): these change velocities at once, and with M they would change them by more than
/// the approach that they stop. Called for all fields of a brick in turn.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::take_lumped_motion(Slot s, std::int32_t component, std::size_t k, Scratch& at) {
  if (!has_meetings(s)) return sum_and_update_nodes(s, component, at);
  if (k == 0) take_fields_of_end(s, at);
  std::ranges::copy(at.fields[k].motion, at.nodes.data());
  for (const MotionVector to : {Motion::velocity_at, Motion::increment_at})
    add_vector(shared_.nodes(), at.fields[k].blow.data(), Motion::velocity_at, -1, to, at.nodes.data());
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::begin_solution([[maybe_unused]] Slot s, [[maybe_unused]] MassSystem system,
                                      [[maybe_unused]] std::int32_t component, [[maybe_unused]] std::size_t k,
                                      [[maybe_unused]] Scratch& at) {
  if constexpr (Traits::solves) {
    const double cutoff = model_.grid->geometry().mass_cutoff;
    const int nodes = shared_.nodes();
    MotionVector from = Motion::velocity_at, stopped = Motion::velocity_at, u = Motion::velocity_at;
    switch (system) {
      case MassSystem::velocity_at_start:
        sum_start_held(s, component, at, at.nodes.data());
        second_velocities(cutoff, at.nodes.data(), at.nodes.data(), faces(s), shared_.summed(),
                          at.nodes.data());
        from = stopped = Motion::strain_velocity_at;
        break;
      case MassSystem::velocity_at_end: take_lumped_motion(s, component, k, at); break;
      case MassSystem::increment:
        take_lumped_motion(s, component, k, at);
        from = u = Motion::increment_at;
        break;
      case MassSystem::new_velocity:
        recall_motion(moving_shared_.summed(), motion(s, k), at.nodes.data());
        sum<NodeArray::second>(momentum_shared_, s, component, at, at.sums.data());
        second_velocities(0, at.sums.data(), at.nodes.data(), faces(s), shared_.summed(), at.nodes.data());
        from = stopped = Motion::strain_velocity_at;
        break;
    }
    begin_mass_solution(faces(s), nodes, cutoff, at.nodes.data(), from, stopped, u, direction(s, k),
                        solution(s, k));
  }
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::end_solution([[maybe_unused]] Slot s, [[maybe_unused]] MassSystem system,
                                    [[maybe_unused]] std::size_t k) {
  if constexpr (Traits::solves) {
    if (system == MassSystem::increment && scheme_ == Scheme::usf)
      add_increment(faces(s), shared_.nodes(), direction(s, k), solution(s, k));
    end_mass_solution(faces(s), solution(s, k));
  }
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::solve_mass([[maybe_unused]] MassSystem system) {
  if constexpr (Traits::solves) {
    const MotionVector u = system == MassSystem::increment ? Motion::increment_at : Motion::velocity_at;
    const auto for_fields = [&](auto work) {
      for_bricks(0, model_.grid->owned(), [&](Slot s, Scratch& at) {
        for_each_seen_field(s, [&](std::int32_t component, std::size_t k) {
          // Others are not wanted, and the motion of the end is not kept for them.
          if (has_meetings(s) || field_of(s, component) >= 0) work(s, component, k, at);
        });
      });
    };
    for_fields([&](Slot s, std::int32_t component, std::size_t k, Scratch& at) {
      begin_solution(s, system, component, k, at);
    });
    bool first = true;
    for (const MassIteration::Step& step : transfer_.iteration.steps()) {
      map_bricks<mapped::correction>([&](Slot s, Scratch& at) {
        for_each_own_field(s, [&](std::int32_t component) {
          map_product(s, component, direction(s, seen_number(s, component)), at);
        });
      });
      masses_known_ = true;
      halo_.end(*model_.grid);
      for_fields([&](Slot s, std::int32_t component, std::size_t k, Scratch& at) {
        sum<NodeArray::third>(momentum_shared_, s, component, at, at.sums.data());
        advance_mass_solution(faces(s), shared_.nodes(), at.sums.data(), first, step, u, direction(s, k),
                              solution(s, k));
      });
      first = false;
    }
    for_fields([&](Slot s, std::int32_t, std::size_t k, Scratch&) { end_solution(s, system, k); });
  }
}

/// The solved velocities and increments in the place of the lumped ones in at.nodes.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::take_solved_motion([[maybe_unused]] Slot s, [[maybe_unused]] std::size_t k,
                                          [[maybe_unused]] Scratch& at) {
  if constexpr (Traits::solves) {
    copy_vector(shared_.nodes(), solution(s, k), Motion::increment_at, Motion::increment_at, at.nodes.data());
    if (solves_velocities())
      copy_vector(shared_.nodes(), solution(s, k), Motion::velocity_at, Motion::velocity_at, at.nodes.data());
  }
}

/// The solved velocity for the strain.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::take_solved_strain([[maybe_unused]] Slot s, [[maybe_unused]] std::size_t k,
                                          [[maybe_unused]] Scratch& at) {
  if constexpr (Traits::solves)
    copy_vector(shared_.nodes(), solution(s, k), Motion::velocity_at, Motion::strain_velocity_at,
                at.nodes.data());
}

/// MUSL moves particles with the velocity that strains them.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::move_with_strain(Scratch& at) {
  double* const nodes = at.nodes.data();
  copy_vector(shared_.nodes(), nodes, Motion::strain_velocity_at, Motion::velocity_at, nodes);
}

/// The solved velocities and increments of the fields in at.fields, with the blows of contact. Contact acts
/// on the solved velocities once more, so that what touches does not approach with these, either; that
/// changes the motion of particles, not their momenta.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::meet_solved(Slot s, Scratch& at) {
  const int nodes = shared_.nodes();
  if (solves_velocities()) {
    at.corrected_fields.resize(at.fields.size());
    for (std::size_t k = 0; k < at.fields.size(); ++k) {
      FieldNodes& field = at.corrected_fields[k];
      field.component = at.fields[k].component;
      field.motion = at.fields[k].motion;
      copy_vector(nodes, solution(s, k), Motion::velocity_at, Motion::strain_velocity_at,
                  field.motion.data());
      add_vector(nodes, at.fields[k].blow.data(), Motion::velocity_at, 1, Motion::strain_velocity_at,
                 field.motion.data());
    }
    ContactSums unbooked;
    contact_->resolve(*model_.grid, s, Contact::Velocity::of_strain_after_end, at.corrected_fields, unbooked);
  }
  for (std::size_t k = 0; k < at.fields.size(); ++k) {
    double* const motion = at.fields[k].motion.data();
    copy_vector(nodes, solution(s, k), Motion::increment_at, Motion::increment_at, motion);
    add_vector(nodes, at.fields[k].blow.data(), Motion::velocity_at, 1, Motion::increment_at, motion);
    if (solves_velocities())
      copy_vector(nodes, at.corrected_fields[k].motion.data(), Motion::strain_velocity_at,
                  Motion::velocity_at, motion);
  }
}

}  // namespace mpm::core
