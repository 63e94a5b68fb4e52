// The end of an implicit step: particles move by the displacements found, and keep stress, volume and
// velocity. Part of implicit_passes_with.hpp.
#pragma once

#include <algorithm>

#include "core/implicit/implicit_passes_with.hpp"
#include "core/step/grid_to_particles.hpp"
#include "core/step/speeds.hpp"

namespace mpm::core {

/// Adds S times the nodes' increments to three columns.
template <ShapePolicy S>
inline void ImplicitPassesWith<S>::add_increments(const ColumnLayout& layout, const Place& place,
                                                  const typename S::Field& of, Column first, double* block) {
  const typename S::Interpolation gained(place, of.increment());
  for (int a = 0; a < 3; ++a) {
    double* const to = block + layout.offset(next(first, a));
    store(to, load<Lanes<8>>(to) + gained.value[a]);
  }
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::move_block(const BrickFrame& frame, const ParticleTile& tile, int b,
                                       double* block, int used, bool dynamic, bool lags, Scratch& at) {
  const ColumnLayout& layout = *at.batch.layout;
  const Place& place = at.places[b];
  if (const int number = rigid(tile.body); number >= 0) return rigid_->move(number, layout, block);
  const auto velocity = [&](int a) { return block + layout.offset(next(Column::velocity_x, a)); };
  const bool moved = prescribed(tile.body);
  if (moved) {
    const PrescribedMotion& motion = loads_.motion(tile.body).velocity;
    if (dynamic) add_missing_impulses(tile.body, place, layout, block, used, at);
    for (int l = 0; l < used; ++l) {
      const Vec3<double> v = motion.velocity(block + l);
      for (int a = 0; a < 3; ++a) {
        // The constraint supplies the kinetic energy.
        double& now = velocity(a)[l];
        at.work += 0.5 * block[layout.offset(Column::mass) + l] * (v[a] * v[a] - now * now);
        now = v[a];
      }
    }
  } else if (dynamic) {
    add_increments(layout, place, at.velocities, Column::velocity_x, block);
    if (lags && layout.has(Column::acceleration_lag_x))
      add_increments(layout, place, at.lags, Column::acceleration_lag_x, block);
  } else {
    // A run that goes on from dynamic steps had velocities.
    const double *mass = block + layout.offset(Column::mass), *v = velocity(0);
    for (int l = 0; l < used; ++l)
      at.work -= 0.5 * mass[l] *
                 (v[l] * v[l] + v[l + block_lanes] * v[l + block_lanes] +
                  v[l + 2 * block_lanes] * v[l + 2 * block_lanes]);
    std::fill_n(velocity(0), 3 * block_lanes, 0.0);
  }
  const MotionOfBlock<S> motion{place, at.displacements};
  if (moved)
    move_at_own_velocity(layout, dt_, block);
  else
    motion.move(layout, 1.0, block);
  if constexpr (settles) motion.carry(layout, 1.0, block);
  if constexpr (deforms)
    at.statistics.domains += S::deform(frame, layout, at.gradient, block_lanes * b, 1.0, block, used);
  if constexpr (settles) at.statistics.domains += S::settle(frame, layout, !moved, block, used);
}

/// Of a dynamic step: what a body of prescribed motion gets beside the nodes' increments, which serve the
/// particles of others.
template <ShapePolicy S>
void ImplicitPassesWith<S>::add_missing_impulses(int body, const Place& place, const ColumnLayout& layout,
                                                 const double* block, int used, Scratch& at) const {
  const typename S::Interpolation gained(place, at.velocities.increment());
  alignas(64) double increment[3][block_lanes];
  for (int a = 0; a < 3; ++a) store(increment[a], gained.value[a]);
  Vec3<double> impulse{}, moment{};
  for (int l = 0; l < used; ++l) {
    const auto get = [&](Column c) { return block[layout.offset(c) + l]; };
    const Vec3<double> wanted = loads_.motion(body).velocity.velocity(block + l);
    Vec3<double> missing{}, x{};
    for (int a = 0; a < 3; ++a) {
      missing[a] = get(Column::mass) * (wanted[a] - get(next(Column::velocity_x, a)) - increment[a][l]);
      x[a] = get(next(Column::position_x, a));
    }
    impulse = impulse + missing;
    moment = moment + cross(x, missing);
  }
  ReactionSums& sums = reaction_of(body, at);
  sums.add(ReactionSums::impulse, impulse);
  sums.add(ReactionSums::moment, moment);
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::move_particles(const AlignedDoubles& displacements,
                                           const AlignedDoubles* velocities, const AlignedDoubles* lags) {
  departing_.resize(static_cast<std::size_t>(model_.grid->owned()));
  for (auto& of_slot : departing_) of_slot.clear();
  for_bricks([&](Slot s, Scratch& at) {
    for (const BrickField& field : fields_.of(s))
      move_field(field, displacements, velocities, lags, departing_[static_cast<std::size_t>(s)], at);
    at.add_work_of_brick();
  });
}

template <ShapePolicy S>
void ImplicitPassesWith<S>::move_field(const BrickField& field, const AlignedDoubles& displacements,
                                       const AlignedDoubles* velocities, const AlignedDoubles* lags,
                                       std::vector<DepartingParticle>& departing, Scratch& at) {
  const BrickFrame frame(*model_.grid, field.slot, field.number);
  at.displacements.take_strain(frame, records(displacements, field));
  at.displacements.take_motion(records(displacements, field));
  if (velocities != nullptr) at.velocities.take_motion(records(*velocities, field));
  if (lags != nullptr) at.lags.take_motion(records(*lags, field));
  for_each_tile(field, true, [&](const ParticleTile& tile, const Body& body) {
    if (averages(body)) find_dilatations(tile, body, frame, at);
    for_each_batch(tile, frame, Blocks::own, at, [&](std::size_t first) {
      Batch& batch = at.batch;
      take_strains(frame, body, at);
      for (int b = 0; b < batch.blocks; ++b)
        move_block(frame, tile, b, batch.block[b], tile.used_lanes(first + static_cast<std::size_t>(b)),
                   velocities != nullptr, lags != nullptr, at);
      body.model->update(batch, model_.options);
      at.statistics.events += batch.events;
      if (batch.layout->has(Column::sound_speed)) {
        for (int b = 0; b < batch.blocks; ++b)
          std::copy_n(batch.sound_speed + block_lanes * b, block_lanes, batch.column(Column::sound_speed, b));
      }
      at.statistics.fastest = fastest_particle(batch, 1 / wave_limit(model_), at.statistics.fastest);
      const auto c = static_cast<int>(&tile - model_.grid->brick(field.slot).tiles.data());
      for (int b = 0; b < batch.blocks; ++b) {
        const std::size_t at_block = first + static_cast<std::size_t>(b);
        find_departing(c, at_block, frame, 0, failed_.of(tile), *batch.layout, batch.block[b],
                       tile.used_lanes(at_block), departing);
      }
    });
  });
}

}  // namespace mpm::core
