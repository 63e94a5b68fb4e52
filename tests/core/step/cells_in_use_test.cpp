// Which cells are in use, against a count over all particles; and what DDMP makes of it at a symmetry face.
#include "core/step/cells_in_use.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "tests/core/step/case.hpp"

using namespace mpm::tests;
using mpm::core::CellsAround;
using mpm::core::GridGeometry;
using mpm::core::Slot;

namespace {

using Cell = std::array<std::int64_t, 3>;

/// The cell whose image a cell beyond a wall is; itself elsewhere, and beyond free faces (boundary 0).
Cell image(Cell cell, const GridGeometry& g, int boundary) {
  for (std::size_t a = 0; a < 3 && boundary != 0; ++a) {
    if (cell[a] == -1) cell[a] = 0;
    if (cell[a] == g.cells[a]) cell[a] = g.cells[a] - 1;
  }
  return cell;
}

/// f(the cells around a brick, a cell in them, its place in the grid) for all of them.
template <class F>
void for_each_cell_around(const SmallRun& run, F f) {
  for (Slot s = 0; s < run.model.grid->owned(); ++s) {
    const mpm::core::BrickCoord b = run.model.grid->brick(s).coord;
    for (int n = 0; n < 216; ++n) {
      const std::array<int, 3> at{n % 6 - 1, n / 6 % 6 - 1, n / 36 - 1};
      f(*run.model.grid->cells_in_use(s), at, Cell{4 * b.x + at[0], 4 * b.y + at[1], 4 * b.z + at[2]});
    }
  }
}

/// The block of the oracle's tests in the corner of the lower y and the upper x and z, some particles on the
/// upper faces of the grid.
ReferenceCase in_a_corner(int boundary) {
  ReferenceCase c = tumbling_block();
  c.shape = ReferenceShape::ddmp;
  c.boundary.fill(boundary);
  for (std::size_t n = 0; n < c.particles.size(); ++n) {
    Vector& x = c.particles[n].x;
    x = {x[0] + 5.7, x[1] - 5.4, x[2] + 4.7};
    if (n % 50 == 0) x[0] = c.origin[0] + c.cell[0] * c.cells[0];
  }
  return c;
}

}  // namespace

TEST_CASE("A brick knows the cells in use in it and around it, and their images beyond walls") {
  for (const int boundary : {0, 1, 2, 3, 4}) {
    CAPTURE(boundary);
    const ReferenceCase c = in_a_corner(boundary);
    SmallRun run(c);
    const GridGeometry& g = run.model.grid->geometry();
    std::set<Cell> in_use;
    for (const ReferenceParticle& p : c.particles)
      in_use.insert({g.cell_index(p.x[0], 0), g.cell_index(p.x[1], 1), g.cell_index(p.x[2], 2)});

    const auto cells = mpm::core::make_cells_in_use(run.model, run.solo.halo);
    REQUIRE(cells != nullptr);
    cells->find();
    cells->finish_exchange();
    int wrong = 0, beyond = 0;
    for_each_cell_around(run, [&](const CellsAround& around, const auto& at, const Cell& cell) {
      const Cell inside = boundary == 3 ? cell : image(cell, g, boundary);
      const bool has = around.has(at[0], at[1], at[2]);
      wrong += has != in_use.contains(inside) ? 1 : 0;
      beyond += inside != cell && has ? 1 : 0;
    });
    for (Slot s = 0; s < run.model.grid->owned(); ++s) {
      const CellsAround& around = *run.model.grid->cells_in_use(s);
      CHECK(around.weight_beside(2, 2, 2) ==
            around.has(1, 1, 1) + around.has(2, 1, 1) + around.has(1, 2, 1) + around.has(2, 2, 1) +
                around.has(1, 1, 2) + around.has(2, 1, 2) + around.has(1, 2, 2) + around.has(2, 2, 2));
    }
    CHECK(wrong == 0);
    CHECK((beyond > 0) == (boundary != 0 && boundary != 3));
  }
}

TEST_CASE(
    "Cells of two materials weigh as much as their densest particles, those beyond walls as their images") {
  for (const int boundary : {0, 2}) {
    CAPTURE(boundary);
    ReferenceCase c = in_a_corner(boundary);
    c.weigh_cells = true;
    const std::size_t half = c.particles.size() / 2;
    for (std::size_t n = half; n < c.particles.size(); ++n)
      c.particles[n].m *= n % 3 == 0 ? 0.03 : 0.001 * static_cast<double>(n % 7);
    SmallRun run(c, half);
    const GridGeometry& g = run.model.grid->geometry();
    std::map<Cell, double> weight;
    for (const ReferenceParticle& p : c.particles) {
      double& w = weight[{g.cell_index(p.x[0], 0), g.cell_index(p.x[1], 1), g.cell_index(p.x[2], 2)}];
      w = std::max({w, std::min(c.material.density / 10, 4 * p.m / p.V), std::numeric_limits<double>::min()});
    }
    const auto cells = mpm::core::make_cells_in_use(run.model, run.solo.halo);
    cells->find();
    cells->finish_exchange();
    int wrong = 0, light = 0;
    for_each_cell_around(run, [&](const CellsAround& around, const auto& at, const Cell& cell) {
      const auto found = weight.find(image(cell, g, boundary));
      const double expected = found == weight.end() ? 0 : around.weights == nullptr ? 1 : found->second;
      wrong += around.weight(at[0], at[1], at[2]) != expected ? 1 : 0;
      light += expected > 0 && expected < 0.05 * c.material.density ? 1 : 0;
    });
    CHECK(wrong == 0);
    CHECK(light > 0);
  }
}

TEST_CASE("Cells beside much lighter ones are found") {
  for (int each = 0; each < 8; ++each) {
    const int boundary = each % 2 == 0 ? 0 : 2;
    ReferenceCase c = in_a_corner(boundary);
    c.shape = each / 2 % 2 == 0 ? ReferenceShape::linear : ReferenceShape::ddmp;
    c.scheme = each / 4 == 0 ? ReferenceScheme::musl : ReferenceScheme::usl;
    CAPTURE(boundary, c.shape, c.scheme);
    c.light_from = c.particles.size() / 2;
    for (std::size_t n = 0; n < c.particles.size(); ++n)  // which leaves the densities of reference
      if (n % 97 == 5) c.particles[n].m *= 0.01;
    SmallRun run(c, c.light_from);
    const GridGeometry& g = run.model.grid->geometry();
    std::map<Cell, std::pair<double, double>> densities;  // least and largest
    for (std::size_t n = 0; n < c.particles.size(); ++n) {
      const ReferenceParticle& p = c.particles[n];
      const double density = n < c.light_from ? c.material.density : c.material.density / 1000;
      const Cell cell{g.cell_index(p.x[0], 0), g.cell_index(p.x[1], 1), g.cell_index(p.x[2], 2)};
      auto& [least, largest] = densities.try_emplace(cell, density, density).first->second;
      least = std::min(least, density);
      largest = std::max(largest, density);
    }
    const auto cells = mpm::core::make_cells_in_use(run.model, run.solo.halo);
    REQUIRE(cells != nullptr);
    cells->find();
    cells->finish_exchange();
    int wrong = 0, beside = 0;
    for (Slot s = 0; s < run.model.grid->owned(); ++s) {
      const mpm::core::BrickCoord b = run.model.grid->brick(s).coord;
      for (int n = 0; n < 64; ++n) {
        const Cell cell{4 * b.x + n % 4, 4 * b.y + n / 4 % 4, 4 * b.z + n / 16};
        const auto own = densities.find(cell);
        bool expected = false;
        for (int d = 0; d < 27 && own != densities.end(); ++d) {
          const auto at = densities.find(
              image({cell[0] + d % 3 - 1, cell[1] + d / 3 % 3 - 1, cell[2] + d / 9 - 1}, g, boundary));
          const double empty =
              c.scheme == ReferenceScheme::usl ? c.material.density / 1000 : own->second.second;
          expected |= own->second.second > 10 * (at == densities.end() ? empty : at->second.first);
        }
        const bool found = (run.model.grid->cells_in_use(s)->beside_lighter >> n & 1) != 0;
        wrong += found != expected ? 1 : 0;
        beside += expected ? 1 : 0;
      }
    }
    CHECK(wrong == 0);
    CHECK(beside > 20);
    CHECK(beside < static_cast<int>(densities.size()));
  }
}

TEST_CASE(
    "Scenes without much lighter materials in a velocity field look for no cells, with linear functions") {
  ReferenceCase c = in_a_corner(0);
  c.shape = ReferenceShape::linear;
  SmallRun alike(c, c.particles.size() / 2);
  CHECK(mpm::core::make_cells_in_use(alike.model, alike.solo.halo) == nullptr);
  c.light_from = c.particles.size() / 2;
  SmallRun apart(c, c.light_from, true);
  CHECK(mpm::core::make_cells_in_use(apart.model, apart.solo.halo) == nullptr);
  SmallRun implicit(c, c.light_from);
  implicit.scene->solution.integration = mpm::core::Integration::implicit;
  CHECK(mpm::core::make_cells_in_use(implicit.model, implicit.solo.halo) == nullptr);
}

TEST_CASE("The pass that moves the particles of a brick finds the cells that a later count finds") {
  for (const ReferenceScheme scheme :
       {ReferenceScheme::usf, ReferenceScheme::usl, ReferenceScheme::musl, ReferenceScheme::usavg}) {
    ReferenceCase c = tumbling_block();
    c.shape = ReferenceShape::ddmp;
    c.scheme = scheme;
    SmallRun run(c);
    mpm::core::BrickGrid& grid = *run.model.grid;
    int known = 0, unknown = 0, wrong = 0;
    for (int i = 0; i < 60; ++i) {
      run.step(1);
      for (Slot s = 0; s < grid.owned(); ++s) {
        if (grid.brick(s).tiles.empty()) continue;
        const std::optional<std::uint64_t> cells = grid.own_cells(s);
        ++(cells ? known : unknown);
        wrong += cells && *cells != mpm::core::find_cells(run.model, s) ? 1 : 0;
      }
    }
    CHECK(known > 0);
    CHECK(unknown > 0);  // where particles have entered a brick for the first time
    CHECK(unknown < known);
    CHECK(wrong == 0);
  }
}

TEST_CASE("A particle on the grid's upper face, which leaves no brick, is in a cell in use") {
  ReferenceCase c = in_a_corner(0);
  ReferenceParticle alone = c.particles.front();
  alone.x = {c.origin[0] + c.cell[0] * c.cells[0], c.origin[1] + 0.5 * c.cell[1],
             c.origin[2] + 0.5 * c.cell[2]};
  alone.v = {};
  c.particles.push_back(alone);
  SmallRun run(c);
  for (int i = 0; i < 5; ++i) {
    run.step(1);
    const Slot s =
        run.model.grid->find(run.model.grid->geometry().brick_at({alone.x[0], alone.x[1], alone.x[2]}));
    REQUIRE(s != mpm::core::no_slot);
    const std::optional<std::uint64_t> cells = run.model.grid->own_cells(s);
    CHECK(cells.value_or(mpm::core::find_cells(run.model, s)) == mpm::core::find_cells(run.model, s));
    CHECK(mpm::core::find_cells(run.model, s) != 0);
  }
}

TEST_CASE("Only shape functions that need cells in use have phases for them") {
  for (const ReferenceShape shape : reference_shapes) {
    ReferenceCase c = in_a_corner(0);
    c.shape = shape;
    SmallRun run(c);
    run.step(1);
    int phases = 0;
    for (const mpm::core::Phase& phase : run.stepper->phases())
      phases += phase.name.find("cells") != std::string::npos ? 1 : 0;
    CHECK(phases == (shape == ReferenceShape::ddmp ? 2 : 0));
    CHECK((run.model.grid->cells_in_use(0) != nullptr) == (shape == ReferenceShape::ddmp));
  }
}

TEST_CASE("Half a body at a symmetry face moves as half of the whole") {
  for (const ReferenceShape shape :
       {ReferenceShape::ddmp, ReferenceShape::quadratic_bspline, ReferenceShape::linear}) {
    for (const ReferenceScheme scheme :
         {ReferenceScheme::usf, ReferenceScheme::usl, ReferenceScheme::musl, ReferenceScheme::usavg}) {
      CAPTURE(static_cast<int>(shape), static_cast<int>(scheme));
      ReferenceCase half;
      half.shape = shape;
      half.scheme = scheme;
      half.material = {.density = 2, .young = 900, .poisson = 0.3};
      half.cell = {1, 1, 1};
      half.cells = {8, 9, 9};
      half.boundary[0] = 2;
      for (int n = 0; n < 6 * 5 * 6; ++n) {
        ReferenceParticle p;
        p.x = {0.27 + 0.5 * (n % 6), 3.1 + 0.5 * (n / 6 % 5), 3.3 + 0.5 * (n / 30)};
        p.v = {-2 * std::sin(p.x[0]), 0.9 * p.x[2] - 2 + p.x[0] * p.x[0], 1.2 * std::cos(p.x[1])};
        p.V = 0.125;
        p.m = 0.25;
        half.particles.push_back(p);
      }
      ReferenceCase whole = half;
      whole.origin[0] = -8;
      whole.cells[0] = 16;
      whole.boundary[0] = 0;
      for (ReferenceParticle p : half.particles) {
        p.x[0] = -p.x[0];
        p.v[0] = -p.v[0];
        whole.particles.push_back(p);
      }
      SmallRun one(half), two(whole);
      for (SmallRun* run : {&one, &two}) {
        run->scene->solution.time_step.specified = 0.01;
        run->step(40);
      }
      const auto all = two.particles();
      double worst = 0, stress = 0;
      for (const auto& [identity, p] : one.particles()) {
        const ReferenceParticle& q = all.at(identity);
        for (std::size_t a = 0; a < 3; ++a) {
          worst = std::max({worst, std::abs(p.x[a] - q.x[a]), std::abs(p.v[a] - q.v[a])});
          for (std::size_t b = 0; b < 3; ++b) worst = std::max(worst, std::abs(p.s[a][b] - q.s[a][b]) / 900);
        }
        stress = std::max(stress, std::abs(p.s[0][0]));
      }
      CHECK(worst < 1e-11);
      CHECK(stress > 10);
    }
  }
}
