// Bodies that meet, or reach a wall, at a good part of the speed of waves. The critical step follows from the
// waves and speeds of the last step, when they had not met: in the step in which they first share nodes it
// lets particles strain by up to factor |v|/(c/k + |v|), and the energy that the stress and the artificial
// viscosity of that strain take is far more than the motion has (a copper ball that strikes a plate at 20
// km/s: 77 % of the energy at the start, in one step). Where the input's velocities allow that, each step is
// shortened, once the velocities at its start are on the grid, so that neighbouring nodes approach by at most
// 0.15 of their distance (docs/stability.md). Limits: velocities that are expressions, or that bodies reach
// in the run, do not count for the choice of scenes.
#pragma once

#include "core/grid/brick_grid.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Whether the input's velocities, between bodies or against walls, may strain a particle by more in a step
/// that the scene's factor allows.
bool strain_may_jump(const Model& model);
/// `dt`, or less where the largest strain rate asks for it.
double limited_step(double dt, double rate);

/// Largest difference of the strain velocities of neighbouring nodes of a brick over their distance, 1/time.
/// `record`: MotionRecords; nodes without mass do not count.
double largest_strain_rate(const NodeBlockShape& shape, const Vec3<double>& inverse_cell, double mass_cutoff,
                           const double* record);

}  // namespace mpm::core
