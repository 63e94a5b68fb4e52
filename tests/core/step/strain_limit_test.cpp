// The strain of a step where bodies meet fast.
#include "core/step/strain_limit.hpp"

#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

using namespace mpm::core;

TEST_CASE(
    "The largest strain rate is the largest difference of neighbouring nodes' velocities over their "
    "distance") {
  const Vec3<double> inverse_cell{2, 4, 8};
  for (const NodeBlockShape shape : {NodeBlockShape{0, 0}, NodeBlockShape{1, 0}, NodeBlockShape{1, 1}}) {
    std::vector<double> record(static_cast<std::size_t>(node_doubles * shape.nodes()), 0.0);
    const auto node = [&](int i, int j, int k) {
      return Motion{record.data() + node_doubles * shape.index(i, j, k)};
    };
    for (int n = 0; n < shape.nodes(); ++n) Motion{record.data() + node_doubles * n}.mass() = 1;
    CHECK(largest_strain_rate(shape, inverse_cell, 0, record.data()) == 0);
    const int low = shape.lowest(), high = shape.highest();
    // On every edge, inner and outermost ones.
    const int ends[3][2][3] = {{{low, 1, 2}, {low + 1, 1, 2}},
                               {{2, high - 1, 0}, {2, high, 0}},
                               {{high, high, high - 1}, {high, high, high}}};
    for (int a = 0; a < 3; ++a) {
      const auto [p, q] = ends[a];
      // The pair moves alike against its neighbours across; its own difference is the largest by far.
      node(p[0], p[1], p[2]).strain_velocity()[1] = 300;
      node(q[0], q[1], q[2]).strain_velocity()[2] = -400;
      const double along_pair = 500 * inverse_cell[a], beside = 400 * inverse_cell.z;
      const double rate = largest_strain_rate(shape, inverse_cell, 0, record.data());
      CHECK(rate >= along_pair);
      CHECK(rate <= std::max(along_pair, beside));
      // A node without mass does not count.
      node(q[0], q[1], q[2]).mass() = 1e-9;
      CHECK(largest_strain_rate(shape, inverse_cell, 1e-6, record.data()) <= 300 * inverse_cell.z);
      node(q[0], q[1], q[2]).mass() = 1;
      node(p[0], p[1], p[2]).strain_velocity()[1] = 0;
      node(q[0], q[1], q[2]).strain_velocity()[2] = 0;
    }
  }
}

TEST_CASE("A step is shortened to the largest strain, and not lengthened") {
  CHECK(limited_step(2.0, 0) == 2.0);
  CHECK(limited_step(2.0, 0.05) == 2.0);
  const double limited = limited_step(2.0, 10);
  CHECK(limited < 2.0);
  CHECK(limited == Approx(10 * limited_step(2.0, 100)));
}

TEST_CASE("A brick is passed over only where the velocities around it are too close together") {
  GridGeometry g;
  g.cell = {2, 1, 4};
  g.inverse_cell = {0.5, 1, 0.25};
  g.cells = {40, 40, 40};
  g.boundary[0] = Boundary::symmetry;
  BrickGrid grid(g, {1, 0});
  grid.reset({{4, 4, 4}, {5, 5, 5}, {7, 4, 4}, {8, 4, 4}, {0, 4, 4}}, {{7, 7, 7}});
  std::vector<VelocityRange> ranges(static_cast<std::size_t>(grid.owned()));
  const auto at = [&](BrickCoord b) -> VelocityRange& {
    return ranges[static_cast<std::size_t>(grid.find(b))];
  };
  const auto faster = [&](BrickCoord b, double rate) {
    return may_strain_faster(grid, ranges, grid.find(b), rate);
  };
  at({4, 4, 4}) = {{0, 0, -3}, {1, 1, 0}};
  at({5, 5, 5}) = {{1, 0, 0}, {3, 5, 1}};
  // Together from (0, 0, -3) to (3, 5, 1), over the shortest edge.
  const double rate = std::sqrt(9.0 + 25 + 16);
  for (const BrickCoord b : {BrickCoord{4, 4, 4}, BrickCoord{5, 5, 5}}) {
    CHECK(faster(b, 0.999 * rate));
    CHECK(faster(b, rate));  // round-off is no reason
    CHECK_FALSE(faster(b, 1.001 * rate));
  }
  at({7, 4, 4}) = at({8, 4, 4}) = {{7, 7, 7}, {7, 7, 7}};
  CHECK_FALSE(faster({8, 4, 4}, 1));
  // Beside a wall and beside a brick of another rank.
  at({0, 4, 4}) = {{0, 0, 0}, {0, 0, 0}};
  CHECK(faster({0, 4, 4}, 1e9));
  grid.reset({{4, 4, 4}}, {{5, 4, 4}});
  ranges = {{{0, 0, 0}, {0, 0, 0}}};
  CHECK(faster({4, 4, 4}, 1e9));
}
