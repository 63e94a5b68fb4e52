// The particles near the nodes where components meet, for normals by regression (separating_plane.hpp): a
// list of each brick's particles, cell by cell, which neighbouring ranks exchange once per step, and those of
// a neighbourhood by cell.
//
// A node's particles are those in the 64 cells around it, two to each side: with one cell to each side, the
// last particles of a body would be farther out than any of the other, and the normal would tilt. They come
// cell by cell, and in each in the order of the bricks and their particles: the same for every copy of a
// node.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/communication/node_halo.hpp"
#include "core/contact/axis_box.hpp"
#include "core/contact/separating_plane.hpp"
#include "core/model.hpp"
#include "core/threads.hpp"

namespace mpm::core {

/// The components of the particles in each owned and ghost slot, ascending. Collective, with the neighbouring
/// ranks.
std::vector<std::vector<std::int32_t>> components_by_slot(const BrickGrid& grid, NodeHalo& halo);

class ContactPoints {
 public:
  /// x, y, z and the component of each particle, by slot.
  static constexpr int width = 4;

  /// Lists the particles of the owned slots for which `wanted`, those in `box_of(slot, component)`, and gets
  /// those of the ghosts. Collective, with the neighbouring ranks.
  template <class F, class G>
  void collect(const Model& model, NodeHalo& halo, F wanted, G box_of) {
    const BrickGrid& grid = *model.grid;
    points_.resize(static_cast<std::size_t>(grid.owned() + grid.ghosts()));
    by_cell_.resize(points_.size());
    for_each_by_threads(0, grid.owned(), 4, [&](int s) {
      points_[static_cast<std::size_t>(s)].clear();
      if (!wanted(static_cast<Slot>(s))) return;
      for (const ParticleTile& tile : grid.brick(s).tiles)
        list(model, static_cast<Slot>(s), tile, box_of(static_cast<Slot>(s), tile.component));
    });
    halo.exchange_points(grid, points_);
    sort(grid);
  }
  bool any(Slot s) const { return !points_[static_cast<std::size_t>(s)].empty(); }
  /// A brick's particles are in its own cells or, taken by node, up to half a cell below.
  static constexpr int lowest_cell = -1, cells_per_axis = brick_cells + 1;
  /// Of a brick's cell; those along x follow each other.
  static int number(int i, int j, int k) {
    return i - lowest_cell + cells_per_axis * (j - lowest_cell + cells_per_axis * (k - lowest_cell));
  }
  std::uint32_t count(Slot s, int cell) const {
    const std::uint32_t* begin = by_cell_[static_cast<std::size_t>(s)].begin.data() + cell;
    return begin[1] - begin[0];
  }
  /// x, y, z or the component of the points from a cell on.
  const double* row(Slot s, int row, int cell) const {
    const ByCell& at = by_cell_[static_cast<std::size_t>(s)];
    return at.rows[row].data() + at.begin[static_cast<std::size_t>(cell)];
  }

 private:
  static constexpr int cells = cells_per_axis * cells_per_axis * cells_per_axis;
  struct ByCell {
    std::array<std::uint32_t, cells + 1> begin;  ///< numbers of the cells' first points
    std::vector<double> rows[width];
  };
  void list(const Model& model, Slot s, const ParticleTile& tile, const AxisBox& box);
  void sort(const BrickGrid& grid);
  static void sort(const GridGeometry& g, const BrickCoord& brick, std::span<const double> points,
                   ByCell& to);
  std::vector<std::vector<double>> points_;  ///< by slot, in the order of its particles
  std::vector<ByCell> by_cell_;              ///< by slot
};

/// Those around some of a brick's nodes.
class PointsByCell {
 public:
  /// Nodes (i, j, k) of NodeBlockShape in this range are to be asked for.
  struct Range {
    int lowest[3], highest[3];
  };
  void take(const BrickGrid& grid, const ContactPoints& points, Slot s, const Range& nodes);
  /// The particles of two components around a node. On a constrained face of the grid the normal is
  /// perpendicular to the face's, as if the particles had mirror images.
  void around(const BrickGrid& grid, Slot s, const std::array<int, 3>& node, std::int32_t first,
              std::int32_t second, LabelledPoints& points) const;
  /// f(x, component) for the particles in the cells from `lowest` to `highest`, both included, counted as
  /// nodes are: cell (i, j, k) is above node (i, j, k).
  template <class F>
  void for_each(const int (&lowest)[3], const int (&highest)[3], F f) const {
    for_each_row(lowest, highest, [&](std::size_t first, std::size_t last) {
      for (std::size_t p = first; p < last; ++p)
        f(Vec3<double>{rows_[0][p], rows_[1][p], rows_[2][p]}, static_cast<std::int32_t>(rows_[3][p]));
    });
  }

  static constexpr int layers = 2;  ///< of cells on each side of a node

 private:
  /// f(first, last): the points of the cells along x.
  template <class F>
  void for_each_row(const int (&lowest)[3], const int (&highest)[3], F f) const {
    for (int k = lowest[2] - lowest_[2]; k <= highest[2] - lowest_[2]; ++k) {
      for (int j = lowest[1] - lowest_[1]; j <= highest[1] - lowest_[1]; ++j) {
        const int row = cells_[0] * (j + cells_[1] * k) - lowest_[0];
        f(std::size_t{begin_[static_cast<std::size_t>(row + lowest[0])]},
          std::size_t{begin_[static_cast<std::size_t>(row + highest[0] + 1)]});
      }
    }
  }
  int lowest_[3] = {};  ///< cell
  int cells_[3] = {};
  std::vector<std::uint32_t> begin_;  ///< by cell, in rows_
  /// x, y, z, component; at the end room for a load of lanes.
  std::vector<double> rows_[ContactPoints::width];
};

}  // namespace mpm::core
