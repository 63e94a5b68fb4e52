// What decides velocities beside the grid, and the work that this, gravity and damping do: the rarer parts of
// the update of one block.
#pragma once

#include "core/material/batch.hpp"
#include "core/shape/brick_frame.hpp"
#include "core/step/integrator.hpp"
#include "core/step/loads.hpp"
#include "core/step/node_update.hpp"

namespace mpm::core {

/// Buffers and results of one thread.
struct alignas(128) ThreadScratch {
  Batch batch;
  StepStatistics statistics;
  double work = 0;                          ///< external, of the brick at hand
  alignas(64) double old[3 * block_lanes];  ///< a block's velocities or positions before an update
  AlignedDoubles nodes, sums;  ///< of the brick at hand: records of node_doubles, each a cache line
  void add_work_of_brick() {
    if (work != 0) statistics.work.add(work);
    work = 0;
  }
};

/// Velocities become `prescribed`; what holds them gives momentum m (v_p - v) at velocity v_p.
void prescribe_velocities(const ColumnLayout& layout, const Vec3<double>& prescribed, double* block, int used,
                          ThreadScratch& at);
/// LimitVelocity.
void limit_velocities(const ColumnLayout& layout, double limit, double* block, int used, ThreadScratch& at);
/// Velocities of a rigid body that nothing guides: those in at.old, accelerated by `acceleration`. What turns
/// the grid's answer, which the block holds, into that does work.
void integrate_rigid_velocities(const ColumnLayout& layout, const Vec3<double>& acceleration, double dt,
                                double* block, int used, ThreadScratch& at);
/// x += dt v of the particles themselves.
void move_at_own_velocity(const ColumnLayout& layout, double dt, double* block);
/// The work of gravity and damping in the motion that a block has just made from the positions in at.old.
void add_work_of_motion(const NodeForces& forces, const ColumnLayout& layout, const double* block, int used,
                        ThreadScratch& at);

/// Names the particles whose volume would have vanished or whose energy is negative, as far as the scene
/// watches them.
void name_unphysical(const WarnInput& warn, const Body& body, const Batch& batch, StepStatistics& statistics);

/// Adds the particles of a block that are eroded or have moved out of the brick. `erosion_volume`: particles
/// with less are eroded.
void find_departing(int tile, std::size_t b, const BrickFrame& frame, double erosion_volume,
                    const ColumnLayout& layout, const double* block, int used,
                    std::vector<DepartingParticle>& departing);

}  // namespace mpm::core
