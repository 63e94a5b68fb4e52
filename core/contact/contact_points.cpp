#include "core/contact/contact_points.hpp"

#include <algorithm>
#include <cmath>

namespace mpm::core {

std::vector<std::vector<std::int32_t>> components_by_slot(const BrickGrid& grid, NodeHalo& halo) {
  std::vector<std::vector<std::int32_t>> of_slot(static_cast<std::size_t>(grid.owned() + grid.ghosts()));
  for (Slot s = 0; s < grid.owned(); ++s) {
    std::vector<std::int32_t>& components = of_slot[static_cast<std::size_t>(s)];
    for (const ParticleTile& tile : grid.brick(s).tiles) {
      const auto at = std::ranges::lower_bound(components, tile.component);
      if (at == components.end() || *at != tile.component) components.insert(at, tile.component);
    }
  }
  halo.exchange_components(grid, of_slot);
  return of_slot;
}

void ContactPoints::list(const Model& model, Slot s) {
  std::vector<double>& points = points_[static_cast<std::size_t>(s)];
  for (const ParticleTile& tile : model.grid->brick(s).tiles) {
    const BlockPool& pool = *model.bodies[static_cast<std::size_t>(tile.body)].pool;
    for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
      const double* x = pool.block(tile.blocks[b]) + pool.layout().offset(Column::position_x);
      for (int l = 0; l < tile.used_lanes(b); ++l)
        points.insert(points.end(), {x[l], x[block_lanes + l], x[2 * block_lanes + l],
                                     static_cast<double>(tile.component)});
    }
  }
}

void PointsByCell::take(const BrickGrid& grid, const ContactPoints& points, Slot s, const Range& nodes) {
  constexpr int width = ContactPoints::width;
  const GridGeometry& g = grid.geometry();
  const Brick& brick = grid.brick(s);
  for (int a = 0; a < 3; ++a) {
    lowest_[a] = nodes.lowest[a] - layers;
    cells_[a] = nodes.highest[a] + layers - lowest_[a];
  }
  const std::int64_t first[3] = {std::int64_t{brick_cells} * brick.coord.x,
                                 std::int64_t{brick_cells} * brick.coord.y,
                                 std::int64_t{brick_cells} * brick.coord.z};
  const auto cell_of = [&](const double* x) {
    int cell[3];
    for (int a = 0; a < 3; ++a) {
      const double at = std::floor(GridGeometry::scaled(x[a], g.origin[a], g.inverse_cell[a])) -
                        static_cast<double>(first[a]) - lowest_[a];
      if (!(at >= 0 && at < cells_[a])) return -1;
      cell[a] = static_cast<int>(at);
    }
    return cell[0] + cells_[0] * (cell[1] + cells_[1] * cell[2]);
  };
  // A brick's particles are in its own cells or, taken by node, up to half a cell below.
  const auto reaches = [&](int n) {
    const BrickCoord offset = neighbour_offset(n);
    const std::int32_t along[3] = {offset.x, offset.y, offset.z};
    for (int a = 0; a < 3; ++a) {
      const int cell = brick_cells * along[a] - lowest_[a];
      if (cell + brick_cells < 0 || cell - 1 >= cells_[a]) return false;
    }
    return true;
  };
  const auto for_each_point = [&](auto f) {
    for (int n = 0; n < neighbourhood; ++n) {
      const Slot neighbour = brick.neighbour[static_cast<std::size_t>(n)];
      if (neighbour == no_slot || !reaches(n)) continue;
      const std::span<const double> list = points.of(neighbour);
      for (std::size_t i = 0; i < list.size(); i += width) f(list.data() + i);
    }
  };
  begin_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
  cell_of_.clear();
  for_each_point([&](const double* point) {
    const int cell = cell_of(point);
    cell_of_.push_back(cell);
    if (cell >= 0) ++begin_[static_cast<std::size_t>(cell) + 1];
  });
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  sorted_.resize(width * begin_.back());
  // Each cell's first place moves on to its last; shifted back below.
  auto cell = cell_of_.begin();
  for_each_point([&](const double* point) {
    if (*cell >= 0)
      std::copy_n(point, width, sorted_.data() + width * begin_[static_cast<std::size_t>(*cell)]++);
    ++cell;
  });
  std::move_backward(begin_.begin(), begin_.end() - 1, begin_.end());
  begin_.front() = 0;
}

void PointsByCell::around(const BrickGrid& grid, Slot s, const int (&node)[3], std::int32_t first,
                          std::int32_t second, LabelledPoints& points) const {
  const GridGeometry& g = grid.geometry();
  const BrickCoord coord = grid.brick(s).coord;
  const Vec3<double> place = g.node_place(coord, node[0], node[1], node[2]);
  const std::int32_t brick[3] = {coord.x, coord.y, coord.z};
  double scale[3];
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const std::int64_t number = std::int64_t{brick_cells} * brick[a] + node[a];
    const bool on_face = (number == 0 && is_constrained(g.boundary[2 * axis])) ||
                         (number == g.cells[axis] && is_constrained(g.boundary[2 * axis + 1]));
    scale[a] = on_face ? 0 : g.inverse_cell[a];
  }
  points.clear();
  const int lowest[3] = {node[0] - layers, node[1] - layers, node[2] - layers},
            highest[3] = {node[0] + layers - 1, node[1] + layers - 1, node[2] + layers - 1};
  for_each(lowest, highest, [&](const Vec3<double>& x, std::int32_t component) {
    if (component != first && component != second) return;
    const Vec3<double> from_node = x - place;
    points.add({scale[0] * from_node.x, scale[1] * from_node.y, scale[2] * from_node.z},
               component == first ? -1.0 : 1.0);
  });
}

}  // namespace mpm::core
