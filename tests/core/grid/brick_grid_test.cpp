// The set of bricks of a rank: slots, neighbours, ghosts, and particles that stay where they are when it
// changes.
#include "core/grid/brick_grid.hpp"

#include <algorithm>
#include <random>
#include <set>

#include <catch2/catch.hpp>

using namespace mpm::core;

namespace {

GridGeometry cube(std::int64_t cells) {
  GridGeometry g;
  g.cell = g.inverse_cell = {1, 1, 1};
  g.cells = {cells, cells, cells};
  return g;
}

/// Everything that the slots of a grid promise about a set of owned bricks and ghosts.
void check(const BrickGrid& grid, const std::set<BrickCoord>& owned, const std::set<BrickCoord>& ghosts) {
  REQUIRE(grid.owned() == static_cast<int>(owned.size()));
  REQUIRE(grid.ghosts() == static_cast<int>(ghosts.size()));
  std::set<BrickCoord> seen;
  for (Slot s = 0; s < grid.owned(); ++s) {
    const Brick& brick = grid.brick(s);
    seen.insert(brick.coord);
    CHECK(grid.find(brick.coord) == s);
    bool touches = false;
    for (int n = 0; n < neighbourhood; ++n) {
      const BrickCoord there = brick.coord + neighbour_offset(n);
      const Slot other = brick.neighbour[static_cast<std::size_t>(n)];
      CHECK(other == grid.find(there));
      CHECK((other != no_slot) == (owned.contains(there) || ghosts.contains(there)));
      touches = touches || ghosts.contains(there);
      if (other >= grid.owned()) CHECK(grid.ghost(other - grid.owned()) == there);
    }
    CHECK((s < grid.boundary()) == touches);
    // Within each part the order is that of the keys.
    if (s != 0 && s != grid.boundary()) CHECK(key_of(grid.brick(s - 1).coord) < key_of(brick.coord));
  }
  CHECK(seen == owned);
  for (int g = 1; g < grid.ghosts(); ++g) CHECK(key_of(grid.ghost(g - 1)) < key_of(grid.ghost(g)));
}

}  // namespace

TEST_CASE("Slots, neighbours and the boundary follow from the sets of bricks, given in any order") {
  std::mt19937 random(4);
  BrickGrid grid(cube(24));
  for (int trial = 0; trial < 50; ++trial) {
    std::set<BrickCoord> owned, ghosts;
    for (int i = 0; i < 216; ++i) {
      const BrickCoord b{i % 6, i / 6 % 6, i / 36};
      const unsigned dice = random() % 8;
      if (dice < 3) owned.insert(b);
      if (dice == 3 && trial % 3 != 0) ghosts.insert(b);
    }
    std::vector<BrickCoord> o(owned.begin(), owned.end()), g(ghosts.begin(), ghosts.end());
    std::shuffle(o.begin(), o.end(), random);
    std::shuffle(g.begin(), g.end(), random);
    const std::uint64_t before = grid.revision();
    grid.reset(o, g);
    CHECK(grid.revision() == before + 1);
    check(grid, owned, ghosts);
    // Each slot has node records of its own, aligned for the widest vectors.
    for (const NodeArray of : {NodeArray::first, NodeArray::second}) {
      for (Slot s = 1; s < grid.owned() + grid.ghosts(); ++s) {
        CHECK(grid.contributions(of, s) - grid.contributions(of, s - 1) >= 125 * record_doubles(of));
      }
      if (grid.owned() > 0) CHECK(reinterpret_cast<std::uintptr_t>(grid.contributions(of, 0)) % 64 == 0);
    }
  }
  grid.reset({}, {});
  check(grid, {}, {});
}

TEST_CASE("Bricks that stay keep their particles; new ones and those that were ghosts start empty") {
  BrickGrid grid(cube(16));
  BlockPool pool{ColumnLayout()};
  grid.reset({{0, 0, 0}, {1, 0, 0}}, {{2, 0, 0}});
  std::vector<double> columns(18, 1.0);
  Brick& first = grid.brick(grid.find({1, 0, 0}));
  append(pool, first.tiles.emplace_back(), columns.data());
  grid.reset({{3, 3, 3}, {1, 0, 0}, {2, 0, 0}}, {{0, 0, 0}});
  CHECK(grid.brick(grid.find({1, 0, 0})).particles() == 1);
  CHECK(grid.brick(grid.find({2, 0, 0})).particles() == 0);
  CHECK(grid.brick(grid.find({3, 3, 3})).particles() == 0);
  check(grid, {{3, 3, 3}, {1, 0, 0}, {2, 0, 0}}, {{0, 0, 0}});
}

TEST_CASE("Bricks with several velocity fields keep nodes for each of them, apart from all others") {
  BrickGrid grid(cube(24), {},
                 {NodeArray::first, NodeArray::second, NodeArray::third, NodeArray::fourth, NodeArray::fifth,
                  NodeArray::sixth, NodeArray::seventh});
  grid.reset({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{3, 0, 0}});
  const std::vector<std::vector<std::int32_t>> components{{}, {0, 2, 5}, {2, 3}, {3, 4}};
  const std::vector<int> fields{1, 3, 2, 2};
  CHECK_FALSE(grid.has_fields_by_component());
  grid.set_components(components);
  const std::uint64_t revision = grid.revision();
  grid.set_components(components);
  CHECK(grid.revision() == revision);
  for (const NodeArray of : node_arrays) {
    std::vector<double*> blocks;
    for (Slot s = 0; s < 4; ++s) {
      REQUIRE(grid.velocity_fields(s) == fields[static_cast<std::size_t>(s)]);
      CHECK(grid.contributions(of, s, 0) == grid.contributions(of, s));
      for (int f = 0; f < grid.velocity_fields(s); ++f) blocks.push_back(grid.contributions(of, s, f));
    }
    REQUIRE(blocks.size() == 8);
    std::sort(blocks.begin(), blocks.end());
    for (std::size_t i = 1; i < blocks.size(); ++i)
      CHECK(blocks[i] - blocks[i - 1] >= 125 * record_doubles(of));
    // All of it is memory of ours.
    for (double* block : blocks) std::fill_n(block, 125 * record_doubles(of), 1.0);
  }
  CHECK(grid.field_of(1, 5) == 2);
  CHECK(grid.field_of(2, 5) == -1);
  CHECK(grid.field_of(0, 0) == -1);
  CHECK(std::ranges::equal(grid.components(3), components[3]));
  grid.set_components({{1}, {1}, {1}, {}});
  CHECK(grid.revision() != revision);
  CHECK(grid.velocity_fields(1) == 1);
  grid.reset({{0, 0, 0}}, {});
  CHECK(grid.velocity_fields(0) == 1);
  CHECK_FALSE(grid.has_fields_by_component());
}
