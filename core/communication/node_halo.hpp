// Exchange of contributions to the nodes that bricks of several ranks share.
#pragma once

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
};

}  // namespace mpm::core
