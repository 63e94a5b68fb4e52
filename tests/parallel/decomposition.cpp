#include "parallel/decomposition.hpp"

#include <numeric>

#include <catch2/catch.hpp>

#include "tests/parallel/world.hpp"

using namespace mpm::parallel;
using namespace mpm::parallel::test;
using mpm::core::BrickCoord;
using mpm::core::BrickCount;

namespace {

std::vector<BrickCount> bar(BrickCoord extent, std::int64_t particles) {
  std::vector<BrickCount> bricks;
  for (std::int32_t i = 0; i < extent.x * extent.y * extent.z; ++i) {
    bricks.push_back({{i % extent.x, i / extent.x % extent.y, i / extent.x / extent.y}, particles});
  }
  return bricks;
}

/// Largest share over the mean; -1 if an owner is no rank.
double imbalance(const std::vector<BrickCount>& bricks, const std::vector<std::int32_t>& owner, int ranks) {
  std::vector<double> sum(static_cast<std::size_t>(ranks));
  double total = 0;
  if (owner.size() != bricks.size()) return -1;
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    if (owner[i] < 0 || owner[i] >= ranks) return -1;
    sum[static_cast<std::size_t>(owner[i])] += static_cast<double>(bricks[i].particles);
    total += static_cast<double>(bricks[i].particles);
  }
  return *std::max_element(sum.begin(), sum.end()) * ranks / total;
}

/// Nodes shared by pairs of bricks of different ranks.
std::int64_t cut(const std::vector<BrickCount>& bricks, const std::vector<std::int32_t>& owner) {
  BrickTable directory;
  for (std::size_t i = 0; i < bricks.size(); ++i) directory.assign(bricks[i].brick, owner[i]);
  std::int64_t nodes = 0;
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    for (int n = 0; n < mpm::core::neighbourhood; ++n) {
      const BrickCoord offset = mpm::core::neighbour_offset(n);
      const std::int32_t other = directory.owner(bricks[i].brick + offset);
      if (other != BrickTable::no_owner && other != owner[i]) nodes += shared_nodes({}, offset);
    }
  }
  return nodes;
}

}  // namespace

TEST_CASE("Nodes shared by neighbouring bricks") {
  CHECK(shared_nodes({}, {1, 0, 0}) == 25);
  CHECK(shared_nodes({}, {0, -1, 1}) == 5);
  CHECK(shared_nodes({}, {-1, -1, 1}) == 1);
  CHECK(shared_nodes({1, 1}, {0, 1, 0}) == 147);
  CHECK(shared_nodes({1, 0}, {0, 1, 0}) == 72);
  CHECK(shared_nodes({1, 1}, {1, 1, 1}) == 27);
}

TEST_CASE("Boxes of a grid have equal extents") {
  mpm::core::GridGeometry grid = unit_grid(0);
  grid.cells = {4 * 12, 4 * 6 - 3, 4};  // 12 x 6 x 1 bricks
  const UniformBoxes boxes = boxes_of_grid(grid, {3, 2, 1});
  std::vector<int> bricks(6);
  for (std::int32_t x = 0; x < 12; ++x) {
    for (std::int32_t y = 0; y < 6; ++y) {
      CHECK(boxes.owner({x, y, 0}) == x / 4 + 3 * (y / 3));
      ++bricks[static_cast<std::size_t>(boxes.owner({x, y, 0}))];
    }
  }
  CHECK(bricks == std::vector<int>(6, 12));
  CHECK(boxes.owner({-5, 99, 7}) == 3);
}

TEST_CASE("Boxes of bricks are as near to cubes as the ranks allow") {
  using Parts = std::array<int, 3>;
  CHECK(boxes_of_bricks(bar({8, 8, 8}, 1), 8).parts() == Parts{2, 2, 2});
  CHECK(boxes_of_bricks(bar({4, 4, 32}, 1), 8).parts() == Parts{1, 1, 8});
  CHECK(boxes_of_bricks(bar({12, 12, 1}, 1), 4).parts() == Parts{2, 2, 1});
  CHECK(boxes_of_bricks(bar({2, 3, 1}, 1), 6).parts() == Parts{2, 3, 1});
  CHECK(boxes_of_bricks(bar({1, 1, 3}, 1), 7).parts() == Parts{1, 1, 7});
  CHECK(boxes_of_bricks({}, 5).owner({3, 4, 5}) < 5);
}

TEST_CASE("METIS balances a bar and cuts it across") {
  if (world().rank() != 0) return;  // no communication: one rank does
  for (const BrickCoord extent : {BrickCoord{13, 13, 32}, BrickCoord{5, 5, 12}, BrickCoord{40, 3, 2}}) {
    const std::vector<BrickCount> bricks = bar(extent, 512);
    for (const int ranks : {1, 2, 3, 4, 8}) {
      const std::vector<std::int32_t> owner = split_graph(bricks, {}, ranks, 1.05);
      INFO(extent.x << " x " << extent.y << " x " << extent.z << " bricks, " << ranks << " ranks, cut "
                    << cut(bricks, owner) << ", of the curve " << cut(bricks, split_curve(bricks, ranks)));
      const double balance = imbalance(bricks, owner, ranks);
      CHECK(balance >= 1);
      CHECK(balance <= 1.1);
      CHECK(cut(bricks, owner) <= cut(bricks, split_curve(bricks, ranks)));
      CHECK(owner == split_graph(bricks, {}, ranks, 1.05));
    }
  }
}

TEST_CASE("Weights of any size are balanced") {
  if (world().rank() != 0) return;  // no communication: one rank does
  std::mt19937_64 random(3);
  for (const double largest : {10.0, 1e5, 1e12, 1e17}) {
    std::vector<BrickCount> bricks = bar({9, 9, 9}, 1);
    for (BrickCount& b : bricks) {
      b.particles = static_cast<std::int64_t>(largest * std::uniform_real_distribution<>(0.1, 1)(random));
    }
    for (const int ranks : {2, 5, 8})
      CHECK(imbalance(bricks, split_graph(bricks, {}, ranks, 1.05), ranks) <= 1.1);
  }
}

TEST_CASE("Few bricks, many ranks, islands") {
  for (const int ranks : {1, 2, 3, 4, 8, 1000}) {
    for (int n = 0; n < 20; ++n) {
      std::vector<BrickCount> bricks;
      for (std::int32_t i = 0; i < n; ++i) bricks.push_back({{1000 * i, 0, 2000 * (i % 3)}, 7});
      const std::vector<std::int32_t> owner = split_graph(bricks, {}, ranks, 1.05);
      std::vector<int> held(static_cast<std::size_t>(ranks));
      REQUIRE(owner.size() == bricks.size());
      for (const std::int32_t r : owner) ++held.at(static_cast<std::size_t>(r));
      CHECK(*std::max_element(held.begin(), held.end()) <= (n + ranks - 1) / ranks);
    }
  }
}

TEST_CASE("The directory remembers through growth and removal") {
  std::mt19937_64 random(4);
  BrickTable directory;
  std::set<BrickCoord> known;
  const auto owner = [](BrickCoord b) { return (b.x + 3 * b.y + 7 * b.z) % 11; };
  const auto any_brick = [&] {
    const auto c = [&] { return static_cast<std::int32_t>(random() % 12); };
    return BrickCoord{c(), c(), c()};
  };
  for (int round = 0; round < 20000; ++round) {
    const BrickCoord b = any_brick();
    if (round % 3000 < 1800) {
      directory.assign(b, owner(b));
      known.insert(b);
    } else {
      directory.remove(b);
      known.erase(b);
    }
    const BrickCoord other = any_brick();
    if (directory.owner(other) != (known.contains(other) ? owner(other) : BrickTable::no_owner))
      FAIL("round " << round);
  }
  CHECK(directory.size() == known.size());
  for (const BrickCoord b : known) CHECK(directory.owner(b) == owner(b));
  CHECK_FALSE(directory.contains({-1, 0, 0}));
}
