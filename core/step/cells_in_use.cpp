#include "core/step/cells_in_use.hpp"

#include <algorithm>
#include <array>

#include "core/shape/cells_of_particles.hpp"
#include "core/shape/list.hpp"
#include "core/step/prefetch.hpp"
#include "core/threads.hpp"

namespace mpm::core {

namespace {

constexpr NodeFields field = mapped::cells_in_use;

constexpr std::uint64_t bit_of(int i, int j, int k) {
  return std::uint64_t{1} << (i + brick_cells * (j + brick_cells * k));
}

/// f(bit, node of the brick's node block) for each cell.
template <class F>
void for_each_cell_of(const NodeBlockShape& shape, F f) {
  for (int k = 0; k < brick_cells; ++k) {
    for (int j = 0; j < brick_cells; ++j) {
      for (int i = 0; i < brick_cells; ++i) f(bit_of(i, j, k), shape.index(i, j, k));
    }
  }
}

/// Adds the mirror images beyond the constrained faces of the grid. One axis after the other, so that those
/// beyond edges and corners follow.
void add_mirror_images(const GridGeometry& geometry, BrickCoord brick, CellsAround& around) {
  const int first[3] = {brick_cells * brick.x, brick_cells * brick.y, brick_cells * brick.z};
  const auto copy_layer = [&](int axis, int from, int to) {
    int c[3];
    int &u = c[(axis + 1) % 3], &v = c[(axis + 2) % 3];
    for (u = -1; u <= brick_cells; ++u) {
      for (v = -1; v <= brick_cells; ++v) {
        c[axis] = from;
        if (!around.has(c[0], c[1], c[2])) continue;
        c[axis] = to;
        around.add(c[0], c[1], c[2]);
      }
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const std::int64_t last = geometry.cells[a] - first[axis];  // the upper wall's node
    if (first[axis] == 0 && is_constrained(geometry.boundary[2 * a])) copy_layer(axis, 0, -1);
    if (last <= brick_cells && is_constrained(geometry.boundary[2 * a + 1]))
      copy_layer(axis, static_cast<int>(last) - 1, static_cast<int>(last));
  }
}

}  // namespace

std::uint64_t find_cells(const Model& model, Slot s, std::int32_t component, std::span<const int> without) {
  const BrickGrid& grid = *model.grid;
  const Brick& brick = grid.brick(s);
  const BrickFrame frame(grid.geometry(), brick.coord);
  constexpr int columns = static_cast<int>(Column::position_x) + 3;
  CellsOfParticles found;
  for (std::size_t c = 0; c < brick.tiles.size(); ++c) {
    const ParticleTile& tile = brick.tiles[c];
    if (component != all_components && tile.component != component) continue;
    if (std::ranges::find(without, tile.body) != without.end()) continue;
    const BlockPool& pool = *model.bodies[static_cast<std::size_t>(tile.body)].pool;
    const BlockPrefetch prefetch(model, s, c);
    for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
      prefetch.request<Linear>(b, pool.layout(), columns);
      found.add(frame, pool.layout(), pool.block(tile.blocks[b]), (1u << tile.used_lanes(b)) - 1);
    }
  }
  return found.cells();
}

void CellsInUse::find_own(Slot s) {
  BrickGrid& grid = *model_.grid;
  prefetch_coming_bricks(grid, s);
  if (!grid.has_fields_by_component()) {
    std::optional<Cells> known;
    if (without_.empty()) known = grid.own_cells(s);
    cells(s, 0) = known ? *known : find_cells(model_, s, all_components, without_);
    return;
  }
  cells(s, 0) = 0;
  for (int f = 0; const std::int32_t component : grid.components(s))
    cells(s, f++) = find_cells(model_, s, component, without_);
}

void CellsInUse::write_to_nodes(Slot s) {
  BrickGrid& grid = *model_.grid;
  constexpr int width = record_doubles(field.array);
  for (int f = 0; f < grid.velocity_fields(s); ++f) {
    double* at = grid.contributions(field.array, s, f) + field.first;
    for (int n = 0; n < grid.shape().nodes(); ++n) at[width * n] = 0;
    const Cells own = cells(s, f);
    for_each_cell_of(grid.shape(), [&](Cells bit, int node) { at[width * node] = (own & bit) != 0 ? 1 : 0; });
  }
}

void CellsInUse::read_from_nodes(Slot s) {
  const BrickGrid& grid = *model_.grid;
  constexpr int width = record_doubles(field.array);
  for (int f = 0; f < grid.velocity_fields(s); ++f) {
    const double* at = grid.contributions(field.array, s, f) + field.first;
    Cells found = 0;
    for_each_cell_of(grid.shape(), [&](Cells bit, int node) { found |= at[width * node] != 0 ? bit : 0; });
    cells(s, f) = found;
  }
}

void CellsInUse::find() {
  BrickGrid& grid = *model_.grid;
  cells_.resize(grid.field_count());
  for_each_by_threads(0, grid.boundary(), 4, [&](int s) {
    find_own(s);
    write_to_nodes(s);
  });
  halo_.begin(grid, field);
  for_each_by_threads(grid.boundary(), grid.owned(), 4, [&](int s) { find_own(s); });
}

void CellsInUse::finish_exchange() {
  BrickGrid& grid = *model_.grid;
  halo_.end(grid);
  for (int g = 0; g < grid.ghosts(); ++g) read_from_nodes(grid.owned() + g);
  grid.reset_cells_around();
  for_each_by_threads(0, grid.owned(), 16, [&](int slot) {
    const auto s = static_cast<Slot>(slot);
    combine(s, all_components, grid.cells_around(s));
    if (!grid.has_fields_by_component()) return;
    for (int f = 0; const std::int32_t component : grid.components(s))
      combine(s, component, grid.cells_around(s, f++));
  });
}

/// Of one component, or of all.
CellsInUse::Cells CellsInUse::cells_of(Slot s, std::int32_t component) const {
  const BrickGrid& grid = *model_.grid;
  const auto of_field = [&](int f) { return cells_[grid.field_index(s, f)]; };
  if (component != all_components) {
    const int f = grid.field_of(s, component);
    return f < 0 ? 0 : of_field(f);
  }
  Cells all = 0;
  for (int f = 0; f < grid.velocity_fields(s); ++f) all |= of_field(f);
  return all;
}

void CellsInUse::combine(Slot s, std::int32_t component, CellsAround& around) const {
  const BrickGrid& grid = *model_.grid;
  const Brick& brick = grid.brick(s);
  const auto is_full = [&](Slot from) { return from != no_slot && cells_of(from, component) == ~Cells{0}; };
  if (std::ranges::all_of(brick.neighbour, is_full)) return around.add_all();
  for (int n = 0; n < neighbourhood; ++n) {
    const Slot from = brick.neighbour[static_cast<std::size_t>(n)];
    if (from == no_slot) continue;
    const Cells there = cells_of(from, component);
    if (there == 0) continue;
    const BrickCoord d = neighbour_offset(n);
    const auto lowest = [](int offset) { return offset < 0 ? brick_cells - 1 : 0; };
    const auto highest = [](int offset) { return offset > 0 ? 0 : brick_cells - 1; };
    for (int k = lowest(d.z); k <= highest(d.z); ++k) {
      for (int j = lowest(d.y); j <= highest(d.y); ++j) {
        const auto row = static_cast<unsigned>(there >> brick_cells * (j + brick_cells * k)) & 15u;
        const unsigned within = d.x < 0 ? row >> 3 : d.x > 0 ? (row & 1u) << 5 : row << 1;
        around.add_row(j + brick_cells * d.y, k + brick_cells * d.z, within);
      }
    }
  }
  add_mirror_images(grid.geometry(), brick.coord, around);
}

std::unique_ptr<CellsInUse> make_cells_in_use(Model& model, NodeHalo& halo, std::vector<int> without) {
  using Made = std::unique_ptr<CellsInUse>;
  return with_shape(model.scene->grid.shape, [&]<class S>(std::type_identity<S>) -> Made {
    if constexpr (needs_cells<S>) return std::make_unique<CellsInUse>(model, halo, std::move(without));
    return nullptr;
  });
}

}  // namespace mpm::core
