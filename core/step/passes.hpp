// The passes over bricks that a time step is made of. Each is one loop over this rank's bricks, shared by its
// threads; a scheme is a list of them (explicit_integrator.cpp). A brick is worked on by one thread from its
// first particle to its last, so sums inside it have one order.
//
// passes_with.hpp implements them for any shape and transfer.
#pragma once

#include <memory>
#include <vector>

#include "core/step/integrator.hpp"
#include "core/step/loads.hpp"

namespace mpm::core {

class Passes {
 public:
  virtual ~Passes() = default;

  virtual const Loads& loads() const = 0;
  /// Every step begins with this: its length, and the loads that act in it.
  virtual void begin_step(double dt) = 0;

  /// Particles to grid; the bricks that other ranks share come first, and their sums are on their way when
  /// this returns.
  virtual void map_momentum_mass_force() = 0;
  virtual void map_momentum_mass() = 0;
  virtual void finish_exchange() = 0;

  /// MUSL: equation of motion on the nodes, v += dv, and the new momentum back to the nodes.
  virtual void update_velocities_and_map_back() = 0;
  /// MUSL: strain with the re-mapped velocity, stress, then move.
  virtual void update_stress_and_move() = 0;

  /// USF: strain with the velocity before the motion, stress, and its forces to the nodes.
  virtual void update_stress_and_map_forces() = 0;
  /// USF: equation of motion with the new stress, v += dv, then move.
  virtual void update_velocities_and_move() = 0;

  /// USL: equation of motion, strain and stress, v += dv, then move.
  virtual void update_all() = 0;

  virtual std::vector<std::vector<DepartingParticle>>& departing() = 0;
  virtual StepStatistics take_statistics() = 0;
};

/// The passes for the scene's shape and transfer: the one place where they are chosen.
std::unique_ptr<Passes> make_passes(Model& model, NodeHalo& halo);
/// The columns that the scene's transfer adds to every particle.
ColumnSet transfer_columns(const Scene& scene);
/// The nodes that a brick keeps for the scene's shape.
NodeBlockShape node_block_of(const Scene& scene);
/// The node arrays that the scene's scheme and its heat conduction write to.
NodeArraySet node_arrays_of(const Scene& scene, bool conducts);

}  // namespace mpm::core
