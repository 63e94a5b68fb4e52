// The coordinates of one brick, in which its particles are located.
#pragma once

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

struct BrickFrame {
  Vec3<double> origin, inverse_cell;
  Vec3<double> first_site;  ///< where the brick's first site begins, in cells from the grid's origin
  Vec3<double> last_site;   ///< highest site that a particle can be in, relative to the brick's first
  /// Range of the brick inside the grid, in cells from first_site.
  Vec3<double> lowest, beyond;
  const CellsAround* cells = nullptr;  ///< in use, for shape functions that need them

  /// Of an owned brick, with the cells in use of all its fields or of one.
  BrickFrame(const BrickGrid& grid, Slot s) : BrickFrame(grid.geometry(), grid.brick(s).coord) {
    cells = grid.cells_in_use(s);
  }
  BrickFrame(const BrickGrid& grid, Slot s, int field) : BrickFrame(grid.geometry(), grid.brick(s).coord) {
    cells = grid.cells_in_use(s, field);
  }
  BrickFrame(const GridGeometry& g, BrickCoord b) : origin(g.origin), inverse_cell(g.inverse_cell) {
    const std::int32_t coord[3] = {b.x, b.y, b.z};
    for (int a = 0; a < 3; ++a) {
      first_site[a] = g.first_site() + double(std::int64_t{brick_cells} * coord[a]);
      last_site[a] = g.last_site(b, a);
      lowest[a] = std::fmax(-first_site[a], 0);
      beyond[a] = std::fmin(last_site[a] + 1, double(g.cells[static_cast<std::size_t>(a)]) - first_site[a]);
    }
  }
};

}  // namespace mpm::core
