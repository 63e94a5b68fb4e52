#include "core/contact/contact_points.hpp"

#include <algorithm>
#include <bit>
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

void ContactPoints::list(const Model& model, Slot s, const ParticleTile& tile, const AxisBox& box) {
  std::vector<double>& points = points_[static_cast<std::size_t>(s)];
  const BlockPool& pool = *model.bodies[static_cast<std::size_t>(tile.body)].pool;
  for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
    const double* block = pool.block(tile.blocks[b]);
    const double* x = block + pool.layout().offset(Column::position_x);
    unsigned left = box.lanes(pool.layout(), block, tile.used_lanes(b));
    const std::size_t before = points.size();
    points.resize(before + static_cast<std::size_t>(width * std::popcount(left)));
    for (double* to = points.data() + before; left != 0; left &= left - 1, to += width) {
      const double* at = x + std::countr_zero(left);
      for (int a = 0; a < 3; ++a) to[a] = at[a * block_lanes];
      to[3] = static_cast<double>(tile.component);
    }
  }
}

/// The points of all slots by cell.
void ContactPoints::sort(const BrickGrid& grid) {
  for_each_by_threads(0, static_cast<int>(points_.size()), 4, [&](int s) {
    const auto at = static_cast<std::size_t>(s);
    if (points_[at].empty()) return;
    sort(grid.geometry(), s < grid.owned() ? grid.brick(s).coord : grid.ghost(s - grid.owned()), points_[at],
         by_cell_[at]);
  });
}

/// Stable: points of a cell stay in their order.
void ContactPoints::sort(const GridGeometry& g, const BrickCoord& brick, std::span<const double> points,
                         ByCell& to) {
  const double first[3] = {double{brick_cells} * brick.x, double{brick_cells} * brick.y,
                           double{brick_cells} * brick.z};
  const auto cell_of = [&](const double* x) {
    int cell[3];
    for (int a = 0; a < 3; ++a) {
      const double at = std::floor(GridGeometry::scaled(x[a], g.origin[a], g.inverse_cell[a])) - first[a];
      cell[a] = static_cast<int>(std::clamp(at, double{lowest_cell}, double{brick_cells - 1}));
    }
    return static_cast<std::uint32_t>(number(cell[0], cell[1], cell[2]));
  };
  const std::size_t count = points.size() / width;
  std::vector<std::uint32_t> cell(count);
  to.begin.fill(0);
  for (std::size_t p = 0; p < count; ++p) {
    cell[p] = cell_of(points.data() + width * p);
    ++to.begin[cell[p] + 1];
  }
  std::partial_sum(to.begin.begin(), to.begin.end(), to.begin.begin());
  std::array<std::uint32_t, cells + 1> next = to.begin;
  for (std::vector<double>& row : to.rows) row.resize(count);
  for (std::size_t p = 0; p < count; ++p) {
    const std::uint32_t at = next[cell[p]]++;
    for (std::size_t a = 0; a < width; ++a) to.rows[a][at] = points[width * p + a];
  }
}

void PointsByCell::take(const BrickGrid& grid, const ContactPoints& points, Slot s, const Range& nodes) {
  const Brick& brick = grid.brick(s);
  for (int a = 0; a < 3; ++a) {
    lowest_[a] = nodes.lowest[a] - layers;
    cells_[a] = nodes.highest[a] + layers - lowest_[a];
  }
  // f(cell here, brick, its first cell, end of its cells) for rows along x, brick by brick.
  const auto for_each_brick_row = [&](auto f) {
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
      if (low[0] >= high[0]) continue;
      for (int k = low[2]; k < high[2]; ++k)
        for (int j = low[1]; j < high[1]; ++j)
          f(static_cast<std::size_t>(low[0] + shift[0] +
                                     cells_[0] * (j + shift[1] + cells_[1] * (k + shift[2]))),
            neighbour, ContactPoints::number(low[0], j, k), ContactPoints::number(high[0], j, k));
    }
  };
  begin_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
  for_each_brick_row([&](std::size_t cell, Slot there, int first, int last) {
    for (int c = first; c < last; ++c, ++cell) begin_[cell + 1] += points.count(there, c);
  });
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  for (std::vector<double>& row : rows_) row.resize(begin_.back() + LabelledPoints::lanes);
  // Each cell's first place moves on to its last; shifted back below. Cells are copied together as far as
  // their points follow each other here too.
  for_each_brick_row([&](std::size_t cell, Slot there, int first, int last) {
    for (int c = first; c < last;) {
      const int from = c;
      const std::uint32_t to = begin_[cell];
      std::uint32_t end = to;
      for (; c < last && begin_[cell] == end; ++c, ++cell) end = begin_[cell] += points.count(there, c);
      for (int a = 0; a < ContactPoints::width; ++a)
        std::copy_n(points.row(there, a, from), end - to, rows_[a].data() + to);
    }
  });
  std::move_backward(begin_.begin(), begin_.end() - 1, begin_.end());
  begin_.front() = 0;
}

/// With the mirror images in constrained faces near the node: those beyond one on which it is would be in the
/// plane that the scale of zero makes.
void PointsByCell::around(const BrickGrid& grid, Slot s, const std::array<int, 3>& node, std::int32_t first,
                          std::int32_t second, LabelledPoints& points) const {
  const GridGeometry& g = grid.geometry();
  const BrickCoord coord = grid.brick(s).coord;
  const Vec3<double> place = g.node_place(coord, node);
  const std::int32_t brick[3] = {coord.x, coord.y, coord.z};
  double scale[3];
  // Along an axis the cells around the node, and those whose images in a face are: at shift + sign x.
  struct Image {
    int low, high;
    double sign, shift;
  };
  std::array<Image, 3> images[3];
  std::size_t count[3];
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const int here = node[axis];
    scale[a] = g.inverse_cell[a];
    images[a][0] = {here - layers, here + layers - 1, 1, 0};
    count[a] = 1;
    const std::int64_t below = std::int64_t{brick_cells} * brick[a] + here, above = g.cells[axis] - below;
    const bool lower = is_constrained(g.boundary[2 * axis]), upper = is_constrained(g.boundary[2 * axis + 1]);
    if ((lower && below == 0) || (upper && above == 0)) {
      scale[a] = 0;
      continue;
    }
    if (lower && below > 0 && below < layers) {
      const int face = here - static_cast<int>(below);
      images[a][count[a]++] = {face, face + layers - static_cast<int>(below) - 1, -1, 2 * g.origin[a]};
    }
    if (upper && above > 0 && above < layers) {
      const int face = here + static_cast<int>(above);
      const double plane = g.origin[a] + static_cast<double>(g.cells[axis]) * g.cell[a];
      images[a][count[a]++] = {face - (layers - static_cast<int>(above)), face - 1, -1, 2 * plane};
    }
  }
  points.clear();
  using Points = LabelledPoints::Row;
  const Points zero(0.0), one(1.0), of_first(static_cast<double>(first)),
      of_second(static_cast<double>(second)), lane(Points::vector{0, 1, 2, 3, 4, 5, 6, 7});
  // The particles, then their images in each face, in each edge and in the corner near the node.
  for (std::size_t image = 0; image < count[0] * count[1] * count[2]; ++image) {
    const Image& x = images[0][image % count[0]];
    const Image& y = images[1][image / count[0] % count[1]];
    const Image& z = images[2][image / count[0] / count[1]];
    const double sign[3] = {x.sign, y.sign, z.sign}, shift[3] = {x.shift, y.shift, z.shift};
    const int low[3] = {x.low, y.low, z.low}, high[3] = {x.high, y.high, z.high};
    for_each_row(low, high, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; p += LabelledPoints::lanes) {
        const auto along = [&](int a) {
          const Points at = load<Points>(rows_[a].data() + p);
          return scale[a] * (sign[a] * at + shift[a] - place[a]);
        };
        const Points component = load<Points>(rows_[3].data() + p);
        const auto exists = lane < Points(static_cast<double>(end - p));
        const Points labels = select(exists & (component == of_first), -one,
                                     select(exists & (component == of_second), one, zero));
        if (any(labels != zero)) points.add(along(0), along(1), along(2), labels);
      }
    });
  }
}

}  // namespace mpm::core
