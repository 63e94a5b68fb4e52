// What a step needs of the other ranks. `parallel` implements it over MPI; `SoloExchange` is one rank alone,
// for which every answer is trivial. The integrators see nothing else of the outside world.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/exact_sum.hpp"
#include "core/grid/brick_grid.hpp"
#include "core/scene/scene.hpp"

namespace mpm::core {

/// Particles on their way to another brick: their columns one after the other, with where they go.
struct Travellers {
  struct Head {
    BrickCoord to;
    std::int32_t body = 0;
    std::int32_t unused = 0;  ///< heads travel in whole doubles
  };
  std::vector<Head> heads;
  std::vector<std::size_t> offsets;  ///< of each particle in `columns`
  std::vector<double> columns;

  void add(BrickCoord to, int body, const double* first, int n) {
    heads.push_back({to, body});
    offsets.push_back(columns.size());
    columns.insert(columns.end(), first, first + n);
  }
  std::size_t size() const { return heads.size(); }
  /// Keeps the room of a usual step. Where a lattice moves with one velocity, whole layers cross at once: too
  /// rare to keep room for.
  void clear() {
    constexpr std::size_t kept = std::size_t{1} << 18;  // doubles
    if (columns.capacity() > kept) *this = {};
    heads.clear();
    offsets.clear();
    columns.clear();
  }
};

struct BrickCount {
  BrickCoord brick;
  std::int64_t particles = 0;
};

class Exchange {
 public:
  virtual ~Exchange() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;

  /// Send our boundary bricks' contributions to shared nodes, these fields of them, and receive the ghosts'.
  /// Between begin and end the boundary bricks' contributions stay untouched. Collective.
  virtual void begin_halo(BrickGrid& grid, NodeFields fields) = 0;
  virtual void end_halo(BrickGrid& grid) = 0;

  /// True on every rank if `mine` is true on any. Collective.
  virtual bool any(bool mine) = 0;
  /// Smallest of every entry over the ranks, in place. Exact. Collective.
  virtual void minimum(std::span<double> values) = 0;
  /// Sum of every entry over the ranks, in place. Collective.
  virtual void sum(std::span<std::int64_t> values) = 0;
  virtual void sum(std::span<ExactSum> values) = 0;

  /// Decide who owns which brick, from the number of particles that every rank found in each (several ranks
  /// may count in one brick), and set up `grid` with the owned and ghost bricks. A decomposition that does
  /// not fit the ranks throws InputErrors on every rank. Collective.
  virtual void partition(BrickGrid& grid, std::span<const BrickCount> counts,
                         const DecompositionInput& how) = 0;
  /// As migrate, but from anywhere to anywhere. Collective.
  virtual void scatter(const BrickGrid& grid, Travellers& travellers, std::span<const int> columns_of) = 0;

  /// Who owns these bricks, that some rank's particles want to enter and that may not exist yet: bricks that
  /// do not are given to a rank, the same one whatever the number of askers. All ranks call it with their own
  /// list (possibly empty); afterwards the owned and ghost bricks of `grid` are up to date. Collective.
  virtual void claim(BrickGrid& grid, std::span<const BrickCoord> wanted) = 0;
  /// Forget these empty bricks of ours, and whatever other ranks forget. Collective.
  virtual void retire(BrickGrid& grid, std::span<const BrickCoord> empty) = 0;
  /// True if the brick exists, on whatever rank.
  virtual bool exists(const BrickGrid& grid, BrickCoord b) const = 0;

  /// Hand over the travellers that another rank's bricks await and receive ours; on return `travellers` holds
  /// all that enter our bricks, in no particular order. `columns_of[body]` is the number of columns.
  /// Collective.
  virtual void migrate(const BrickGrid& grid, Travellers& travellers, std::span<const int> columns_of) = 0;

  /// One line per rank to all ranks, in the order of ranks; for messages that name a particle. Collective.
  virtual std::vector<std::string> gather(const std::string& mine) = 0;
  /// The largest / smallest / sum of a figure that needs no reproducibility (seconds, bytes). Collective.
  struct Spread {
    double min = 0, mean = 0, max = 0;
  };
  virtual Spread spread(double mine) = 0;
};

/// Throws InputErrors unless the dimensions that the scene asks for make up this number of ranks.
void check_decomposition(const DecompositionInput& how, int ranks);

class SoloExchange final : public Exchange {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  void begin_halo(BrickGrid&, NodeFields) override {}
  void end_halo(BrickGrid&) override {}
  bool any(bool mine) override { return mine; }
  void minimum(std::span<double>) override {}
  void sum(std::span<std::int64_t>) override {}
  void sum(std::span<ExactSum>) override {}
  void partition(BrickGrid& grid, std::span<const BrickCount> counts, const DecompositionInput& how) override;
  void scatter(const BrickGrid&, Travellers&, std::span<const int>) override {}
  void claim(BrickGrid& grid, std::span<const BrickCoord> wanted) override;
  void retire(BrickGrid& grid, std::span<const BrickCoord> empty) override;
  bool exists(const BrickGrid& grid, BrickCoord b) const override { return grid.find(b) != no_slot; }
  void migrate(const BrickGrid&, Travellers&, std::span<const int>) override {}
  std::vector<std::string> gather(const std::string& mine) override { return {mine}; }
  Spread spread(double mine) override { return {mine, mine, mine}; }
};

}  // namespace mpm::core
