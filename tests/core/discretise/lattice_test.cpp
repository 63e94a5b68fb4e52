// Orthogonal lattices: counts known from counting by hand, volumes that converge, and exact symmetry.
#include <catch2/catch.hpp>

#include "tests/core/discretise/support.hpp"

using namespace mpm::core;
using namespace mpm::core::testing;

namespace {

/// Points (i + 1/2, j + 1/2[, k + 1/2]) within radius, all whole-number arithmetic.
int brute_force(int diameter, int inner_diameter, bool three_dimensions) {
  int count = 0;
  for (int a = -201; a <= 201; a += 2)
    for (int b = -201; b <= 201; b += 2) {
      const int plane = a * a + b * b;
      const int first = three_dimensions ? -201 : 0;
      const int last = three_dimensions ? 201 : 0;
      for (int c = first; c <= last; c += 2)
        if (plane + c * c <= diameter * diameter && plane + c * c >= inner_diameter * inner_diameter) ++count;
    }
  return count;
}

}  // namespace

TEST_CASE("Block: one particle per dp-cell, at its centre", "[discretise]") {
  const Seeds seeds = all(block(0.25, {0, 0, 0}, {5, 10, 20}));
  REQUIRE(seeds.size() == 20 * 40 * 80);
  CHECK(seeds.front().position == Position{0.125, 0.125, 0.125});
  CHECK(seeds[1].position == Position{0.375, 0.125, 0.125});
  CHECK(seeds.back().position == Position{4.875, 9.875, 19.875});
  CHECK(volume(seeds) == 1000);  // dp^3 = 2^-6: every sum is exact
  CHECK(mass(seeds) == 1000 * density);
}

TEST_CASE("Block: sizes that are no multiple of dp", "[discretise]") {
  // The nearest count at the given spacing; 7 / 0.1 is not whole in binary and must give 70.
  const auto from = source(block(0.1, {0, 0, 0}, {7, 0.66, 0.001}));
  const Seeds seeds = all(*from);
  CHECK(seeds.size() == 70 * 7 * 1);
  CHECK(seeds.back().position[1] == Approx(0.65).epsilon(1e-15));
  CHECK(volume_error(*from) == Approx(7 * 0.7 * 0.1 / (7 * 0.66 * 0.001) - 1).epsilon(1e-12));
}

TEST_CASE("Sphere: the count is that of the lattice points within the radii", "[discretise]") {
  CHECK(all(ball(0.25, 5)).size() == static_cast<std::size_t>(brute_force(40, 0, true)));
  CHECK(all(ball(0.1, 2, 0.7)).size() == static_cast<std::size_t>(brute_force(40, 14, true)));
  // Particles exactly on the surface: (1, 1, 1) half spacings lie at sqrt(3), (3, 3, 1) at sqrt(19).
  CHECK(all(ball(0.2, 0.1 * std::sqrt(19.0))).size() == 8 + 24 + 24);
  CHECK(all(ball(0.2, 0.1 * std::sqrt(19.0), 0.1 * std::sqrt(19.0) * 0.9999)).size() == 24);
}

TEST_CASE("the count does not depend on the user's unit of length", "[discretise]") {
  // The ball's radius is sqrt(75) half spacings, so that 56 particles stand on its surface.
  for (const double unit : {1.0, 1e-3, 1e3, 25.4, 1e-6}) {
    INFO(unit);
    CHECK(all(ball(0.1 * unit, 0.25 * std::sqrt(3.0) * unit)).size() == 360);
    CHECK(all(cylinder(0.38 * unit, 3.8 * unit, 25.4 * unit)).size() == 316 * 67);
    CHECK(all(block(0.1 * unit, {0, 0, 0}, {0.7 * unit, unit, unit})).size() == 700);
  }
}

TEST_CASE("Cylinder: layers at (k + 1/2) dp, points at (i + 1/2) dp", "[discretise]") {
  CylinderGeometry bar = cylinder(0.5, 5, 25.5);
  const Seeds seeds = all(bar);
  const auto per_layer = static_cast<std::size_t>(brute_force(20, 0, false));
  REQUIRE(seeds.size() == 51 * per_layer);
  for (std::size_t i = 0; i < seeds.size(); i += per_layer)
    CHECK(seeds[i].position[2] == 0.25 + 0.5 * static_cast<double>(i / per_layer));
  for (const Seed& seed : seeds)
    if (seed.position[0] * 2 + 0.5 != std::floor(seed.position[0] * 2 + 0.5)) FAIL("off the lattice");
  bar.bottom_inner_radius = bar.top_inner_radius = 2;
  CHECK(all(bar).size() == 51 * static_cast<std::size_t>(brute_force(20, 8, false)));
}

TEST_CASE("Cylinder: a cone's radii are those at the layers' middles", "[discretise]") {
  CylinderGeometry cone = cylinder(0.1, 2, 2);
  cone.top_outer_radius = 0;
  std::size_t expected = 0;
  for (int k = 0; k < 20; ++k) {
    const double half_spacings = 40 - (2 * k + 1);  // r = 2 - z
    for (int a = -39; a <= 39; a += 2)
      for (int b = -39; b <= 39; b += 2) expected += a * a + b * b <= half_spacings * half_spacings ? 1U : 0U;
  }
  CHECK(all(cone).size() == expected);
}

TEST_CASE("orthogonal lattices converge to the solid's volume", "[discretise]") {
  // The error is that of counting lattice points in a round region: it fluctuates, within the share of the
  // particles that touch the surface, and falls at least as fast as they do, like dp. (Measured: about
  // dp^1.5.)
  SphereGeometry hollow = ball(1, 1, 0.5);
  CylinderGeometry cone = cylinder(1, 1, 2);
  cone.top_outer_radius = 0.5;
  CylinderGeometry wedge = cylinder(1, 1, 2);
  wedge.angle = 77;
  for (const double dp : {0.1, 0.05, 0.025, 0.0125}) {
    INFO(dp);
    hollow.spacing = dp;
    cone.bottom_spacing = cone.top_spacing = dp;
    wedge.bottom_spacing = wedge.top_spacing = dp;
    OgiveGeometry nose = ogive(2 * dp, 2 * dp);
    CHECK(std::abs(volume_error(*source(ball(dp, 1)))) < 0.2 * dp);
    CHECK(std::abs(volume_error(*source(hollow))) < 0.2 * dp);
    CHECK(std::abs(volume_error(*source(cone))) < 0.2 * dp);
    CHECK(std::abs(volume_error(*source(wedge))) < 0.5 * dp);
    CHECK(std::abs(volume_error(*source(nose))) < 0.5 * dp);
  }
}

TEST_CASE("mirror images agree to the last bit", "[discretise]") {
  // Spacings and sizes that binary numbers cannot hold.
  CylinderGeometry bar = cylinder(0.1, 0.77, 1.4);
  bar.base_centre[2] = -0.7;
  CylinderGeometry graded = cylinder(0.03, 0.77, 1.4);
  graded.top_spacing = 0.1;
  for (const Geometry& geometry :
       std::vector<Geometry>{ball(0.1, 0.77), bar, block(0.1, {-0.7, -0.7, -0.7}, {1.4, 1.4, 1.4})}) {
    const Seeds seeds = all(geometry);
    for (const auto map : {mirror_x, mirror_y, mirror_z, swap_xy}) CHECK(sorted(seeds) == sorted(seeds, map));
  }
  const Seeds tapered = all(graded);
  for (const auto map : {mirror_x, mirror_y, swap_xy}) CHECK(sorted(tapered) == sorted(tapered, map));
}

TEST_CASE("parts of a solid are its particles there, to the last bit", "[discretise]") {
  const SphereGeometry whole = ball(0.1, 0.77, 0.2);
  const Seeds seeds = all(whole);
  const auto swept = [&](double angle, bool half) {
    SphereGeometry part = whole;
    part.angle = angle;
    part.upper_half = half;
    return all(part);
  };
  CHECK(is_part(swept(90, false), seeds, [](const Position& p) { return p[0] > 0 && p[1] > 0; }));
  CHECK(is_part(swept(180, false), seeds, [](const Position& p) { return p[1] > 0; }));
  CHECK(is_part(swept(270, false), seeds, [](const Position& p) { return p[0] < 0 || p[1] > 0; }));
  CHECK(is_part(swept(90, true), seeds, [](const Position& p) { return p[0] > 0 && p[1] > 0 && p[2] > 0; }));
  CHECK(is_part(swept(45, false), seeds, [](const Position& p) { return p[1] > 0 && p[0] >= p[1]; }));
  CHECK(is_part(swept(135, false), seeds, [](const Position& p) { return p[1] > 0 && p[0] >= -p[1]; }));
  CHECK(is_part(swept(225, false), seeds, [](const Position& p) { return p[1] > 0 || p[0] <= p[1]; }));
  for (const double angle : {10.0, 77.0, 123.0, 199.0, 301.0}) {
    INFO(angle);
    CHECK(is_part(swept(angle, false), seeds, [&](const Position& p) {
      const double azimuth = std::atan2(p[1], p[0]) * 180 / pi;
      return (azimuth < 0 ? azimuth + 360 : azimuth) <= angle;
    }));
  }
  const Seeds full_block = all(block(0.1, {-0.7, -0.7, -0.7}, {1.4, 1.4, 1.4}));
  CHECK(is_part(all(block(0.1, {0, 0, 0}, {0.7, 0.7, 0.7})), full_block,
                [](const Position& p) { return p[0] > 0 && p[1] > 0 && p[2] > 0; }));
}

TEST_CASE("work planes along the axes permute coordinates and add their origin, nothing else",
          "[discretise]") {
  WorkPlane plane;  // local x, y, z along global -y, z, -x
  plane.x_axis = {0, -1, 0};
  plane.y_axis = {0, 0, 1};
  plane.z_axis = {-1, 0, 0};
  CylinderGeometry bar = cylinder(0.1, 0.77, 1.37);
  bar.base_centre = {0.1, 0.2, 0.3};
  const Seeds local = all(bar);
  for (const Position& origin : {Position{0, 0, 0}, Position{0.3, 100.1, -7.7}}) {
    plane.origin = origin;
    const Seeds turned = all(*source(bar, plane));
    REQUIRE(turned.size() == local.size());
    bool exact = true;
    for (std::size_t i = 0; i < local.size(); ++i) {
      const Position& p = local[i].position;
      exact = exact && turned[i].position == Position{origin[0] - p[2], origin[1] - p[0], origin[2] + p[1]};
    }
    CHECK(exact);
  }
}

TEST_CASE("a turned work plane keeps distances and the axis' direction", "[discretise]") {
  WorkPlane plane;
  plane.origin = {1, 2, 3};
  plane.z_axis = {3 / std::sqrt(11.0), 1 / std::sqrt(11.0), 1 / std::sqrt(11.0)};  // the manual's example
  plane.x_axis = {0, -1 / std::sqrt(2.0), 1 / std::sqrt(2.0)};
  plane.y_axis = {2 / std::sqrt(22.0), -3 / std::sqrt(22.0), -3 / std::sqrt(22.0)};
  const CylinderGeometry bar = cylinder(0.25, 1, 4);
  const Seeds local = all(bar);
  const Seeds global = all(*source(bar, plane));
  for (std::size_t i = 0; i < local.size(); i += 97) {
    const Position& p = local[i].position;
    Position q = global[i].position;
    for (std::size_t d = 0; d < 3; ++d) q[d] -= plane.origin[d];
    const auto along = [&](const Position& axis) { return q[0] * axis[0] + q[1] * axis[1] + q[2] * axis[2]; };
    CHECK(along(plane.x_axis) == Approx(p[0]).margin(1e-14));  // round-off of numbers below 8
    CHECK(along(plane.y_axis) == Approx(p[1]).margin(1e-14));
    CHECK(along(plane.z_axis) == Approx(p[2]).margin(1e-14));
  }
}
