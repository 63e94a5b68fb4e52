// Products with the mass of a cell from its moments, against the sums over its particles.
#include "core/shape/cell_mass.hpp"

#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "core/shape/list.hpp"

using namespace mpm::core;

TEST_CASE("Cells and their lowest points are numbered both ways") {
  for (int c = 0; c < cell_mass::cells; ++c) {
    const int point = cell_mass::lowest_point(c);
    CHECK(cell_at(point) == c);
    CHECK(point % lattice_points.side() < brick_cells);
  }
  CHECK(trilinear_on_lattice<Linear>);
  CHECK(trilinear_on_lattice<Sgmp>);
  CHECK(trilinear_on_lattice<Ddmp>);
  CHECK_FALSE(trilinear_on_lattice<QuadraticBSpline>);
  CHECK_FALSE(trilinear_on_lattice<UniformGimp>);
  CHECK_FALSE(trilinear_on_lattice<Cpdi>);
}

TEST_CASE("The product of a cell's mass is that of its particles") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> d(static_cast<std::size_t>(node_doubles * lattice_points.nodes()));
  for (double& x : d) x = 2 * unit(random) - 1;
  std::vector<double> moments(static_cast<std::size_t>(cell_mass::doubles * cell_mass::cells), 0.0);
  struct Product {
    double value[8][3] = {};
  };
  std::vector<Product> expected(static_cast<std::size_t>(cell_mass::cells));
  cell_mass::Sums sums;
  for (int block = 0; block < 100; ++block) {
    LinearPlace place;
    double m[block_lanes];
    for (int i = 0; i < block_lanes; ++i) {
      // Often the same cell again; particles on its faces, edges and corners too.
      const int cell = static_cast<int>(random() % (block % 3 == 0 ? 64 : 4));
      place.node[i] = cell_mass::lowest_point(cell);
      for (auto& f : place.f) f[i] = random() % 5 == 0 ? static_cast<double>(random() % 2) : unit(random);
      m[i] = 0.5 + unit(random);
      double w[8], seen[3] = {};
      for (int n = 0; n < 8; ++n) {
        w[n] = 1;
        for (int a = 0; a < 3; ++a) w[n] *= (n >> a & 1) != 0 ? place.f[a][i] : 1 - place.f[a][i];
        for (int a = 0; a < 3; ++a)
          seen[a] += w[n] * d[static_cast<std::size_t>(node_doubles * (place.node[i] + corner_node(n)) + a)];
      }
      for (int n = 0; n < 8; ++n)
        for (int a = 0; a < 3; ++a)
          expected[static_cast<std::size_t>(cell)].value[n][a] += m[i] * w[n] * seen[a];
      sums.add(place, i, m[i], moments.data());
    }
  }
  sums.flush(moments.data());
  int used = 0;
  for (int c = 0; c < cell_mass::cells; ++c) {
    const double* of_cell = moments.data() + cell_mass::doubles * c;
    used += of_cell[cell_mass::in_use] != 0;
    linear::Nodes p[3] = {0.0, 0.0, 0.0};
    cell_mass::multiply(of_cell, d.data(), cell_mass::lowest_point(c), p[0], p[1], p[2]);
    for (int n = 0; n < 8; ++n)
      for (int a = 0; a < 3; ++a)
        CHECK(p[a][n] == Approx(expected[static_cast<std::size_t>(c)].value[n][a]).margin(1e-12));
  }
  CHECK(used > 50);
}
