// The order of particles in a tile: by cell and as they were, by identity, and arrivals in the order of
// identities.
#include "core/step/migration.hpp"

#include <algorithm>
#include <random>

#include <catch2/catch.hpp>

#include "core/particles/tile_order.hpp"
#include "tests/core/step/case.hpp"

using namespace mpm::core;
using namespace mpm::tests;

namespace {

/// `count` particles anywhere in the first brick of the tumbling block's grid.
SmallRun scattered(int count) {
  ReferenceCase c = tumbling_block();
  c.particles.resize(static_cast<std::size_t>(count));
  std::mt19937 random(41);
  std::uniform_real_distribution<double> unit(0, 3.999);
  for (ReferenceParticle& p : c.particles) {
    for (std::size_t a = 0; a < 3; ++a) p.x[a] = c.origin[a] + c.cell[a] * unit(random);
  }
  return SmallRun(c);
}

std::int64_t cell_of(const GridGeometry& g, const Vector& x) {
  return g.cell_index(x[0], 0) + 4 * (g.cell_index(x[1], 1) + 4 * g.cell_index(x[2], 2));
}

}  // namespace

TEST_CASE("Sorting by cell keeps the order within a cell; sorting by identity orders the whole") {
  for (const int count : {1, 8, 9, 500}) {
    const SmallRun run = scattered(count);
    BrickGrid& grid = *run.model.grid;
    ParticleTile& tile = grid.brick(0).tiles[0];
    BlockPool& pool = *run.model.bodies[0].pool;
    const auto before = run.columns();
    sort_by_identity(pool, tile);
    std::vector<std::int64_t> order = run.order();
    CHECK(std::is_sorted(order.begin(), order.end()));
    // Some history: the order is no longer that of identities.
    std::vector<double> columns(static_cast<std::size_t>(pool.layout().columns()));
    for (std::uint32_t i = 0; i < tile.count / 2; i += 3) {
      extract(pool, tile, i, columns.data());
      remove_swapping(pool, tile, i);
      append(pool, tile, columns.data());
    }
    order = run.order();
    const auto particles = run.particles();
    std::stable_sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) {
      return cell_of(grid.geometry(), particles.at(a).x) < cell_of(grid.geometry(), particles.at(b).x);
    });
    sort_by_site(grid, grid.brick(0).coord, pool, tile);
    CHECK(run.order() == order);
    CHECK(run.columns() == before);  // every particle still has its own columns
    CHECK(tile.blocks.size() == static_cast<std::size_t>((count + 7) / 8));
  }
}

TEST_CASE("Arrivals are appended in the order of identities, in whatever order they come") {
  ReferenceCase c = tumbling_block();
  std::mt19937 random(42);
  std::vector<std::int64_t> first;
  for (int trial = 0; trial < 4; ++trial) {
    SmallRun run(c, 360);
    MigrationBuffer travellers;
    const int columns_of = run.model.bodies[0].pool->layout().columns();
    std::vector<std::pair<int, std::vector<double>>> arrivals;
    for (const auto& [identity, columns] : run.columns()) {
      auto copy = columns;
      copy[17] = static_cast<double>(1000 + identity);
      arrivals.emplace_back(static_cast<int>(identity % 2), copy);
    }
    std::shuffle(arrivals.begin(), arrivals.end(), random);
    for (const auto& [body, columns] : arrivals) {
      travellers.add(run.model.grid->geometry().brick_at({columns[0], columns[1], columns[2]}), body,
                     columns.data(), columns_of);
    }
    insert_particles(run.model, travellers);
    if (trial == 0) first = run.order();
    CHECK(run.order() == first);
    CHECK(run.order().size() == 1440);
    for (const Brick& brick : run.model.grid->bricks()) {
      CHECK(std::is_sorted(brick.tiles.begin(), brick.tiles.end(),
                           [](const ParticleTile& a, const ParticleTile& b) { return a.body < b.body; }));
    }
  }
}
