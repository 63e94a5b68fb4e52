// Graded layers, rings and shells.
#include <map>

#include <catch2/catch.hpp>

#include "core/discretise/grading.hpp"
#include "tests/core/discretise/support.hpp"

using namespace mpm::core;
using namespace mpm::core::testing;

namespace {

CylinderGeometry polar(CylinderGeometry geometry) {
  geometry.layout = Layout::polar;
  return geometry;
}

SphereGeometry polar(SphereGeometry geometry) {
  geometry.layout = Layout::polar;
  return geometry;
}

}  // namespace

TEST_CASE("Grading: thickness from bottom to top by one factor, height met within half a layer",
          "[discretise]") {
  for (const auto& [bottom, top, height] : std::vector<Position>{
           {0.1, 0.4, 10}, {0.4, 0.1, 10}, {0.1, 0.1001, 10}, {1, 9, 20}, {1, 1 + 1e-9, 7}}) {
    INFO(bottom << ' ' << top << ' ' << height);
    const Grading grading(bottom, top, height);
    const double n = grading.layers();
    CHECK(n == std::floor(n));
    CHECK(grading.thickness(0) == Approx(bottom).epsilon(1e-14));
    CHECK(grading.thickness(n - 1) == Approx(top).epsilon(1e-13));
    CHECK(grading.thickness(3) / grading.thickness(2) ==
          Approx(grading.thickness(1) / bottom).epsilon(1e-13));
    CHECK(grading.lower(0) == 0);
    CHECK(grading.lower(4) - grading.lower(3) == Approx(grading.thickness(3)).epsilon(1e-6));
    CHECK(std::abs(grading.lower(n) - height) <= std::max(bottom, top) / 2);
  }
}

TEST_CASE("Grading: the uniform case is that of equal layers, and joins the graded one", "[discretise]") {
  CHECK(Grading(0.38, 0.38, 25.4).layers() == 67);
  CHECK(Grading(0.38, 0.38, 25.4).lower(67) == 0.38 * 67);
  CHECK(Grading(0.5, 0.5, 0.1).layers() == 1);
  const Grading close(0.5, 0.5 * (1 + 1e-8), 25);
  CHECK(close.layers() == 50);
  CHECK(close.lower(50) == Approx(25).epsilon(1e-7));
  // Lower than one layer: a single one.
  CHECK(Grading(1, 4, 3).layers() == 1);
  CHECK(Grading(1, 4, 3).thickness(0) == 2);
}

TEST_CASE("graded cylinder: each layer a lattice of its own spacing", "[discretise]") {
  CylinderGeometry bar = cylinder(0.05, 1, 3);
  bar.top_spacing = 0.2;
  bar.base_centre = {0, 0, 5};
  const Grading grading(0.05, 0.2, 3);
  std::map<double, Seeds> layers;
  for (const Seed& seed : all(bar)) layers[seed.position[2]].push_back(seed);
  REQUIRE(static_cast<double>(layers.size()) == grading.layers());
  double k = 0;
  for (const auto& [z, seeds] : layers) {
    const double h = grading.thickness(k);
    CHECK(z == Approx(5 + grading.lower(k) + h / 2).epsilon(1e-14));
    CHECK(seeds.front().volume == Approx(h * h * h).epsilon(1e-14));
    // Counting lattice points in a circle of 5 to 20 spacings errs by less than a tenth.
    CHECK(static_cast<double>(seeds.size()) * h * h == Approx(pi).epsilon(0.1));
    const double step = seeds.front().position[0] / h + 0.5;
    CHECK(step == Approx(std::round(step)).margin(1e-12));
    ++k;
  }
}

TEST_CASE("rings: cell volumes add up to the frustum's volume", "[discretise]") {
  for (const double angle : {360.0, 90.0, 133.0})
    for (const double top_spacing : {0.1, 0.23}) {
      INFO(angle << ' ' << top_spacing);
      CylinderGeometry frustum = polar(cylinder(0.1, 1, 2.57));
      frustum.top_spacing = top_spacing;
      frustum.bottom_inner_radius = 0.3;
      frustum.top_outer_radius = 2.1;
      frustum.angle = angle;
      const double outer = pi / 3 * 2.57 * (1 + 2.1 + 2.1 * 2.1);
      const double inner = pi / 3 * 2.57 * 0.09;
      // 1e4 sums of numbers to 1e-16, and volumes of rings as differences.
      CHECK(volume(all(frustum)) == Approx((outer - inner) * angle / 360).epsilon(1e-12));
    }
  // Flat and steep, where the widest layer is not that of the most rings.
  CylinderGeometry flat = polar(cylinder(0.1, 5, 0.3));
  flat.top_outer_radius = 0;
  CHECK(volume(all(flat)) == Approx(pi / 3 * 0.3 * 25).epsilon(1e-12));
  OgiveGeometry nose = ogive(0.3, 0.05);
  nose.layout = Layout::polar;
  const double c = 4;  // radius 6, base 2
  const double h = std::sqrt(36 - c * c);
  const double exact = pi * (36 * h - h * h * h / 3 - c * (h * c + 36 * std::asin(h / 6)) + c * c * h);
  CHECK(volume(all(nose)) == Approx(exact).epsilon(1e-12));
}

TEST_CASE("rings: spacing close to dp, mass where the solid's is", "[discretise]") {
  const Seeds seeds = all(polar(cylinder(0.1, 1, 1)));
  double smallest = 1;
  double largest = 0;
  double second_moment = 0;
  for (const Seed& seed : seeds) {
    smallest = std::min(smallest, seed.volume);
    largest = std::max(largest, seed.volume);
    second_moment +=
        seed.volume * (seed.position[0] * seed.position[0] + seed.position[1] * seed.position[1]);
  }
  // Whole numbers of arcs: the innermost ring has 4 cells over pi dp^2.
  CHECK(smallest > 0.7e-3);
  CHECK(largest < 1.3e-3);
  CHECK(second_moment == Approx(pi / 2).epsilon(0.01));  // dp^2
}

TEST_CASE("shells: cell volumes add up to the ball's volume, spacing close to dp", "[discretise]") {
  SphereGeometry hollow = polar(ball(0.1, 1.03, 0.4));
  CHECK(volume(all(hollow)) == Approx(4 * pi / 3 * (1.03 * 1.03 * 1.03 - 0.064)).epsilon(1e-12));
  hollow.angle = 77;
  CHECK(volume(all(hollow)) == Approx(4 * pi / 3 * (1.03 * 1.03 * 1.03 - 0.064) * 77 / 360).epsilon(1e-12));
  hollow.angle = 90;
  hollow.upper_half = true;
  CHECK(volume(all(hollow)) == Approx(pi / 6 * (1.03 * 1.03 * 1.03 - 0.064)).epsilon(1e-12));
  double smallest = 1;
  double largest = 0;
  double second_moment = 0;
  for (const Seed& seed : all(polar(ball(0.1, 1)))) {
    smallest = std::min(smallest, seed.volume);
    largest = std::max(largest, seed.volume);
    second_moment += seed.volume * dot(seed.position, seed.position);
  }
  // Whole numbers of arcs and bands: 4 cells at a pole, 8 in the innermost shell.
  CHECK(smallest > 0.4e-3);
  CHECK(largest < 1.6e-3);
  CHECK(second_moment == Approx(4 * pi / 5).epsilon(0.01));
}

TEST_CASE("rings and shells: mirror images and parts to the last bit", "[discretise]") {
  const Seeds rings = all(polar(cylinder(0.07, 0.77, 1.4)));
  const Seeds shells = all(polar(ball(0.07, 0.77, 0.1)));
  for (const Seeds* seeds : {&rings, &shells})
    for (const auto map : {mirror_x, mirror_y, swap_xy}) CHECK(sorted(*seeds) == sorted(*seeds, map));
  CHECK(sorted(shells) == sorted(shells, mirror_z));
  SphereGeometry octant = polar(ball(0.07, 0.77, 0.1));
  octant.angle = 90;
  octant.upper_half = true;
  CHECK(is_part(all(octant), shells, [](const Position& p) { return p[0] > 0 && p[1] > 0 && p[2] > 0; }));
  CylinderGeometry half = polar(cylinder(0.07, 0.77, 1.4));
  half.angle = 180;
  CHECK(is_part(all(half), rings, [](const Position& p) { return p[1] > 0; }));
}

TEST_CASE("Ogive: the lattice lies within the arc", "[discretise]") {
  const OgiveGeometry nose = ogive(0.1, 0.1);
  const Seeds seeds = all(nose);
  double highest = 0;
  bool within = true;
  for (const Seed& seed : seeds) {
    const auto [x, y, z] = seed.position;
    highest = std::max(highest, z);
    const double from_arc_centre =
        std::hypot(z, std::hypot(x, y) + 4);  // the arc's centre is 4 beyond the axis
    within = within && from_arc_centre <= 6 * (1 + 1e-9);
  }
  CHECK(within);
  CHECK(highest > std::sqrt(20.0) - 0.2);  // the tip, where less than a spacing is wide
  CHECK(highest < std::sqrt(20.0));
}
