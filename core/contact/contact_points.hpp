// The particles near the nodes where components meet, for normals by regression (separating_plane.hpp): a
// list of the bricks' particles that neighbouring ranks exchange once per step, and those of a neighbourhood
// sorted by cell.
//
// A node's particles are those in the 64 cells around it, two to each side: with one cell to each side, the
// last particles of a body would be farther out than any of the other, and the normal would tilt. They come
// cell by cell, and in each in the order of the bricks and their particles: the same for every copy of a
// node.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/communication/node_halo.hpp"
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

  /// Lists the particles of the owned slots for which `wanted`, and gets those of the ghosts. Collective,
  /// with the neighbouring ranks.
  template <class F>
  void collect(const Model& model, NodeHalo& halo, F wanted) {
    const BrickGrid& grid = *model.grid;
    points_.resize(static_cast<std::size_t>(grid.owned() + grid.ghosts()));
    for_each_by_threads(0, grid.owned(), 4, [&](int s) {
      points_[static_cast<std::size_t>(s)].clear();
      if (wanted(static_cast<Slot>(s))) list(model, static_cast<Slot>(s));
    });
    halo.exchange_points(grid, points_);
  }
  std::span<const double> of(Slot s) const { return points_[static_cast<std::size_t>(s)]; }

 private:
  void list(const Model& model, Slot s);
  std::vector<std::vector<double>> points_;
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
  void around(const BrickGrid& grid, Slot s, const int (&node)[3], std::int32_t first, std::int32_t second,
              LabelledPoints& points) const;
  /// f(x, component) for the particles in the cells from `lowest` to `highest`, both included, counted as
  /// nodes are: cell (i, j, k) is above node (i, j, k).
  template <class F>
  void for_each(const int (&lowest)[3], const int (&highest)[3], F f) const {
    constexpr int width = ContactPoints::width;
    for (int k = lowest[2] - lowest_[2]; k <= highest[2] - lowest_[2]; ++k) {
      for (int j = lowest[1] - lowest_[1]; j <= highest[1] - lowest_[1]; ++j) {
        const int row = cells_[0] * (j + cells_[1] * k) - lowest_[0];
        const auto first = begin_[static_cast<std::size_t>(row + lowest[0])],
                   last = begin_[static_cast<std::size_t>(row + highest[0] + 1)];
        for (std::size_t p = first; p < last; ++p) {
          const double* at = sorted_.data() + width * p;
          f(Vec3<double>{at[0], at[1], at[2]}, static_cast<std::int32_t>(at[3]));
        }
      }
    }
  }

  static constexpr int layers = 2;  ///< of cells on each side of a node

 private:
  int lowest_[3] = {};  ///< cell
  int cells_[3] = {};
  std::vector<std::uint32_t> begin_;  ///< by cell, in sorted_
  std::vector<double> sorted_;
  std::vector<std::int32_t> cell_of_;
};

}  // namespace mpm::core
