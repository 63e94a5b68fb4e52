// Velocities that the grid does not determine, and the work of prescribed velocities, gravity and damping:
// the less frequent parts of a block's update.
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
  double work = 0;                          ///< external work of the current brick
  alignas(64) double old[3 * block_lanes];  ///< a block's velocities or positions before an update
  AlignedDoubles nodes, sums;  ///< of the current brick: records of node_doubles, one cache line each
  void add_work_of_brick() {
    if (work != 0) statistics.work.add(work);
    work = 0;
  }
};

/// Sets velocities to the prescribed ones; the constraint supplies the momentum m (v_p - v) at velocity v_p.
void prescribe_velocities(const ColumnLayout& layout, const PrescribedMotion& prescribed, double* block,
                          int used, ThreadScratch& at);
/// Applies LimitVelocity.
void limit_velocities(const ColumnLayout& layout, double limit, double* block, int used, ThreadScratch& at);
/// Velocities of a free rigid body: those in at.old, accelerated by `acceleration`. The force that replaces
/// the grid's velocities, which the block holds, by these does work.
void integrate_rigid_velocities(const ColumnLayout& layout, const Vec3<double>& acceleration, double dt,
                                double* block, int used, ThreadScratch& at);
/// x += dt v with the particles' own velocities.
void move_at_own_velocity(const ColumnLayout& layout, double dt, double* block);
/// Work of gravity and damping over a block's displacement from the positions in at.old.
void add_work_of_motion(const NodeForces& forces, const ColumnLayout& layout, const double* block, int used,
                        ThreadScratch& at);

/// Records the particles of vanishing volume or negative energy, where the scene checks for them.
void name_unphysical(const WarnInput& warn, const Body& body, const Batch& batch, StepStatistics& statistics);

/// Records the particles of a block that are eroded or have left the brick. Particles smaller than
/// `erosion_volume` are eroded.
void find_departing(int tile, std::size_t b, const BrickFrame& frame, double erosion_volume,
                    const ColumnLayout& layout, const double* block, int used,
                    std::vector<DepartingParticle>& departing);

}  // namespace mpm::core
