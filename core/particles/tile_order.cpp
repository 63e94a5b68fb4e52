#include "core/particles/tile_order.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/contact/failed_component.hpp"
#include "core/shape/cells_of_particles.hpp"
#include "core/threads.hpp"

namespace mpm::core {

namespace {

ParticleTile& tile_of(Brick& brick, int body, std::int32_t component) {
  const auto at = std::lower_bound(brick.tiles.begin(), brick.tiles.end(), std::pair(body, component),
                                   [](const ParticleTile& c, const std::pair<int, std::int32_t>& wanted) {
                                     return std::pair(c.body, c.component) < wanted;
                                   });
  if (at != brick.tiles.end() && at->body == body && at->component == component) return *at;
  return *brick.tiles.insert(at, ParticleTile{body, component, 0, {}});
}

/// Particle order[p] becomes particle p.
void reorder(BlockPool& pool, ParticleTile& tile, const std::vector<std::uint32_t>& order) {
  thread_local std::vector<double> sorted;
  const ColumnLayout& layout = pool.layout();
  const auto block_doubles = static_cast<std::size_t>(layout.block_doubles());
  sorted.resize(tile.blocks.size() * block_doubles);
  for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
    const double* from[block_lanes];  // unused lanes copy the first lane
    const int used = tile.used_lanes(b);
    for (int l = 0; l < block_lanes; ++l) {
      const std::uint32_t p = order[block_lanes * b + static_cast<std::size_t>(l < used ? l : 0)];
      from[l] = pool.block(tile.blocks[p / block_lanes]) + p % block_lanes;
    }
    double* to = sorted.data() + b * block_doubles;
    for (int c = 0; c < layout.columns(); ++c) {
      for (int l = 0; l < block_lanes; ++l) to[block_lanes * c + l] = from[l][block_lanes * c];
    }
  }
  std::sort(tile.blocks.begin(), tile.blocks.end());  // blocks read in succession are adjacent in memory
  for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
    std::copy_n(sorted.data() + b * block_doubles, block_doubles, pool.block(tile.blocks[b]));
  }
}

}  // namespace

void append(Model& model, Brick& brick, int body, const double* columns) {
  append(*model.bodies[static_cast<std::size_t>(body)].pool,
         tile_of(brick, body, component_of(model, body, columns)), columns);
}

void sort_by_site(const BrickGrid& grid, BrickCoord brick, BlockPool& pool, ParticleTile& tile) {
  const BrickFrame frame(grid.geometry(), brick);
  thread_local std::vector<std::uint8_t> cell;
  cell.resize(block_lanes * tile.blocks.size());
  std::array<std::uint32_t, lattice_points.nodes() + 1> start{};  // lowest points are in the order of sites
  for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
    const int used = tile.used_lanes(b);
    const LinearPlace place(frame, pool.layout(), pool.block(tile.blocks[b]), used);
    for (int l = 0; l < block_lanes; ++l) {
      cell[block_lanes * b + static_cast<std::size_t>(l)] = static_cast<std::uint8_t>(place.node[l]);
      if (l < used) ++start[static_cast<std::size_t>(place.node[l]) + 1];
    }
  }
  cell.resize(tile.count);
  if (std::is_sorted(cell.begin(), cell.end())) return;
  std::partial_sum(start.begin(), start.end(), start.begin());
  thread_local std::vector<std::uint32_t> order;
  order.resize(tile.count);
  for (std::uint32_t p = 0; p < tile.count; ++p) order[start[cell[p]]++] = p;
  reorder(pool, tile, order);
}

void sort_by_identity(BlockPool& pool, ParticleTile& tile) {
  const int offset = pool.layout().offset(Column::identity);
  const auto identity = [&](std::uint32_t p) {
    return pool.block(tile.blocks[p / block_lanes])[offset + static_cast<int>(p % block_lanes)];
  };
  std::vector<std::uint32_t> order(tile.count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return identity(a) < identity(b); });
  reorder(pool, tile, order);
}

void sort_tiles(Model& model, const std::vector<bool>& wanted) {
  BrickGrid& grid = *model.grid;
  for_each_by_threads(0, grid.owned(), 4, [&](int s) {
    Brick& brick = grid.brick(static_cast<Slot>(s));
    for (ParticleTile& tile : brick.tiles) {
      if (!wanted.empty() && !wanted[static_cast<std::size_t>(tile.body)]) continue;
      BlockPool& pool = *model.bodies[static_cast<std::size_t>(tile.body)].pool;
      sort_by_identity(pool, tile);
      sort_by_site(grid, brick.coord, pool, tile);
    }
  });
}

void insert_particles(Model& model, const MigrationBuffer& particles) {
  struct Arrival {
    Slot slot;
    std::int32_t body;
    double identity;
    std::size_t index;
  };
  std::vector<Arrival> arrivals(particles.size());
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const MigrationBuffer::Head& head = particles.heads[i];
    const ColumnLayout& layout = model.bodies[static_cast<std::size_t>(head.body)].pool->layout();
    arrivals[i] = {model.grid->find(head.to), head.body,
                   particles.columns[particles.offsets[i] + layout.index(Column::identity)], i};
  }
  std::sort(arrivals.begin(), arrivals.end(), [](const Arrival& a, const Arrival& b) {
    if (a.slot != b.slot) return a.slot < b.slot;
    return a.body != b.body ? a.body < b.body : a.identity < b.identity;
  });
  // Each brick's arrivals are processed by one thread.
  std::vector<std::size_t> groups;
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    if (i == 0 || arrivals[i].slot != arrivals[i - 1].slot) groups.push_back(i);
  }
  groups.push_back(arrivals.size());
  for_each_by_threads(std::size_t{0}, groups.size() - 1, 16, [&](std::size_t g) {
    const Slot slot = arrivals[groups[g]].slot;
    Brick& brick = model.grid->brick(slot);
    const BrickFrame frame(model.grid->geometry(), brick.coord);
    std::optional<std::uint64_t>& cells = model.grid->own_cells(slot);
    for (std::size_t i = groups[g]; i < groups[g + 1]; ++i) {
      const Arrival& a = arrivals[i];
      const double* columns = &particles.columns[particles.offsets[a.index]];
      append(model, brick, a.body, columns);
      const ColumnLayout& layout = model.bodies[static_cast<std::size_t>(a.body)].pool->layout();
      if (cells) *cells |= cell_of(frame, columns + layout.index(Column::position_x));
    }
  });
}

void arrange_blocks(Model& model) {
  const std::vector<BlockPool*> pools = pools_of(model);
  std::vector<std::size_t> pool_of;  // of each body
  for (const Body& b : model.bodies)
    pool_of.push_back(static_cast<std::size_t>(std::ranges::find(pools, b.pool.get()) - pools.begin()));
  std::vector<std::vector<BlockIndex>> in_use(pools.size());
  for (Brick& brick : model.grid->bricks()) {
    for (ParticleTile& tile : brick.tiles) {
      std::vector<BlockIndex>& blocks = in_use[pool_of[static_cast<std::size_t>(tile.body)]];
      for (BlockIndex& b : tile.blocks) {
        blocks.push_back(b);
        b = static_cast<BlockIndex>(blocks.size() - 1);
      }
    }
  }
  for (std::size_t p = 0; p < pools.size(); ++p) pools[p]->arrange(in_use[p]);
}

}  // namespace mpm::core
