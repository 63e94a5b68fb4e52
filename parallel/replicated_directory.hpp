// core::BrickDirectory in which every rank stores the owner of every brick: 16 bytes per brick of the run on
// each rank. Ranks without bricks participate like any other.
//
// A brick that its first particle enters is assigned to the rank that shares most nodes with it (the lowest
// on ties), or, in a uniform decomposition, to the rank of its box. No result of the run depends on the
// assignment.
#pragma once

#include <optional>

#include "core/communication/brick_directory.hpp"
#include "parallel/brick_table.hpp"
#include "parallel/decomposition.hpp"
#include "parallel/mpi.hpp"

namespace mpm::parallel {

/// For one grid, from its first partition() on; the grid's bricks change only through this.
class ReplicatedDirectory final : public core::BrickDirectory {
 public:
  explicit ReplicatedDirectory(const Communicator& comm) : comm_(comm) {}

  void partition(core::BrickGrid& grid, std::span<const core::BrickCount> counts,
                 const core::DecompositionInput& how) override;
  void activate(core::BrickGrid& grid, std::span<const core::BrickCoord> wanted) override;
  void deactivate(core::BrickGrid& grid, std::span<const core::BrickCoord> empty) override;
  std::int32_t owner_nearby(core::BrickCoord b) const override { return table_.owner(b); }
  std::vector<std::int32_t> owners(std::span<const core::BrickCoord> bricks) const override;

  /// The same on every rank.
  const BrickTable& table() const { return table_; }

 private:
  /// All ranks' counts, each brick once, by key. Collective.
  std::vector<core::BrickCount> merged(std::span<const core::BrickCount> counts) const;
  /// Collective.
  std::vector<std::int32_t> owners_of(const core::BrickGrid& grid, std::span<const core::BrickCount> bricks,
                                      const core::DecompositionInput& how);
  std::int32_t owner_of_new(const core::BrickGrid& grid, core::BrickCoord b, std::int32_t asker) const;
  bool mine(core::BrickCoord b) const { return table_.owner(b) == comm_.rank(); }
  bool touches_mine(core::BrickCoord b) const;
  void refresh(core::BrickGrid& grid, std::span<const core::BrickCoord> changed);

  const Communicator& comm_;
  BrickTable table_;
  std::optional<UniformBoxes> boxes_;  ///< of a uniform decomposition
};

}  // namespace mpm::parallel
