// Particles that leave their brick: out of the old cohort, into the new one, on this rank or another.
//
// The order inside a cohort decides the order of sums, so it must not depend on who carried a particle where:
// those that leave are taken out in descending order, those that arrive are appended in the order of identities.
#pragma once

#include <string>

#include "core/model.hpp"
#include "core/step/exchange.hpp"
#include "core/step/passes.hpp"

namespace mpm::core {

class Migration {
 public:
  Migration(Model& model, Exchange& exchange);

  /// Take the leavers of every brick out; those that leave the grid or are eroded are booked and gone.
  void collect(std::vector<std::vector<Leaver>>& leavers);
  /// True if some of what was collected goes to a brick that this rank has never heard of.
  bool wants_new_bricks() const { return !wanted_.empty(); }
  /// Bring everybody home. `claim`: some rank wants new bricks. Collective.
  void deliver(bool claim);

  /// Every now and then: particles in the order of their cells, bricks without particles forgotten. Collective.
  void tidy();

  /// Problems that end the run, in words; empty if there are none.
  const std::string& complaint() const { return complaint_; }
  /// Particles that left the grid in the last collect(), and the first of them in words.
  std::int64_t left_now() const { return left_now_; }
  const std::string& first_left() const { return first_left_; }

 private:
  void dispose(const Body& body, std::size_t body_index, const double* columns, bool eroded);
  void insert();

  Model& model_;
  Exchange& exchange_;
  Travellers travellers_;
  std::vector<BrickCoord> wanted_;
  std::vector<int> columns_of_;
  std::string complaint_;
  std::int64_t left_now_ = 0;
  std::string first_left_;
};

/// Append travellers to their bricks, which must be ours: each cohort's in ascending order of identity.
void insert_travellers(Model& model, const Travellers& travellers);

/// Particles of a cohort in ascending order of their cells, otherwise as they were.
void sort_by_cell(const BrickGrid& grid, BrickCoord brick, BlockPool& pool, Cohort& cohort);

/// Particles of a cohort in ascending order of identity.
void sort_by_identity(BlockPool& pool, Cohort& cohort);

/// `particle 17 of body "bar" at (1.2, 3, 4)`
std::string describe_particle(const Body& body, const double* columns);

}  // namespace mpm::core
