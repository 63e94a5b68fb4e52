#include "core/contact/contact_points.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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
      const int used = tile.used_lanes(b);
      points.resize(points.size() + static_cast<std::size_t>(width * used));
      double* to = points.data() + points.size() - width * used;
      for (int l = 0; l < used; ++l, to += width) {
        for (int a = 0; a < 3; ++a) to[a] = x[a * block_lanes + l];
        to[3] = static_cast<double>(tile.component);
      }
    }
  }
}

/// The points of all slots by cell. Where a ghost is, its neighbours tell.
void ContactPoints::sort(const BrickGrid& grid) {
  std::vector<BrickCoord> coord(points_.size());
  for (Slot s = 0; s < grid.owned(); ++s) {
    const Brick& brick = grid.brick(s);
    for (int n = 0; n < neighbourhood; ++n) {
      const Slot neighbour = brick.neighbour[static_cast<std::size_t>(n)];
      if (neighbour == no_slot) continue;
      coord[static_cast<std::size_t>(neighbour)] = brick.coord + neighbour_offset(n);
    }
  }
  for_each_by_threads(std::size_t{0}, points_.size(), 4, [&](std::size_t s) {
    if (!points_[s].empty()) sort(grid.geometry(), coord[s], points_[s], begin_[s]);
  });
}

/// Stable: points of a cell stay in their order.
void ContactPoints::sort(const GridGeometry& g, const BrickCoord& brick, std::vector<double>& points,
                         std::vector<std::uint32_t>& begin) const {
  const double first[3] = {double{brick_cells} * brick.x, double{brick_cells} * brick.y,
                           double{brick_cells} * brick.z};
  const auto cell_of = [&](const double* x) {
    int cell[3];
    for (int a = 0; a < 3; ++a) {
      const double at = std::floor(GridGeometry::scaled(x[a], g.origin[a], g.inverse_cell[a])) - first[a];
      cell[a] = static_cast<int>(std::clamp(at, double{lowest_cell}, double{brick_cells - 1}));
    }
    return static_cast<std::size_t>(number(cell[0], cell[1], cell[2]));
  };
  const std::size_t count = points.size() / width;
  std::vector<std::size_t> cells(count);
  begin.assign(cells_per_axis * cells_per_axis * cells_per_axis + 1, 0);
  for (std::size_t p = 0; p < count; ++p) {
    cells[p] = cell_of(points.data() + width * p);
    ++begin[cells[p] + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  std::vector<double> sorted(points.size());
  for (std::size_t p = 0; p < count; ++p)
    std::copy_n(points.data() + width * p, width, sorted.data() + width * next[cells[p]]++);
  points.swap(sorted);
}

void PointsByCell::take(const BrickGrid& grid, const ContactPoints& points, Slot s, const Range& nodes) {
  constexpr int width = ContactPoints::width;
  const Brick& brick = grid.brick(s);
  for (int a = 0; a < 3; ++a) {
    lowest_[a] = nodes.lowest[a] - layers;
    cells_[a] = nodes.highest[a] + layers - lowest_[a];
  }
  // f(cell here, its points of one brick), brick by brick.
  const auto for_each_run = [&](auto f) {
    for (int n = 0; n < neighbourhood; ++n) {
      const Slot neighbour = brick.neighbour[static_cast<std::size_t>(n)];
      if (neighbour == no_slot || !points.any(neighbour)) continue;
      const BrickCoord offset = neighbour_offset(n);
      const std::int32_t along[3] = {offset.x, offset.y, offset.z};
      int shift[3], low[3], high[3];  // from the brick's cells to those here; the brick's cells in question
      for (int a = 0; a < 3; ++a) {
        shift[a] = brick_cells * along[a] - lowest_[a];
        low[a] = std::max(ContactPoints::lowest_cell, -shift[a]);
        high[a] = std::min(brick_cells, cells_[a] - shift[a]);
      }
      for (int k = low[2]; k < high[2]; ++k)
        for (int j = low[1]; j < high[1]; ++j)
          for (int i = low[0]; i < high[0]; ++i)
            f(static_cast<std::size_t>(i + shift[0] +
                                       cells_[0] * (j + shift[1] + cells_[1] * (k + shift[2]))),
              points.of(neighbour, i, j, k));
    }
  };
  begin_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
  for_each_run([&](std::size_t cell, std::span<const double> run) {
    begin_[cell + 1] += static_cast<std::uint32_t>(run.size() / width);
  });
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  for (std::vector<double>& row : rows_) row.resize(begin_.back() + LabelledPoints::lanes);
  // Each cell's first place moves on to its last; shifted back below.
  for_each_run([&](std::size_t cell, std::span<const double> run) {
    for (std::size_t p = 0; p < run.size(); p += width, ++begin_[cell])
      for (std::size_t a = 0; a < width; ++a) rows_[a][begin_[cell]] = run[p + a];
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
  using Points = LabelledPoints::Row;
  const int lowest[3] = {node[0] - layers, node[1] - layers, node[2] - layers},
            highest[3] = {node[0] + layers - 1, node[1] + layers - 1, node[2] + layers - 1};
  const Points zero(0.0), one(1.0), of_first(static_cast<double>(first)),
      of_second(static_cast<double>(second)), lane(Points::vector{0, 1, 2, 3, 4, 5, 6, 7});
  for_each_row(lowest, highest, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; p += LabelledPoints::lanes) {
      const auto at = [&](std::size_t a) { return load<Points>(rows_[a].data() + p); };
      const Points component = at(3);
      const auto exists = lane < Points(static_cast<double>(end - p));
      const Points labels = select(exists & (component == of_first), -one,
                                   select(exists & (component == of_second), one, zero));
      if (any(labels != zero))
        points.add(scale[0] * (at(0) - place.x), scale[1] * (at(1) - place.y), scale[2] * (at(2) - place.z),
                   labels);
    }
  });
}

}  // namespace mpm::core
