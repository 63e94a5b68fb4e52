// core::Exchange over MPI. Every rank knows the owner of every brick; particles and nodes go to the ranks
// next to this one only, except in scatter(). Ranks without a brick take part like any other.
//
// A brick that a particle is the first to enter goes to the rank that shares most nodes with it (the lowest
// of several), or, in a uniform decomposition, to the rank of its box. No result of the run depends on who
// owns what.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/step/exchange.hpp"
#include "parallel/decomposition.hpp"
#include "parallel/directory.hpp"
#include "parallel/halo.hpp"
#include "parallel/mpi.hpp"

namespace mpm::parallel {

/// For one grid, from its first partition() on; the grid's bricks change only through this.
class MpiExchange final : public core::Exchange {
 public:
  /// Over the ranks of `parent`. Collective.
  explicit MpiExchange(const Communicator& parent) : comm_(parent.duplicate()), halo_(comm_, directory_) {}
  MpiExchange(const MpiExchange&) = delete;
  MpiExchange& operator=(const MpiExchange&) = delete;

  int rank() const override { return comm_.rank(); }
  int size() const override { return comm_.size(); }

  /// Collective, with the ranks next to this one.
  void begin_halo(core::BrickGrid& grid, core::NodeFields fields) override { halo_.begin(grid, fields); }
  /// Collective, with the ranks next to this one.
  void end_halo(core::BrickGrid& grid) override { halo_.end(grid); }

  /// Collective.
  bool any(bool mine) override;
  /// An entry that is not a number on any rank becomes so on all; -0 is less than 0. Collective.
  void minimum(std::span<double> values) override;
  /// Collective.
  void sum(std::span<std::int64_t> values) override;
  /// Leaves the sums normalised: their limbs, too, are the same on any ranks. Collective.
  void sum(std::span<core::ExactSum> values) override;

  /// May be called again, for the same or for another set of bricks. Collective.
  void partition(core::BrickGrid& grid, std::span<const core::BrickCount> counts,
                 const core::DecompositionInput& how) override;
  /// Holds up to twice the travellers' memory; give it pieces. Throws as migrate() does. Collective.
  void scatter(const core::BrickGrid& grid, core::Travellers& travellers,
               std::span<const int> columns_of) override;

  /// Bricks that exist already may be among the wanted. Collective.
  void claim(core::BrickGrid& grid, std::span<const core::BrickCoord> wanted) override;
  /// Throws std::logic_error, on this rank alone, for a brick that holds particles or is not ours.
  /// Collective.
  void retire(core::BrickGrid& grid, std::span<const core::BrickCoord> empty) override;
  bool exists(const core::BrickGrid&, core::BrickCoord b) const override { return directory_.contains(b); }

  /// Throws std::logic_error, on this rank alone, for a traveller whose brick does not exist or is not next
  /// to one of ours. Collective, with the ranks next to this one.
  void migrate(const core::BrickGrid& grid, core::Travellers& travellers,
               std::span<const int> columns_of) override;

  /// Collective.
  std::vector<std::string> gather(const std::string& mine) override;
  /// Collective.
  Spread spread(double mine) override;

  /// Who owns what; the same on every rank.
  const Directory& directory() const { return directory_; }

 private:
  /// All ranks' counts, each brick once, by key. Collective.
  std::vector<core::BrickCount> merged(std::span<const core::BrickCount> counts) const;
  /// Collective.
  std::vector<std::int32_t> owners(const core::BrickGrid& grid, std::span<const core::BrickCount> bricks,
                                   const core::DecompositionInput& how);
  std::int32_t owner_of_new(const core::BrickGrid& grid, core::BrickCoord b, std::int32_t asker) const;
  std::int32_t owner_of_traveller(const core::Travellers::Head& head) const;
  bool mine(core::BrickCoord b) const { return directory_.owner(b) == rank(); }
  bool touches_mine(core::BrickCoord b) const;
  void refresh(core::BrickGrid& grid, std::span<const core::BrickCoord> changed);

  Communicator comm_;
  Directory directory_;
  Halo halo_;
  std::optional<UniformBoxes> boxes_;  ///< of a uniform decomposition
};

}  // namespace mpm::parallel
