// Operations on a brick, a block or a batch, of the passes (passes_with.hpp, of which this is a part): the
// nodes' equation of motion, velocities and motion of particles, strain and stress.
#pragma once

#include <algorithm>

#include "core/step/passes_with.hpp"

namespace mpm::core {

// --- nodes ------------------------------------------------------------------------------------------------

/// Sums what the scheme has mapped and updates the nodes; the result in at.nodes follows MotionRecord.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::sum_and_update_nodes(Slot s, std::int32_t component, Scratch& at) {
  const BrickGrid& grid = *model_.grid;
  const NodeMask* some = reached(s);
  double* nodes = at.nodes.data();
  sum<NodeArray::first>(moving_shared_, s, component, at, nodes, some);
  // With USF and USAVG the first array has the forces only; momentum and mass are zero there.
  if (strains_first(scheme_)) sum_start(s, component, at, nodes, some);
  update_nodes(forces_, velocity_dt, grid.geometry().mass_cutoff, faces(s), moving_shared_.summed(some),
               nodes);
}

template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::sum_start_held(Slot s, std::int32_t component, Scratch& at, double* sums,
                                      const NodeMask* some) {
  const BoundaryFaces walls = faces(s);
  const bool holds = needs_forces_at_start() && !walls.none();
  if (holds) sum<NodeArray::seventh>(shared_, s, component, at, sums, some);
  sum_start(s, component, at, sums, some);
  if (holds) hold_at_rigid_walls(forces_, velocity_dt, model_.grid->geometry().mass_cutoff, walls, sums);
}

/// Brings the updated nodes into at.field, with consistent mass as they have been solved for, and the
/// corrected velocities into at.corrected.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::take_updated_nodes(Slot s, [[maybe_unused]] std::int32_t component, std::size_t k,
                                          Scratch& at) {
  if (!has_meetings(s)) take_solved_motion(s, k, at);
  at.field.take_motion(at.nodes.data(), reached(s));
  if constexpr (Traits::corrects) {
    if (!correcting_) return;
    if (!has_meetings(s) && !(contact_ && model_.grid->components(s).empty()))
      add_order(s, orders_, component, k, at);
    at.corrected.take_motion(corrected_nodes(s, k));
  }
}

template <ShapePolicy S, TransferPolicy T>
const typename S::Field& PassesWith<S, T>::moving_field(const Scratch& at) const {
  if constexpr (Traits::corrects) {
    if (moves_corrected() && !maps_back(scheme_)) return at.corrected;
  }
  return at.field;
}

/// Brings the strain velocities into at.field: those of at.nodes, or of momenta where it takes these.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::take_strain(Slot s, std::int32_t component, [[maybe_unused]] const double* momenta,
                                   Scratch& at) {
  const BrickFrame frame = this->frame(s, component);
  if constexpr (Traits::takes_momenta) {
    if (takes_momenta(s)) return at.field.take_strain(frame, model_.grid->geometry().mass_cutoff, momenta);
  }
  at.field.take_strain(frame, at.nodes.data(), reached(s));
}

// --- particles --------------------------------------------------------------------------------------------

/// What the transfer gives the particles.
template <ShapePolicy S, TransferPolicy T>
[[gnu::always_inline]] inline void PassesWith<S, T>::take_velocities(const BrickFrame& frame,
                                                                     const Place& place,
                                                                     const ColumnLayout& layout,
                                                                     double* block, Scratch& at) const {
  if constexpr (Traits::corrects) {
    if (correcting_) return transfer_.template take_velocities<S>(place, layout, at.corrected, block);
  }
  transfer_.template update_velocities<S>(frame, place, layout, at.field, transfer_step_, block);
}

template <ShapePolicy S, TransferPolicy T>
bool PassesWith<S, T>::follow_grid() const {
  if (rigid_ != nullptr || loads_.any() || forces_.gravity != Vec3<double>{} || forces_.damping != 0 ||
      velocity_limit_ < std::numeric_limits<double>::infinity())
    return false;
  for (std::size_t b = 0; b < model_.bodies.size(); ++b)
    if (loads_.motion(static_cast<int>(b)).kind != BodyMotion::Kind::free) return false;
  return true;
}

/// v += dv; the work of loads uses the velocities before the update.
template <ShapePolicy S, TransferPolicy T>
[[gnu::always_inline]] inline void PassesWith<S, T>::update_velocities(Slot s, const BrickFrame& frame,
                                                                       int body, const Place& place,
                                                                       double* block, int used, Scratch& at) {
  if (follows_grid_) [[likely]] {
    const ColumnLayout& layout = model_.bodies[static_cast<std::size_t>(body)].pool->layout();
    return take_velocities(frame, place, layout, block, at);
  }
  update_velocities_apart(s, frame, body, place, block, used, at);
}

template <ShapePolicy S, TransferPolicy T>
[[gnu::noinline]] void PassesWith<S, T>::update_velocities_apart(Slot s, const BrickFrame& frame, int body,
                                                                 const Place& place, double* block, int used,
                                                                 Scratch& at) {
  if (rigid(body) >= 0) return;
  if (loads_.act(*model_.grid, s, body))
    at.work += work_of_loads<S>(loads_, model_, s, body, place, block, used, at.nodes.data(), velocity_dt);
  const ColumnLayout& layout = model_.bodies[static_cast<std::size_t>(body)].pool->layout();
  const BodyMotion& motion = loads_.motion(body);
  const Vec3<double> weight = forces_.gravity + loads_.acceleration(body);
  const bool falls = weight != Vec3<double>{}, is_free = motion.kind == BodyMotion::Kind::free;
  const bool damps = forces_.damping != 0;
  if (falls || !is_free || damps)
    std::copy_n(block + layout.offset(Column::velocity_x), 3 * block_lanes, at.old);
  const double damped = forces_.damping * velocity_dt;
  if (damps) scale_velocities(1 - damped, layout, block);
  take_velocities(frame, place, layout, block, at);
  if (motion.kind == BodyMotion::Kind::rigid)
    integrate_rigid_velocities(layout, weight, velocity_dt, block, used, at);
  if (motion.kind == BodyMotion::Kind::prescribed) prescribe_velocities(layout, motion, block, used, at);
  if (falls) correct_work_of_weight(weight, dt, velocity_dt, layout, block, used, at);
  if (damps) add_work_of_damping(damped, layout, block, used, at);
  if (is_free && velocity_limit_ < std::numeric_limits<double>::infinity())
    limit_velocities(layout, velocity_limit_, block, used, at);
}

/// x += dt v, with the grid's velocity or, for a body that keeps its own velocities, with those; and the work
/// of weight.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::move(int body, const MotionOfBlock<S>& motion, double* block, int used, Scratch& at) {
  const ColumnLayout& layout = model_.bodies[static_cast<std::size_t>(body)].pool->layout();
  if (follows_grid_) [[likely]] {
    motion.move(layout, dt, block);
    if constexpr (Traits::settles) motion.carry(layout, dt, block);
    return;
  }
  if (const int number = rigid(body); number >= 0) return rigid_->move(number, layout, block);
  const Vec3<double> weight = forces_.gravity + loads_.acceleration(body);
  const bool does_work = weight != Vec3<double>{};
  if (does_work) std::copy_n(block + layout.offset(Column::position_x), 3 * block_lanes, at.old);
  if (loads_.motion(body).kind != BodyMotion::Kind::free)
    move_at_own_velocity(layout, dt, block);
  else
    motion.move(layout, dt, block);
  if constexpr (Traits::settles) motion.carry(layout, dt, block);
  if (does_work) add_work_of_motion(weight, layout, block, used, at);
}

/// The particles' domains: by the velocity gradient of the batch's block `b`, or as they have been carried.
/// Those of a rigid body in contact have turned with it.
template <ShapePolicy S, TransferPolicy T>
[[gnu::always_inline]] inline void PassesWith<S, T>::update_domains(int body, const BrickFrame& frame,
                                                                    const ColumnLayout& layout, int b,
                                                                    double* block, int used, Scratch& at) {
  if (rigid(body) >= 0) return;
  if constexpr (Traits::deforms)
    at.statistics.domains += S::deform(frame, layout, at.batch.gradient, block_lanes * b, dt, block, used);
  if constexpr (Traits::settles)
    at.statistics.domains +=
        S::settle(frame, layout, loads_.motion(body).kind == BodyMotion::Kind::free, block, used);
  if constexpr (requires { S::replace_wide(frame, layout, block); }) {
    const bool is_fluid = model_.bodies[static_cast<std::size_t>(body)].model->initial_shear_speed() == 0;
    if (is_fluid) S::replace_wide(frame, layout, block);
  }
}

template <ShapePolicy S, TransferPolicy T>
[[gnu::noinline]] void PassesWith<S, T>::velocities_of_brick(Slot s, std::int32_t component, Scratch& at) {
  const BrickFrame frame = this->frame(s, component);
  for_each_block(
      s, component, columns_to_mass,
      [&](std::size_t, std::size_t, int body, const ColumnLayout& layout, double* block, int used) {
        update_velocities(s, frame, body, Place(frame, layout, block, used), block, used, at);
      });
  at.add_work_of_brick();
}

/// Returns the largest speed of the component's particles.
template <ShapePolicy S, TransferPolicy T>
[[gnu::noinline]] double PassesWith<S, T>::velocities_and_motion_of_brick(Slot s, std::int32_t component,
                                                                          Scratch& at) {
  const BrickFrame frame = this->frame(s, component);
  auto first = prefetch_nodes<NodeArray::first>(s);
  auto start = prefetch_nodes<NodeArray::sixth>(s);
  double fastest_square = 0;
  // The forces of this step were mapped with the domains of its start; those follow now, by the gradient of
  // the velocity that moves the particles.
  const typename S::Field* moving = &moving_field(at);
  [[maybe_unused]] typename S::Field with_gradient;
  if constexpr (Traits::deforms) {
    double* const nodes = at.sums.data();
    std::copy_n(moving_nodes(s, seen_number(s, component), at), record_count(), nodes);
    copy_vector(shared_.nodes(), nodes, Motion::velocity_at, Motion::strain_velocity_at, nodes);
    with_gradient.take_motion(nodes);
    with_gradient.take_strain(frame, nodes);
    moving = &with_gradient;
  }
  for_each_block(
      s, component, columns_to_mass,
      [&](std::size_t c, std::size_t b, int body, const ColumnLayout& layout, double* block, int used) {
        first.next();
        start.next();
        const Place place(frame, layout, block, used);
        update_velocities(s, frame, body, place, block, used, at);
        const MotionOfBlock<S> motion{place, *moving};
        move(body, motion, block, used, at);
        if constexpr (Traits::deforms) motion.gradient(frame, at.batch.gradient, 0);
        update_domains(body, frame, layout, 0, block, used, at);
        for (int l = 0; l < used; l += real_width)
          fastest_square = largest_lane(squared_speed(layout, block, l), used - l, fastest_square);
        find_departing(s, c, b, frame, layout, block, at);
      });
  at.add_work_of_brick();
  return std::sqrt(fastest_square);
}

/// Block `b` of tile `c` has moved: records the particles that leave, and the cells of the others.
template <ShapePolicy S, TransferPolicy T>
[[gnu::always_inline]] inline void PassesWith<S, T>::find_departing(Slot s, std::size_t c, std::size_t b,
                                                                    const BrickFrame& frame,
                                                                    const ColumnLayout& layout,
                                                                    const double* block, Scratch& at) {
  const ParticleTile& tile = model_.grid->brick(s).tiles[c];
  [[maybe_unused]] const unsigned staying =
      mpm::core::find_departing(static_cast<int>(c), b, frame, erosion_volume(tile.body), failed_.of(tile),
                                layout, block, tile.used_lanes(b), departing_[static_cast<std::size_t>(s)]);
  if constexpr (needs_cells<S>) at.cells.add(frame, layout, block, staying);
}

/// The cells of a brick whose particles have moved, unless rigid bodies are yet to move theirs.
template <ShapePolicy S, TransferPolicy T>
void PassesWith<S, T>::keep_own_cells([[maybe_unused]] Slot s, [[maybe_unused]] Scratch& at) {
  if constexpr (needs_cells<S>) {
    model_.grid->own_cells(s).reset();
    if (rigid_ == nullptr) model_.grid->own_cells(s) = at.cells.cells();
    at.cells = {};
  }
}

// --- stress -----------------------------------------------------------------------------------------------

/// Of the cells, for block `b` of the batch, where the volume update asks for it.
template <ShapePolicy S, TransferPolicy T>
[[gnu::always_inline]] inline void PassesWith<S, T>::volumetric_strain(const BrickFrame& frame,
                                                                       const Place& place, int b,
                                                                       Scratch& at) {
  if (updates_volume_by_cell())
    S::cell_divergence(frame, place, at.field, strain_.dt, at.batch.cell_volumetric_strain, block_lanes * b);
}

/// For outputs only; no law reads it.
inline void store_sound_speed(Batch& batch) {
  if (!batch.layout->has(Column::sound_speed)) return;
  for (int b = 0; b < batch.blocks; ++b) {
    std::copy_n(batch.sound_speed + block_lanes * b, block_lanes, batch.column(Column::sound_speed, b));
  }
}

/// Updates the material of a batch with known kinematics and records the events.
template <ShapePolicy S, TransferPolicy T>
[[gnu::always_inline]] inline void PassesWith<S, T>::update_material(const Body& body, Scratch& at) {
  Batch& batch = at.batch;
  batch.events = {};
  batch.vanishing = batch.negative = 0;
  body.model->update(batch, model_.options);
  at.work_of_stress += work_of_stress(batch);
  store_sound_speed(batch);
  // Of the halves of a step's strain the first one counts what both find in their particles.
  if (batch.part == StrainPart::second_half) {
    at.statistics.events += {.failed = batch.events.failed, .not_finite = batch.events.not_finite};
    return;
  }
  at.statistics.events += batch.events;
  if ((batch.vanishing | batch.negative) != 0)
    name_unphysical(model_.scene->solution.warn, body, batch, at.statistics);
}

template <ShapePolicy S, TransferPolicy T>
ReferredTrace PassesWith<S, T>::referred_trace() const {
  switch (static_cast<VolumeUpdate>(model_.options.volume_update)) {
    case VolumeUpdate::rate: return ReferredTrace::of_new_volume;
    case VolumeUpdate::exponential:
    case VolumeUpdate::accumulated_strain: return ReferredTrace::unchanged;
    default: return ReferredTrace::of_gradient;
  }
}

/// Sums a tile's volume changes in its sites. The gradients are formed once more with the stress:
/// that costs less than to store them.
template <ShapePolicy S, TransferPolicy T>
template <bool moves>
[[gnu::noinline]] void PassesWith<S, T>::sum_volume_changes(const BrickFrame& frame, const ParticleTile& tile,
                                                            Scratch& at) const {
  BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
  at.averages.clear();
  for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
    const double* block = pool.block(tile.blocks[b]);
    const Place place(frame, pool.layout(), block, tile.used_lanes(b));
    S::gradient(frame, place, at.field, at.batch.gradient, 0);
    if constexpr (!moves) refer_gradient_to_old_positions(at.batch, 0, strain_.dt, referred_trace(), false);
    at.averages.add_volume_changes(sites_of(place), block + pool.layout().offset(Column::volume),
                                   at.batch.gradient, 0, tile.used_lanes(b));
    if (model_.scene->solution.pressure_relaxation > 0)
      at.averages.add_old_pressures(sites_of(place), pool.layout(), block, tile.used_lanes(b));
  }
}

template <ShapePolicy S, TransferPolicy T>
typename PassesWith<S, T>::PressureRelaxation PassesWith<S, T>::relaxation_of(const Body& body) const {
  const double share = model_.scene->solution.pressure_relaxation, c = body.model->initial_sound_speed();
  if (share == 0 || c <= 0) return {};
  return {std::min(share * c / model_.grid->geometry().smallest_cell(), 1 / strain_.dt),
          body.model->reference_density() * c * c};
}

/// Velocity gradient, with `moves` the motion, then the material update, batch by batch. prefetch_nodes() is
/// called once per block.
template <ShapePolicy S, TransferPolicy T>
template <bool moves, class F>
[[gnu::noinline]] void PassesWith<S, T>::stress_of_brick(Slot s, std::int32_t component, Scratch& at,
                                                         F prefetch_nodes) {
  const BrickFrame frame = this->frame(s, component);
  Batch& batch = at.batch;
  double fastest = 0;
  const bool averages = averages_volume_change();
  PressureRelaxation relaxation;
  const auto average = [&](const ParticleTile& tile) {
    if (!averages) return;
    sum_volume_changes<moves>(frame, tile, at);
    relaxation = relaxation_of(model_.bodies[static_cast<std::size_t>(tile.body)]);
  };
  const auto kinematics = [&](int body, int b, int used) {
    prefetch_nodes();
    volumetric_strain(frame, at.places[b], b, at);
    if constexpr (moves) {
      const MotionOfBlock<S> motion{at.places[b], at.field};
      motion.gradient(frame, batch.gradient, block_lanes * b);
      if (&moving_field(at) == &at.field)
        move(body, motion, batch.block[b], used, at);
      else
        move(body, {at.places[b], moving_field(at)}, batch.block[b], used, at);
      update_domains(body, frame, *batch.layout, b, batch.block[b], used, at);
    } else {
      S::gradient(frame, at.places[b], at.field, batch.gradient, block_lanes * b);
      if constexpr (Traits::traps) {
        if (scheme_ == Scheme::usf && !averages)
          release_from_faces(frame, at.places[b], at.field.nodes, dt, *batch.layout, batch.block[b], used,
                             batch.gradient, block_lanes * b);
      }
      refer_gradient_to_old_positions(batch, block_lanes * b, strain_.dt, referred_trace(),
                                      updates_volume_by_cell());
    }
    if (!averages) return;
    const int* sites = sites_of(at.places[b]);
    at.averages.average_gradients(sites, batch.gradient, block_lanes * b);
    if (relaxation.rate > 0)
      at.averages.relax_pressures(sites, *batch.layout, batch.block[b], relaxation.rate, relaxation.modulus,
                                  batch.gradient, block_lanes * b);
  };
  const bool halves = moves && scheme_ == Scheme::usavg;
  const auto stress = [&]([[maybe_unused]] std::size_t c, std::size_t first, const ParticleTile& tile) {
    if (halves) at.gain_of_work -= work_of_present_stress(batch, false);
    update_material(model_.bodies[static_cast<std::size_t>(tile.body)], at);
    if (halves) at.gain_of_work += work_of_present_stress(batch, true);
    if constexpr (moves)
      at.statistics.fastest = fastest_particle(batch, wave_weight_, at.statistics.fastest);
    else
      fastest = std::max(fastest, fastest_wave(batch));
    if constexpr (moves) {
      for (int b = 0; b < batch.blocks; ++b) {
        const std::size_t at_block = first + static_cast<std::size_t>(b);
        find_departing(s, c, at_block, frame, *batch.layout, batch.block[b], at);
      }
    }
  };
  for_each_batch(s, component, frame, at, average, kinematics, stress);
  at.add_work_of_brick();
  at.statistics.internal_lead.add(strain_.lead * at.work_of_stress + 0.5 * at.gain_of_work);
  at.work_of_stress = at.gain_of_work = 0;
  if (moves) return;
  double& critical = critical_[static_cast<std::size_t>(s)];
  critical = std::max(critical, wave_weight_ * fastest);
}

}  // namespace mpm::core
