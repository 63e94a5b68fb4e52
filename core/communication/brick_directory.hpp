// Which bricks exist and which rank owns each. How a rank knows is the directory's own matter: nothing
// outside asks for more than is named here.
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
  static constexpr std::int32_t nobody = -1;

  virtual ~BrickDirectory() = default;

  /// Decide who owns which brick, from the number of particles that every rank found in each (several ranks
  /// may count in one brick), and set up `grid` with the owned and ghost bricks. May be called again. A
  /// decomposition that does not fit the ranks throws InputErrors on every rank. Collective.
  virtual void partition(BrickGrid& grid, std::span<const BrickCount> counts,
                         const DecompositionInput& how) = 0;
  /// Bricks that some rank's particles want to enter: those that do not exist are given to a rank, the same
  /// one whatever the number of askers. All ranks call it with their own list, possibly empty; afterwards the
  /// owned and ghost bricks of `grid` are up to date. Collective.
  virtual void activate(BrickGrid& grid, std::span<const BrickCoord> wanted) = 0;
  /// Forget these empty bricks of ours, and whatever other ranks forget. Throws std::logic_error, on this
  /// rank alone, for a brick that holds particles or is not ours. Collective.
  virtual void deactivate(BrickGrid& grid, std::span<const BrickCoord> empty) = 0;

  /// The rank that owns a brick of ours or one next to it; nobody if it does not exist.
  virtual std::int32_t owner_nearby(BrickCoord b) const = 0;
  /// The owners of any bricks. Collective.
  virtual std::vector<std::int32_t> owners(std::span<const BrickCoord> bricks) const = 0;
};

/// Throws InputErrors unless the dimensions that the scene asks for make up this number of ranks.
void check_decomposition(const DecompositionInput& how, int ranks);

}  // namespace mpm::core
