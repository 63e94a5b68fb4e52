// Exchange of contributions to the nodes that bricks of several ranks share.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

class NodeHalo {
 public:
  virtual ~NodeHalo() = default;

  /// Sends these fields of our boundary bricks' contributions to shared nodes, and receives the ghosts'.
  /// Between begin and end the boundary bricks' contributions must not change. Collective, with the
  /// neighbouring ranks.
  virtual void begin(BrickGrid& grid, NodeFields fields) = 0;
  virtual void end(BrickGrid& grid) = 0;

  /// of_slot: the components of the owned slots' particles; sets those of the ghosts. Collective, with the
  /// neighbouring ranks.
  virtual void exchange_components(const BrickGrid& grid,
                                   std::vector<std::vector<std::int32_t>>& of_slot) = 0;
  /// of_slot: any numbers of the owned slots; sets those of the ghosts. Collective, with the neighbouring
  /// ranks.
  virtual void exchange_points(const BrickGrid& grid, std::vector<std::vector<double>>& of_slot) = 0;
};

}  // namespace mpm::core
