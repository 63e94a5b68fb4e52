// The passes over bricks of an implicit step: what particles map to the grid, the forces and their derivative
// for a displacement of the nodes, and the motion of particles once it is found. implicit_passes_with.hpp
// implements them for any shape functions.
#pragma once

#include <memory>

#include "core/contact/rigid_bodies.hpp"
#include "core/implicit/newton_solver.hpp"
#include "core/implicit/node_unknowns.hpp"
#include "core/implicit/step_motion.hpp"
#include "core/step/integrator.hpp"
#include "core/step/loads.hpp"

namespace mpm::core {

class ImplicitPasses {
 public:
  virtual ~ImplicitPasses() = default;

  virtual const Loads& loads() const = 0;
  /// Sets the step's length and loads, taken at `part` of it.
  virtual void begin_step(double dt, double part) = 0;

  // Contributions of this rank's bricks to the first node array, by field.
  /// mapped::implicit_start; gravity and loads are the external force.
  virtual void map_start() = 0;
  /// mapped::implicit_motion.
  virtual void map_motion() = 0;
  /// mapped::implicit_surface: sums of V grad S and of V S, of rigid bodies in contact too.
  virtual void map_surface() = 0;
  /// mapped::implicit_lag, of particles that carry one.
  virtual void map_lag() = 0;
  /// The same fields: volume times the change of velocity in the step, of bodies of prescribed motion.
  virtual void map_drive() = 0;
  /// mapped::implicit_force: internal forces at the end of the step, with the nodes' displacements in
  /// MotionRecords, and the sums of their absolute values.
  /// The particles do not change. False where one of them inverts or its stress is not finite.
  virtual bool map_forces(const AlignedDoubles& displacements) = 0;

  /// Adds the derivative of the residual, minus the internal forces, by the unknowns; without `displacements`
  /// its structure alone. Held components have neither rows nor columns.
  virtual void add_tangent(const AlignedDoubles* displacements, const NodeUnknowns& unknowns,
                           BlockMatrix& matrix) = 0;

  /// Adds the reactions of bodies of prescribed motion, with the impulses on the nodes that they hold over
  /// the volume that they fill there, in MotionRecords. Before the particles move.
  virtual void add_reactions(const AlignedDoubles& impulses) = 0;

  /// What the displacements do to this rank's particles, which do not change.
  virtual StepMotion motion_of(const AlignedDoubles& displacements) = 0;
  /// Moves the particles by the displacements, updates their stress and, where the step is dynamic, adds the
  /// increments of `velocities` (4..6 of its records) to theirs; quasi-static particles are at rest. `lags`:
  /// increments of the lag of the acceleration, where particles carry one.
  virtual void move_particles(const AlignedDoubles& displacements, const AlignedDoubles* velocities,
                              const AlignedDoubles* lags) = 0;

  virtual std::vector<std::vector<DepartingParticle>>& departing() = 0;
  virtual StepStatistics take_statistics() = 0;
};

/// For the scene's shape functions. `rigid`: the rigid bodies in contact, which give the nodes nothing but
/// their surface; null without. `with_faces`: bodies that act at their faces (body_faces.hpp), which give
/// nodes that they share with others nothing. `fields` and `rigid` outlive the passes.
std::unique_ptr<ImplicitPasses> make_implicit_passes(Model& model, const RigidBodies* rigid,
                                                     std::span<const int> with_faces,
                                                     const BrickFields& fields);

}  // namespace mpm::core
