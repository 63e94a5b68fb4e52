// Which cell and which brick a point is in: on faces, in bricks that end within the grid's last cells, and
// with an origin below zero.
#include "core/grid/brick.hpp"

#include <cmath>
#include <limits>
#include <set>

#include <catch2/catch.hpp>

using namespace mpm::core;

namespace {

/// 10 x 4 x 5 cells: bricks 3 x 1 x 2, of which the last along x has two cells and along z one.
GridGeometry oblong() {
  GridGeometry g;
  g.origin = {-2.5, -1, 100};
  g.cell = {0.5, 0.25, 2};
  g.inverse_cell = {2, 4, 0.5};
  g.cells = {10, 4, 5};
  return g;
}

}  // namespace

TEST_CASE("A point belongs to the cell above it, but for the grid's upper face") {
  const GridGeometry g = oblong();
  CHECK(g.cell_index(-2.5, 0) == 0);
  CHECK(g.cell_index(-2.0, 0) == 1);
  CHECK(g.cell_index(std::nextafter(-2.0, -3.0), 0) == 0);
  CHECK(g.cell_index(-0.001, 0) == 4);
  CHECK(g.cell_index(0, 0) == 5);
  CHECK(g.cell_index(2.5, 0) == 9);
  CHECK(g.cell_index(std::nextafter(2.5, 2.0), 0) == 9);
  CHECK(g.cell_index(110, 2) == 4);
  CHECK(g.contains({-2.5, -1, 100}));
  CHECK(g.contains({2.5, 0, 110}));
  CHECK_FALSE(g.contains({2.5 + 1e-12, 0, 105}));
  CHECK_FALSE(g.contains({0, std::nextafter(-1.0, -2.0), 105}));
  // What rounds to the upper face counts as on it, for both questions alike.
  CHECK(g.contains({std::nextafter(2.5, 3.0), 0, 105}));
  CHECK(g.cell_index(std::nextafter(2.5, 3.0), 0) == 9);
  CHECK_FALSE(g.contains({0, -0.5, std::numeric_limits<double>::quiet_NaN()}));
  CHECK_FALSE(g.contains({0, -0.5, std::numeric_limits<double>::infinity()}));
}

TEST_CASE("Every cell is in one brick, and the upper face in the last") {
  const GridGeometry g = oblong();
  for (int k = 0; k < 5; ++k) {
    for (int i = 0; i < 10; ++i) {
      const BrickCoord b = g.brick_at({-2.5 + 0.5 * (i + 0.5), -0.9, 100 + 2 * (k + 0.5)});
      CHECK(b == BrickCoord{i / 4, 0, k / 4});
    }
  }
  CHECK(g.brick_at({2.5, 0, 110}) == BrickCoord{2, 0, 1});
  CHECK(g.brick_at({-0.5, -1, 108}) == BrickCoord{1, 0, 1});
  CHECK(g.last_site({0, 0, 0}, 0) == 3);
  CHECK(g.last_site({2, 0, 0}, 0) == 1);
  CHECK(g.last_site({0, 0, 1}, 2) == 0);
  CHECK(g.smallest_cell() == 0.25);
  CHECK(g.cell_volume() == 0.25);
}

TEST_CASE("Keys tell all bricks and their neighbours outside the grid apart, ordered by z, y, x") {
  constexpr std::int32_t last = (1 << 20) - 1;
  std::set<BrickKey> keys;
  int bricks = 0;
  for (const std::int32_t z : {-1, 0, 1, last, last + 1}) {
    for (const std::int32_t y : {-1, 0, 1, last, last + 1}) {
      for (const std::int32_t x : {-1, 0, 1, last, last + 1}) {
        keys.insert(key_of({x, y, z}));
        ++bricks;
        if (x >= 0 && y >= 0 && z >= 0) CHECK(brick_of_key(key_of({x, y, z})) == BrickCoord{x, y, z});
      }
    }
  }
  CHECK(keys.size() == static_cast<std::size_t>(bricks));
  CHECK(key_of({last, 0, 0}) < key_of({0, 1, 0}));
  CHECK(key_of({last, last, 0}) < key_of({0, 0, 1}));
}

TEST_CASE("The neighbourhood is in ascending order of keys, and opposite neighbours add up to 26") {
  for (int n = 0; n < neighbourhood; ++n) {
    const BrickCoord d = neighbour_offset(n), opposite = neighbour_offset(neighbourhood - 1 - n);
    CHECK(d + opposite == BrickCoord{0, 0, 0});
    if (n > 0) CHECK(key_of(BrickCoord{5, 5, 5} + neighbour_offset(n - 1)) < key_of(BrickCoord{5, 5, 5} + d));
  }
  CHECK(neighbour_offset(self_index) == BrickCoord{0, 0, 0});
}

TEST_CASE("Keys tell bricks of different levels apart") {
  std::set<BrickKey> keys;
  std::size_t n = 0;
  for (int level = 0; level < most_brick_levels; ++level) {
    for (const BrickCoord place :
         {BrickCoord{0, 0, 0}, {1, 0, 0}, {0, 7, 3}, {(1 << 20) - 1, 5, (1 << 20) - 1}}) {
      const BrickCoord b{place.x, place.y, place.z, level};
      CHECK(brick_of_key(key_of(b)) == b);
      keys.insert(key_of(b));
      ++n;
    }
  }
  CHECK(keys.size() == n);
  CHECK(key_of({1, 2, 3}) == (BrickKey{3} << 42 | BrickKey{2} << 21 | 1));
}

TEST_CASE("The number of a node in a brick's block, and back") {
  for (const NodeBlockShape shape : {NodeBlockShape{0, 0}, NodeBlockShape{1, 0}, NodeBlockShape{1, 1}}) {
    std::set<int> numbers;
    for (int k = shape.lowest(); k <= shape.highest(); ++k) {
      for (int j = shape.lowest(); j <= shape.highest(); ++j) {
        for (int i = shape.lowest(); i <= shape.highest(); ++i) {
          numbers.insert(shape.index(i, j, k));
          CHECK(shape.node(shape.index(i, j, k)) == std::array<int, 3>{i, j, k});
        }
      }
    }
    CHECK(static_cast<int>(numbers.size()) == shape.nodes());
    CHECK(*numbers.rbegin() == shape.nodes() - 1);
  }
}
