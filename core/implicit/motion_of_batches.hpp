// What a step would do to the particles (step_motion.hpp), batch by batch. Part of
// implicit_passes_with.hpp.
#pragma once

#include "core/implicit/implicit_passes_with.hpp"
#include "core/step/grid_to_particles.hpp"

namespace mpm::core {

template <ShapePolicy S>
void ImplicitPassesWith<S>::find_motion(const ParticleTile& tile, const Body& body, Scratch& at) {
  const Batch& batch = at.batch;
  const ColumnLayout& layout = *batch.layout;
  const GridGeometry& g = model_.grid->geometry();
  const int rigid = this->rigid(tile.body);
  const bool moved = rigid < 0 && prescribed(tile.body), bounded = rigid < 0 && !moved;
  for (int i = 0; i < batch.particles; ++i) {
    const int l = i % block_lanes;
    double* const block = batch.block[i / block_lanes];
    double* const x = block + layout.offset(Column::position_x);
    Vec3<double> first{}, travel{};
    if (l == 0) {
      std::copy_n(x, 3 * block_lanes, at.old);
      if (rigid >= 0)
        rigid_->move(rigid, layout, block);
      else if (!moved)
        MotionOfBlock<S>{at.places[i / block_lanes], at.displacements}.move(layout, 1.0, block);
    }
    if (moved) travel = dt_ * loads_.motion(tile.body).velocity.velocity(block + l);
    for (int a = 0; a < 3; ++a) {
      const double per_cell = g.inverse_cell[a], from = at.old[block_lanes * a + l];
      first[a] = GridGeometry::scaled(from, g.origin[a], per_cell);
      travel[a] = per_cell * (moved ? travel[a] : x[block_lanes * a + l] - from);
      const auto face = static_cast<std::size_t>(2 * a);
      const double last = first[a] + travel[a];
      if (bounded && is_constrained(g.boundary[face])) at.motion.add_beyond_wall(-last);
      if (bounded && is_constrained(g.boundary[face + 1]))
        at.motion.add_beyond_wall(last - static_cast<double>(g.cells[static_cast<std::size_t>(a)]));
    }
    at.motion.add_particle(tile.body, first, travel);
    // A law that fails keeps the gradient for its failure.
    const bool of_gradient = layout.has(Column::f_xx) && !layout.has(Column::failed);
    if (body.model->rigid() || of_gradient) continue;
    double square = 0;
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) {
        const double h = 0.5 * dt_ * (batch.gradient[3 * j + k][i] + batch.gradient[3 * k + j][i]);
        square += h * h;
      }
    at.motion.add_strain(std::sqrt(square));
  }
}

template <ShapePolicy S>
StepMotion ImplicitPassesWith<S>::motion_of(const AlignedDoubles& displacements) {
  for (const auto& w : scratch_) w->motion = StepMotion(model_.bodies.size());
  for_fields([&](const BrickField& field, Scratch& at) {
    const BrickFrame frame(*model_.grid, field.slot, field.number);
    at.displacements.take_strain(frame, records(displacements, field));
    at.displacements.take_motion(records(displacements, field));
    for_each_tile(field, true, [&](const ParticleTile& tile, const Body& body) {
      if (averages(body)) find_dilatations(tile, body, frame, at);
      for_each_batch(tile, frame, Blocks::copies, at, [&](std::size_t) {
        if (!body.model->rigid()) take_strains(frame, body, at);
        find_motion(tile, body, at);
      });
    });
  });
  StepMotion all(model_.bodies.size());
  for (const auto& w : scratch_) all.merge(w->motion);
  return all;
}

}  // namespace mpm::core
