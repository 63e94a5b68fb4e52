// Partition, claim and retire: every rank has the same picture of who owns what, and its own part of it.
#include <catch2/catch.hpp>

#include "parallel/communication.hpp"
#include "tests/parallel/world.hpp"

using namespace mpm::parallel;
using namespace mpm::parallel::test;
using mpm::core::BrickCoord;
using mpm::core::BrickCount;
using mpm::core::BrickGrid;
using mpm::core::DecompositionInput;
using mpm::core::PartitionMethod;

namespace {

std::string picture(const BrickTable& directory, const std::set<BrickCoord>& bricks) {
  std::string text;
  for (const BrickCoord b : bricks) text += std::to_string(directory.owner(b)) + ' ';
  return text;
}

/// The grid of this rank and the directory of all agree with the set of bricks that should exist.
void check_all(const MpiCommunication& exchange, const BrickGrid& grid, const std::set<BrickCoord>& bricks) {
  const BrickTable& directory = exchange.directory().table();
  REQUIRE(directory.size() == bricks.size());
  REQUIRE(same_on_all(picture(directory, bricks)));
  std::set<BrickCoord> owned, ghosts;
  for (const auto& b : grid.bricks()) owned.insert(b.coord);
  for (int g = 0; g < grid.ghosts(); ++g) ghosts.insert(grid.ghost(g));
  std::set<BrickCoord> expected;
  for (const BrickCoord b : bricks) {
    REQUIRE(exchange.directory().table().contains(b));
    REQUIRE(directory.owner(b) < world().size());
    if (directory.owner(b) == world().rank()) expected.insert(b);
  }
  REQUIRE(owned == expected);
  REQUIRE(grid.owned() == static_cast<int>(owned.size()));
  REQUIRE(ghosts == ghosts_of(bricks, directory, world().rank()));
}

/// Counts of which each rank has found a part, some bricks by several ranks.
std::vector<BrickCount> part_of(const std::set<BrickCoord>& bricks, std::mt19937_64& random) {
  std::vector<BrickCount> counts;
  for (const BrickCoord b : bricks) {
    const auto finder = static_cast<int>(random() % static_cast<unsigned>(world().size()));
    const auto second = static_cast<int>(random() % static_cast<unsigned>(2 * world().size()));
    if (world().rank() == finder || world().rank() == second) counts.push_back({b, 100});
    if (world().rank() == finder) counts.push_back({b, 1});
  }
  return counts;
}

}  // namespace

TEST_CASE("A partition covers every brick once") {
  const auto method = GENERATE(PartitionMethod::automatic, PartitionMethod::metis, PartitionMethod::uniform);
  const double share = GENERATE(0.0, 0.02, 0.3, 1.0);
  const bool dimensions = GENERATE(false, true);
  std::mt19937_64 random(5);
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(40));
  DecompositionInput how;
  how.method = method;
  if (dimensions) how.dimensions = {1, 1, world().size()};
  for (int round = 0; round < 2; ++round) {
    const auto list = random_bricks(random, {6, 5, 9}, share);
    const std::set<BrickCoord> bricks(list.begin(), list.end());
    exchange.bricks.partition(grid, part_of(bricks, random), how);
    check_all(exchange, grid, bricks);
    if (dimensions && method != PartitionMethod::metis) {
      for (const BrickCoord b : bricks)
        CHECK(exchange.directory().table().owner(b) == b.z * world().size() / 10);
    }
  }
}

TEST_CASE("A partition weighs bricks by their particles") {
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400));
  std::vector<BrickCount> counts;
  // The upper half holds three times as many particles, found by two ranks.
  for (std::int32_t i = 0; i < 8 * 8 * 24; ++i) {
    const BrickCoord b{i % 8, i / 8 % 8, i / 64};
    if (i % world().size() == world().rank()) counts.push_back({b, 100});
    if ((i + 1) % world().size() == world().rank() && b.z >= 12) counts.push_back({b, 200});
  }
  exchange.bricks.partition(grid, counts, {});
  std::int64_t mine = 0;
  for (const auto& b : grid.bricks()) mine += b.coord.z >= 12 ? 300 : 100;
  const auto spread = exchange.reductions.spread(static_cast<double>(mine));
  CHECK(spread.max <= 1.1 * spread.mean);
}

TEST_CASE("Dimensions that do not make up the ranks are everybody's input error") {
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(40));
  DecompositionInput how;
  how.dimensions = {2, 3, world().size()};
  how.source = {"case.xmp", 17};
  std::string text;
  try {
    exchange.bricks.partition(grid, {}, how);
  } catch (const mpm::core::InputErrors& e) { text = e.what(); }
  CHECK(same_on_all(text));
  CHECK(text == "case.xmp:17: <DomainDecomposition>: dimension0 * dimension1 * dimension2 = " +
                    std::to_string(6 * world().size()) + " must equal the number of ranks, which is " +
                    std::to_string(world().size()) +
                    "; start that many ranks, change the dimensions, or remove the element");
}

TEST_CASE("A claimed brick goes to the rank that shares most nodes with it, whoever asks") {
  // Along x one brick after the other, each rank its own; a partition into slabs.
  const int ranks = world().size();
  std::set<BrickCoord> slabs;
  for (std::int32_t x = 0; x < ranks; ++x) slabs.insert({x, 0, 0});
  const std::vector<BrickCount> counts = [&] {
    std::vector<BrickCount> c;
    for (const BrickCoord b : slabs) c.push_back({b, 1});
    return c;
  }();
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(4 * std::max(ranks, 40)));
  DecompositionInput how;
  how.method = PartitionMethod::metis;  // fewer bricks than ranks: in the order of a curve
  exchange.bricks.partition(grid, counts, how);
  const auto owner = [&](BrickCoord b) { return exchange.directory().table().owner(b); };

  SECTION("all ranks at once, and a brick that exists") {
    std::vector<BrickCoord> wanted{{0, 1, 0}, {0, 0, 0}, {0, 1, 0}};
    exchange.bricks.activate(grid, wanted);
    slabs.insert({0, 1, 0});
    CHECK(owner({0, 1, 0}) == owner({0, 0, 0}));
    check_all(exchange, grid, slabs);
  }
  SECTION("each rank its own, diagonally") {
    for (std::int32_t x = 0; x < ranks; ++x) slabs.insert({x, 1, 1});
    const BrickCoord mine{world().rank(), 1, 1};
    exchange.bricks.activate(grid, std::span(&mine, 1));
    check_all(exchange, grid, slabs);
    // In the order of keys: the brick below shares 5 nodes, the one placed just before, 25.
    CHECK(owner({0, 1, 1}) == owner({0, 0, 0}));
  }
  SECTION("only the last rank asks") {
    std::vector<BrickCoord> wanted;
    if (world().rank() == ranks - 1) wanted = {{ranks, 0, 0}, {ranks + 1, 1, 1}, {ranks / 2, 1, 0}};
    exchange.bricks.activate(grid, wanted);
    slabs.insert({{ranks, 0, 0}, {ranks + 1, 1, 1}, {ranks / 2, 1, 0}});
    check_all(exchange, grid, slabs);
    CHECK(owner({ranks, 0, 0}) == owner({ranks - 1, 0, 0}));
    CHECK(owner({ranks + 1, 1, 1}) == owner({ranks, 0, 0}));
    CHECK(owner({ranks / 2, 1, 0}) == owner({ranks / 2, 0, 0}));
  }
  SECTION("far from everything, to the lowest that asks") {
    std::vector<BrickCoord> wanted;
    if (2 * world().rank() >= ranks - 1) wanted = {{500, 500, 500}};
    exchange.bricks.activate(grid, wanted);
    slabs.insert({500, 500, 500});
    check_all(exchange, grid, slabs);
    CHECK(owner({500, 500, 500}) == ranks / 2);
  }
  SECTION("no_owner asks") {
    const auto revision = grid.revision();
    exchange.bricks.activate(grid, {});
    CHECK(grid.revision() == revision);
  }
}

TEST_CASE("Of equal shares the lowest rank gets the brick") {
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400));
  const std::vector<BrickCount> counts{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}};
  DecompositionInput how;
  how.method = PartitionMethod::metis;
  exchange.bricks.partition(grid, counts, how);
  const BrickCoord between{1, 0, 0};
  exchange.bricks.activate(grid, std::span(&between, 1));
  const BrickTable& d = exchange.directory().table();
  CHECK(d.owner(between) == std::min(d.owner({0, 0, 0}), d.owner({2, 0, 0})));
  check_all(exchange, grid, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
}

TEST_CASE("In a uniform decomposition a claimed brick goes to its box") {
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(4 * 16));
  DecompositionInput how;
  how.dimensions = {world().size(), 1, 1};
  const std::vector<BrickCount> counts{{{0, 0, 0}, 1}};
  exchange.bricks.partition(grid, counts, how);
  std::set<BrickCoord> bricks{{0, 0, 0}};
  for (std::int32_t x = 1; x < 16; ++x) {
    std::vector<BrickCoord> wanted;
    if (exchange.directory().table().owner({x - 1, 0, 0}) == world().rank()) wanted = {{x, 0, 0}};
    exchange.bricks.activate(grid, wanted);
    bricks.insert({x, 0, 0});
    CHECK(exchange.directory().table().owner({x, 0, 0}) == x * world().size() / 16);
    check_all(exchange, grid, bricks);
  }
}

TEST_CASE("Bricks come and go by chance, and all ranks keep the same picture") {
  const auto method = GENERATE(PartitionMethod::metis, PartitionMethod::uniform);
  std::mt19937_64 random(6);
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400));
  const auto list = random_bricks(random, {4, 4, 4}, 0.4);
  std::set<BrickCoord> bricks(list.begin(), list.end());
  DecompositionInput how;
  how.method = method;
  exchange.bricks.partition(grid, part_of(bricks, random), how);
  for (int round = 0; round < 100; ++round) {
    std::vector<BrickCoord> wanted, empty;
    std::set<BrickCoord> added;
    for (const BrickCoord b : bricks) {
      if (random() % 10 != 0) continue;
      const BrickCoord next = b + mpm::core::neighbour_offset(static_cast<int>(random() % 27));
      if (next.x < 0 || next.y < 0 || next.z < 0) continue;
      added.insert(next);
      // The owner of the brick beside it asks, and sometimes others.
      if (exchange.directory().table().owner(b) == world().rank()) wanted.push_back(next);
      if (random() % static_cast<unsigned>(world().size()) == static_cast<unsigned>(world().rank()))
        wanted.push_back(next);
    }
    exchange.bricks.activate(grid, wanted);
    bricks.insert(added.begin(), added.end());
    check_all(exchange, grid, bricks);

    std::set<BrickCoord> removed;
    for (const BrickCoord b : bricks) {
      if (random() % 8 != 0) continue;
      removed.insert(b);
      if (exchange.directory().table().owner(b) == world().rank()) empty.push_back(b);
    }
    exchange.bricks.deactivate(grid, empty);
    for (const BrickCoord b : removed) bricks.erase(b);
    check_all(exchange, grid, bricks);
    if (bricks.empty()) break;
  }
}

TEST_CASE("A change far away leaves the grid alone") {
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400));
  std::vector<BrickCount> counts;
  for (std::int32_t r = 0; r < world().size(); ++r) counts.push_back({{10 * r, 0, 0}, 1});
  DecompositionInput how;
  how.method = PartitionMethod::metis;
  exchange.bricks.partition(grid, counts, how);
  const auto revision = grid.revision();
  std::vector<BrickCoord> wanted;
  if (exchange.directory().table().owner({0, 0, 0}) == world().rank()) wanted = {{0, 1, 0}};
  exchange.bricks.activate(grid, wanted);
  CHECK((grid.revision() == revision) == wanted.empty());
  CHECK(exchange.directory().table().contains({0, 1, 0}));
  exchange.bricks.deactivate(grid, wanted);
  CHECK((grid.revision() == revision) == wanted.empty());
  CHECK_FALSE(exchange.directory().table().contains({0, 1, 0}));
}

TEST_CASE("A brick that is not ours is not ours to retire") {
  MpiCommunication exchange(world());
  BrickGrid grid(unit_grid(400));
  exchange.bricks.partition(grid, {}, {});
  const BrickCoord nowhere{1, 2, 3};
  CHECK_THROWS_AS(exchange.bricks.deactivate(grid, std::span(&nowhere, 1)), std::logic_error);
}
