// The state of a run on one rank: the grid's bricks with their particles, the bodies, the clock and the
// ledger.
//
// Particles are reached as grid -> brick -> tile (one per body) -> blocks of eight. The model contains
// everything that a restart file must store, and nothing else.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/contact/contact_record.hpp"
#include "core/contact/rigid_state.hpp"
#include "core/exact_sum.hpp"
#include "core/grid/brick_grid.hpp"
#include "core/material/constitutive_model.hpp"
#include "core/reaction.hpp"
#include "core/scene/scene.hpp"

namespace mpm::core {

/// A body of the run. Bodies are numbered in the order of the input.
struct Body {
  std::string name;
  int component = 0;  ///< index into the scene's components
  int material = 0;   ///< index into the scene's materials
  const ConstitutiveModel* model = nullptr;
  std::optional<Vec3<double>> prescribed_velocity;
  bool rigid = false;                     ///< moves freely under gravity where no velocity is prescribed
  std::optional<RigidState> rigid_state;  ///< in contact; the same on all ranks
  std::vector<double> face_forces;        ///< of implicit steps (body_faces.hpp); the same on all ranks
  bool inertia_given = false;  ///< energy of rotation and spin follow from the rigid state, not its particles
  bool no_output = false;
  /// Memory of this rank's particles; bodies with the same columns share one.
  std::shared_ptr<BlockPool> pool;
};

/// What the looks at the energy balance keep (core/step/scheme_change.hpp).
struct BalanceLooks {
  double scale = 0;  ///< the largest energy of the balance so far
  double last = 0;   ///< the error at the last look, relative to that
  double early = 0;  ///< the error at the first look of a long run
};

struct Clock {
  std::int64_t step = 0;  ///< steps completed
  double time = 0;        ///< of the particles' current state
  double dt = 0;          ///< of the last step
  double lag = 0;         ///< of the velocities behind `time` (core/step/step_length.hpp)
  double first_lag = 0;   ///< the same after the first step
  /// Largest stable step for the current state, factor not included; 0 before the first estimate.
  double critical_dt = 0;
  double first_critical_dt = 0;  ///< for TimeStep const="1"
  double strain_lag = 0;         ///< USAVG: of strains and stresses behind `time`
  double heat_lead = 0;          ///< by which heat conduction is ahead of `time`
  double next_dt = 0;            ///< of implicit steps: length of the next one; 0: not known
  /// The step after which USAVG has replaced the scene's scheme; 0: it has not.
  std::int64_t scheme_since = 0;
  BalanceLooks looks{};
};

/// Energy and mass added and removed since time zero. Exact sums: the same on any ranks.
struct Ledger {
  ExactSum external_work;  ///< by gravity, prescribed velocities and damping; energy
  ExactSum removed_mass;   ///< of particles that left the grid or were eroded
  ExactSum removed_kinetic;
  ExactSum removed_internal;
  /// Of the current state, not since time zero: the work by which the internal energy is ahead of the kinetic
  /// one (work_of_stress() in core/step/particle_motion.hpp).
  ExactSum internal_lead;
  ContactRecord contact;
  std::int64_t left_grid = 0;  ///< particles; on this rank
  std::int64_t eroded = 0;
  std::int64_t failed = 0;
  std::int64_t velocity_limited = 0;
  std::int64_t wide_domains = 0, tangled_domains = 0;  ///< in particles times steps
  MaterialEvents events;                               ///< since time zero, on this rank
  std::vector<std::int64_t> body_eroded, body_left;    ///< per body, on this rank
};

struct Model {
  std::shared_ptr<const Scene> scene;
  std::vector<std::unique_ptr<ConstitutiveModel>> materials;
  UpdateOptions options;
  /// Of explicit steps: the scene's, or what has replaced it (core/step/scheme_change.hpp).
  Scheme scheme = Scheme::musl;
  std::vector<Body> bodies;
  std::vector<Reaction> reactions;  ///< of rigid bodies in contact and of prescribed motions, by body
  std::unique_ptr<BrickGrid> grid;
  Clock clock;
  Ledger ledger;
  double initial_energy = 0;  ///< kinetic + internal at time zero
  std::uint64_t next_identity = 0;

  std::size_t local_particles() const {
    std::size_t n = 0;
    for (const Brick& b : grid->bricks()) n += b.particles();
    return n;
  }
};

/// Number of columns of each body's particles.
inline std::vector<int> columns_of(const Model& model) {
  std::vector<int> columns;
  for (const Body& b : model.bodies) columns.push_back(b.pool->layout().columns());
  return columns;
}

/// The pools of the model's bodies, each once, in the order of the bodies.
inline std::vector<BlockPool*> pools_of(const Model& model) {
  std::vector<BlockPool*> pools;
  for (const Body& b : model.bodies) {
    if (std::find(pools.begin(), pools.end(), b.pool.get()) == pools.end()) pools.push_back(b.pool.get());
  }
  return pools;
}

}  // namespace mpm::core
