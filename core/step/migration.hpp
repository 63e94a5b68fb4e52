// Particles that leave their brick: out of the old tile, into the new one, on this rank or another.
//
// The order inside a tile decides the order of sums, so it must not depend on who carried a particle where:
// those that leave are taken out in descending order, those that arrive are appended in the order of
// identities.
#pragma once

#include <string>
#include <vector>

#include "core/communication/communication.hpp"
#include "core/model.hpp"
#include "core/step/integrator.hpp"
#include "core/step/offending_particle.hpp"

namespace mpm::core {

class Migration {
 public:
  Migration(Model& model, Communication& communication);

  /// Take the departing particles out of every brick; those that leave the grid or are eroded are booked and
  /// gone.
  void collect(std::vector<std::vector<DepartingParticle>>& departing);
  /// True if some of what was collected goes to a brick that this rank has never heard of.
  bool wants_new_bricks() const { return !wanted_.empty(); }
  /// Bring everybody home. `claim`: some rank wants new bricks. Collective.
  void deliver(bool claim);

  /// Every now and then: particles in the order of their cells, bricks without particles forgotten.
  /// Collective.
  void sort_and_prune();

  /// A problem of the last collect() that ends the run; empty if there is none.
  const OffendingParticle& fault() const { return fault_; }
  /// Particles that left the grid in the last collect(), and the first few of them.
  std::int64_t left_now() const { return left_now_; }
  const OffendingParticles& first_left() const { return first_left_; }

 private:
  /// What one thread finds; threads share the bricks out among themselves.
  struct ThreadMigration {
    MigrationBuffer particles;
    std::vector<BrickCoord> wanted;
    Ledger ledger;
    std::int64_t left = 0;
    OffendingParticles first_left;
    OffendingParticle fault;
  };
  void collect_from(Slot slot, std::vector<DepartingParticle>& departing, ThreadMigration& mine);
  void dispose(std::size_t body, const double* columns, bool eroded, ThreadMigration& mine) const;
  void merge(ThreadMigration& mine);

  Model& model_;
  Communication& communication_;
  std::vector<ThreadMigration> by_thread_;  ///< by thread
  MigrationBuffer particles_;
  std::vector<BrickCoord> wanted_;
  std::vector<int> columns_of_;
  std::int64_t left_now_ = 0;
  OffendingParticles first_left_;
  OffendingParticle fault_;
};

/// `particle 17 of body "bar" at (1.2, 3, 4)`
std::string describe_particle(const Body& body, const double* columns);

}  // namespace mpm::core
