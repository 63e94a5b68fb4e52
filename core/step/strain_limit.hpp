// Bodies that meet, or reach a wall, at a good part of the speed of waves. The critical step follows from the
// waves and speeds of the last step, when they had not met: in the step in which they first share nodes it
// lets particles strain by up to factor |v|/(c/k + |v|), and the energy that the stress and the artificial
// viscosity of that strain take is far more than the motion has (a copper ball that strikes a plate at 20
// km/s: 77 % of the energy at the start, in one step). Where the scene's velocities may come to that, each
// step is shortened, once the velocities at its start are on the grid, so that neighbouring nodes approach by
// at most 0.15 of their distance (docs/stability.md).
//
// A node's velocity is a mean of those of the particles around it. Bricks around which the particles'
// velocities differ by too little are passed over; the nodes of the others are compared.
#pragma once

#include <limits>
#include <vector>

#include "core/grid/brick_grid.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Whether velocities between bodies or against walls, of the input or as gravity may make them, can strain a
/// particle by more in a step that the scene's factor allows. With velocities that are expressions, and with
/// explosives, they may.
bool strain_may_jump(const Model& model);
/// The strain rate above which a step of this length is shortened, 1/time.
double strain_rate_limit(double dt);
/// `dt`, or less where the largest strain rate asks for it.
double limited_step(double dt, double rate);

/// Largest difference of the strain velocities of neighbouring nodes of a brick over their distance, 1/time.
/// `record`: MotionRecords; nodes without mass do not count.
double largest_strain_rate(const NodeBlockShape& shape, const Vec3<double>& inverse_cell, double mass_cutoff,
                           const double* record);

/// The smallest box that holds the velocities of some particles; empty at first.
struct VelocityRange {
  Vec3<double> lowest = unbounded, highest = -1.0 * unbounded;
  static constexpr Vec3<double> unbounded{std::numeric_limits<double>::infinity(),
                                          std::numeric_limits<double>::infinity(),
                                          std::numeric_limits<double>::infinity()};
  void include(const VelocityRange& other);
};
/// Of a brick's particles.
VelocityRange velocity_range(const Model& model, Slot s);
/// Whether the strain rate in a brick can be above `rate`, from the ranges of the owned bricks. True beside
/// walls, whose images are no means, and beside bricks of other ranks, whose ranges are not known.
bool may_strain_faster(const BrickGrid& grid, const std::vector<VelocityRange>& ranges, Slot s, double rate);

}  // namespace mpm::core
