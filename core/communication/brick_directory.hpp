// Which bricks exist and which rank owns each. How this is stored is internal to the directory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/brick_grid.hpp"
#include "core/scene/scene.hpp"

namespace mpm::core {

struct BrickCount {
  BrickCoord brick;
  std::int64_t particles = 0;
};

class BrickDirectory {
 public:
  static constexpr std::int32_t no_owner = -1;

  virtual ~BrickDirectory() = default;

  /// Determines the owner of each brick from the number of particles that every rank found in it (several
  /// ranks may count in one brick), and sets up `grid` with the owned and ghost bricks. May be called again.
  /// A decomposition that does not fit the ranks throws InputErrors on every rank. Collective.
  virtual void partition(BrickGrid& grid, std::span<const BrickCount> counts,
                         const DecompositionInput& how) = 0;
  /// Activates bricks that particles of some rank enter: those that do not exist are assigned to a rank that
  /// does not depend on how many ranks request them. All ranks call it with their own list, possibly empty;
  /// afterwards the owned and ghost bricks of `grid` are up to date. Collective.
  virtual void activate(BrickGrid& grid, std::span<const BrickCoord> wanted) = 0;
  /// Removes these empty bricks of ours, and those that other ranks remove. Throws std::logic_error, on this
  /// rank alone, for a brick that holds particles or is not ours. Collective.
  virtual void deactivate(BrickGrid& grid, std::span<const BrickCoord> empty) = 0;

  /// The rank that owns a brick of ours or one next to it; no rank if it does not exist.
  virtual std::int32_t owner_nearby(BrickCoord b) const = 0;
  /// The owners of any bricks. Collective.
  virtual std::vector<std::int32_t> owners(std::span<const BrickCoord> bricks) const = 0;
};

/// Throws InputErrors unless the product of the scene's decomposition equals this number of ranks.
void check_decomposition(const DecompositionInput& how, int ranks);

}  // namespace mpm::core
