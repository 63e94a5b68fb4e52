// Migration: moves particles that leave their brick from the old tile to the new one, on this rank or
// another.
//
// The order inside a tile decides the order of sums, so it must not depend on ranks or threads: departing
// particles are removed in descending order, arriving ones are appended in order of identity.
//
// Explicit steps move a particle by less than a cell. Implicit ones may move it over any number of bricks: to
// a brick of any rank, whose owner is then asked of the directory.
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

  /// Removes the departing particles from every brick; those that leave the grid or are eroded are recorded
  /// in the ledger and deleted.
  void collect(std::vector<std::vector<DepartingParticle>>& departing);
  /// True if a collected particle enters a brick that does not exist or that this rank does not know: one
  /// that is not next to a brick of this rank.
  bool wants_new_bricks() const { return !wanted_.empty(); }
  /// Sends all collected particles to the owners of their bricks. `claim`: some rank needs new bricks.
  /// Collective.
  void deliver(bool claim);

  /// At regular intervals: sorts particles by cell and removes empty bricks. Collective.
  void sort_and_prune();

  /// An error in the last collect() that ends the run; empty if there is none.
  const OffendingParticle& fault() const { return fault_; }
  /// Particles that left the grid in the last collect(), and the first few of them.
  std::int64_t left_now() const { return left_now_; }
  const OffendingParticles& first_left() const { return first_left_; }

 private:
  /// Results of one thread; the bricks are distributed over the threads.
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
  const bool far_;                          ///< steps may move particles by more than one brick
  std::vector<int> columns_of_;             ///< by body
  std::vector<ThreadMigration> by_thread_;  ///< by thread
  MigrationBuffer particles_;
  std::vector<BrickCoord> wanted_;
  std::int64_t left_now_ = 0;
  OffendingParticles first_left_;
  OffendingParticle fault_;
};

/// `particle 17 of body "bar" at (1.2, 3, 4)`
std::string describe_particle(const Body& body, const double* columns);

}  // namespace mpm::core
