// Contributions to the nodes that bricks of several ranks share.
#pragma once

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

class NodeHalo {
 public:
  virtual ~NodeHalo() = default;

  /// Send our boundary bricks' contributions to shared nodes, these fields of them, and receive the ghosts'.
  /// Between begin and end the boundary bricks' contributions stay untouched. Collective, with the ranks next
  /// to this one.
  virtual void begin(BrickGrid& grid, NodeFields fields) = 0;
  virtual void end(BrickGrid& grid) = 0;
};

}  // namespace mpm::core
