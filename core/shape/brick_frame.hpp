// The coordinates of one brick, in which its particles are located.
#pragma once

#include "core/grid/brick.hpp"

namespace mpm::core {

struct BrickFrame {
  Vec3<double> origin, inverse_cell;
  Vec3<double> first_cell;  ///< of the brick, in cells from the grid's origin
  Vec3<double> last_cell;   ///< highest cell that a particle can be in, relative to the brick's first
  int side = 0, halo = 0;

  BrickFrame(const GridGeometry& g, const NodeBlockShape& shape, BrickCoord b)
      : origin(g.origin),
        inverse_cell(g.inverse_cell),
        first_cell{double(brick_cells * b.x), double(brick_cells * b.y), double(brick_cells * b.z)},
        last_cell{double(g.last_cell(b, 0)), double(g.last_cell(b, 1)), double(g.last_cell(b, 2))},
        side(shape.side()),
        halo(shape.halo) {}
};

}  // namespace mpm::core
