// Velocities that the grid does not determine, and the work of prescribed velocities, gravity and damping:
// the less frequent parts of a block's update.
#pragma once

#include "core/contact/failed_component.hpp"
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
  double work_of_stress = 0;                ///< the work of its stresses
  double gain_of_work = 0;                  ///< USAVG: what the last half step has added to it
  alignas(64) double old[3 * block_lanes];  ///< a block's velocities or positions before an update
  AlignedDoubles nodes, sums;  ///< of the current brick: records of node_doubles, one cache line each
  void add_work_of_brick() {
    if (work != 0) statistics.work.add(work);
    work = 0;
  }
};

/// Sets velocities to the prescribed ones. The constraint supplies the momentum m (v_p - v), which works with
/// the mean of v_p and the velocity before, in at.old, at the particle's position at the start of the step.
void prescribe_velocities(const ColumnLayout& layout, const BodyMotion& motion, double* block, int used,
                          ThreadScratch& at);
/// v *= factor.
void scale_velocities(double factor, const ColumnLayout& layout, double* block);
/// Applies LimitVelocity.
void limit_velocities(const ColumnLayout& layout, double limit, double* block, int used, ThreadScratch& at);
/// Velocities of a free rigid body: those in at.old, accelerated by `acceleration`. The force that replaces
/// the grid's velocities, which the block holds, by these does work, with the mean of the old and the new
/// ones.
void integrate_rigid_velocities(const ColumnLayout& layout, const Vec3<double>& acceleration, double dt,
                                double* block, int used, ThreadScratch& at);
/// x += dt v with the particles' own velocities.
void move_at_own_velocity(const ColumnLayout& layout, double dt, double* block);
/// A particle moves with its new velocity, but a force on it works with the mean of the old and the new one,
/// over the time between these: replaces the work of its weight (`weight` is per mass) over the displacement,
/// m g . v dt, by m g . (v_old + v) velocity_dt/2, v_old in at.old. Over the run this adds up to no more than
/// one step's fall, but at the start of a fall that is much.
void correct_work_of_weight(const Vec3<double>& weight, double dt, double velocity_dt,
                            const ColumnLayout& layout, const double* block, int used, ThreadScratch& at);

/// Work of the damping that has taken the part `damped` of the velocities in at.old: with the mean of these
/// and the new ones.
void add_work_of_damping(double damped, const ColumnLayout& layout, const double* block, int used,
                         ThreadScratch& at);
/// Work of weight over a block's displacement from the positions in at.old.
void add_work_of_motion(const Vec3<double>& weight, const ColumnLayout& layout, const double* block, int used,
                        ThreadScratch& at);

/// USF, and USAVG at the start of a step, take the velocity gradient L at the particles' new positions,
/// x = x_old + dt v(x_old), for the deformation of the motion that led there. Relative to the old positions,
/// as the other schemes have it, it is
///   dv/dx_old = L dx/dx_old = (I - dt L)^-1 L
/// With L itself, compression would be overestimated by |dt L|/2 of itself: a shock of 1500 m/s in copper
/// gains 20 % of energy at a factor of 0.6. Its trace gives the change of volume to the first order; the
/// forces work on dt tr L of the new volume, which V (1 + dt tr) has with `of_new_volume`, and V exp(dt tr)
/// with `unchanged`: as the gradient at the old positions with the same formulas has that of the old volume.
/// With the trace of the other one a brittle block that hits a wall loses 2 to 3 % of its energy with USF.
/// For the batch's particles at .. at + 7; gradients with which the step would stretch the old positions more
/// than tenfold are left alone.
enum class ReferredTrace { of_gradient, of_new_volume, unchanged };
void refer_gradient_to_old_positions(Batch& batch, int at, double dt, ReferredTrace trace, bool cell_strain);

/// Work of a batch's updated stresses, artificial viscosity included, over the step's strain, as the internal
/// energy counts it.
///
/// The explicit schemes keep velocities of half a step ago beside the stresses of now: without any loss the
/// sum of kinetic and internal energy oscillates by the work of half a step, which is not small in a shock.
/// With P^n the power of the stresses of step n and steps of one length,
///   (K^{n+1/2} - K^{n-1/2})/dt = -(P^n(v^{n-1/2}) + P^n(v^{n+1/2}))/2
///   (U^{n+1} - U^n)/dt         =  (P^n(v^{n+1/2}) + P^{n+1}(v^{n+1/2}))/2
/// so that K^{n+1/2} + U^{n+1} - dt P^{n+1}(v^{n+1/2})/2 is conserved: the state after a step of MUSL or USL.
/// A step of USF ends with v^{n+1/2} and U^n, and dt P^n(v^{n-1/2})/2 is added, to first order.
///
/// A step of USAVG ends with v^{n+1/2} and, after half of its strain, with U^{n+1/2}:
///   U^{n+1/2} - U^{n-1/2} = dt (P^{n-1/2}(v^{n-1/2}) + P^n(v^{n-1/2}) + P^n(v^{n+1/2}) +
///   P^{n+1/2}(v^{n+1/2}))/4
/// so that, to the third order, K^{n+1/2} + U^{n+1/2} - dt (P^{n+1/2} - P^n)(v^{n+1/2})/4 is conserved. The
/// artificial viscosity is not part of that term: the one that acts in step n does the work of both halves
/// (Batch::new_viscosity). All powers of a step's forces and halves are those with the gradients at x^n.
double work_of_stress(const Batch& batch);
/// The work of a batch's stresses as they are, without artificial viscosity, over the strain of its update
/// and the volume before it; called before the update and after it (`updated`).
double work_of_present_stress(const Batch& batch, bool updated);

/// Records the particles of vanishing volume or negative energy, where the scene checks for them.
void name_unphysical(const WarnInput& warn, const Body& body, const Batch& batch, StepStatistics& statistics);

/// Records the particles of a block that are eroded, have left the brick, or belong to another tile of it.
/// Particles smaller than `erosion_volume` are eroded. Returns the lanes of those that stay.
unsigned find_departing(int tile, std::size_t b, const BrickFrame& frame, double erosion_volume,
                        const FailedComponent::Membership& membership, const ColumnLayout& layout,
                        const double* block, int used, std::vector<DepartingParticle>& departing);

}  // namespace mpm::core
