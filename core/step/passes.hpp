// The passes over bricks that make up a time step. Each is one loop over this rank's bricks, distributed over
// its threads; a scheme is a list of passes (explicit_integrator.cpp). One thread processes all particles of
// a brick, so the sums inside it have a fixed order.
//
// passes_with.hpp implements them for any shape functions and transfer.
#pragma once

#include <memory>
#include <vector>

#include "core/contact/rigid_bodies.hpp"
#include "core/step/integrator.hpp"
#include "core/step/loads.hpp"

namespace mpm::core {

class Passes {
 public:
  virtual ~Passes() = default;

  virtual const Loads& loads() const = 0;
  /// Called at the beginning of every step: sets its length and loads.
  virtual void begin_step(const StepLength& length) = 0;
  /// Largest strain rate of this rank's cells with the velocities at the start of the step, once they are on
  /// the grid, or a smaller number where it is not above `above` (strain_limit.hpp); and a step that is to be
  /// shorter than begun, before it has been used.
  virtual double largest_strain_rate(double above) = 0;
  virtual void shorten_step(const StepLength& length) = 0;

  /// Contact: the velocity fields of the components, then the surfaces of those that meet, to the grid. Only
  /// where there is contact.
  virtual void find_fields(Reductions& ranks) = 0;
  virtual void map_surfaces() = 0;
  /// The nodes where they meet, with normals; then how far the bodies reach from these, and the pairs that
  /// are near enough.
  virtual void find_meetings() = 0;
  virtual void map_reach() = 0;
  virtual void drop_distant_pairs() = 0;
  /// The motion of free rigid bodies at the end of the step, once the nodes have what they need for theirs;
  /// and with the corrected velocities of the nodes, once these have all orders. Only where there are any.
  /// Collective.
  virtual void find_rigid_motion() = 0;
  virtual void correct_rigid_motion() = 0;
  /// Rigid bodies at the end of the step, with the impulses of contact on them. Only where there are any.
  virtual void move_rigid_bodies() = 0;

  /// Particles to grid. Bricks shared with other ranks come first; their exchange is in progress when this
  /// returns.
  virtual void map_momentum_mass_force() = 0;
  virtual void map_momentum_mass() = 0;
  /// USF, USAVG: the forces before the strain, which tell what rigid walls hold.
  virtual bool needs_forces_at_start() const = 0;
  virtual void map_forces_at_start() = 0;
  virtual void finish_exchange() = 0;

  /// XPIC and FMPM: momentum of order `order`, from 2, to grid, once the forces are there. Nothing happens in
  /// steps without correction.
  virtual void correct_velocities(int order) = 0;
  virtual void finish_correction() = 0;

  /// Consistent mass: solves for one of the nodes' velocities or increments, with its exchanges. Collective,
  /// with the neighbouring ranks.
  enum class MassSystem { velocity_at_start, velocity_at_end, increment, new_velocity };
  virtual void solve_mass(MassSystem system) = 0;

  /// MUSL, USAVG: nodal equation of motion, v += dv, and the new momentum back to the nodes.
  virtual void update_velocities_and_map_back() = 0;
  /// MUSL, USAVG: strain with the re-mapped velocity, USAVG over half of the step, stress, then move.
  virtual void update_stress_and_move() = 0;

  /// USF, USAVG: strain with the velocity at the start of the step, USAVG over the last step's other half,
  /// stress, and its forces to the nodes.
  virtual void update_stress_and_map_forces() = 0;
  /// USF: nodal equation of motion with the new stress, v += dv, then move.
  virtual void update_velocities_and_move() = 0;

  /// USL: nodal equation of motion, strain and stress, v += dv, then move.
  virtual void update_all() = 0;

  virtual std::vector<std::vector<DepartingParticle>>& departing() = 0;
  virtual StepStatistics take_statistics() = 0;
};

/// With shape functions S and transfer T; instantiated in passes_<shape>.cpp.
template <class S, class T>
std::unique_ptr<Passes> make_passes_with(Model& model, NodeHalo& halo, RigidBodies* rigid);
/// The passes for the scene's shape functions and transfer: the only place where they are chosen.
/// `rigid`: the rigid bodies in contact; null without.
std::unique_ptr<Passes> make_passes(Model& model, NodeHalo& halo, RigidBodies* rigid);
/// The columns that the scene's shape functions and transfer add to every particle.
ColumnSet shape_columns(const Scene& scene);
ColumnSet transfer_columns(const Scene& scene);
/// Whether affine transfers, or the consistent mass matrix, go with these shape functions.
bool affine_transfers_go_with(ShapeFunction shape);
bool consistent_mass_goes_with(ShapeFunction shape);
/// How bricks take particles for the scene's shape functions, and the nodes that a brick keeps.
Site site_of(const Scene& scene);
NodeBlockShape node_block_of(const Scene& scene);
/// The node arrays that a scheme and the scene's heat conduction use.
NodeArraySet node_arrays_of(const Scene& scene, Scheme scheme, bool conducts);

/// Doubles that XPIC, FMPM and solutions with the consistent mass matrix keep for a brick; 0 without.
int product_doubles_of(const Scene& scene);

}  // namespace mpm::core
