// What every kind of source owes its callers: the same bits in any number of shares, unique identities, seeds
// within the bounds, masses that follow the density, an honest estimate, and the volume of the shape.
#include <cstring>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "core/discretise/make_source.hpp"
#include "tests/core/discretise/support.hpp"

using namespace mpm::core;
using namespace mpm::core::testing;

namespace {

struct Case {
  std::string name;
  Geometry geometry;
  double estimate_error;  ///< relative; particles on the surface over particles within
  bool fills;             ///< the particles' cells are the shape, none of them cut
};

std::vector<Case> cases() {
  SphereGeometry shells = ball(0.1, 1.03, 0.3);
  shells.layout = Layout::polar;
  SphereGeometry wedge = ball(0.07, 1, 0.2);
  wedge.angle = 200;
  CylinderGeometry rings = cylinder(0.1, 1, 2.55);
  rings.top_spacing = 0.2;
  rings.top_outer_radius = 1.4;
  rings.bottom_inner_radius = 0.5;
  rings.angle = 133;
  rings.layout = Layout::polar;
  CylinderGeometry graded = cylinder(0.05, 1, 3);
  graded.top_spacing = 0.2;
  graded.bottom_inner_radius = 0.3;
  graded.top_inner_radius = 0.4;
  OgiveGeometry ogive_rings = ogive(0.3, 0.1);
  ogive_rings.layout = Layout::polar;
  PointGeometry points;
  for (int i = 0; i < 10000; ++i) points.points.push_back({1.0 + i, {0.1 * i, -0.2 * i, 0.3}});
  return {{"block", block(0.1, {1, 2, 3}, {1, 2, 3}), 0, true},
          {"plate", block(0.001, {0, 0, 0}, {10, 0.001, 0.003}), 0, true},
          {"ball", ball(0.07, 1), 0.02, false},
          {"wedge of a hollow ball", wedge, 0.02, false},
          {"ball in shells", shells, 0.1, true},
          {"cylinder", cylinder(0.1, 1, 2.55), 0.05, false},
          {"graded tube", graded, 0.05, false},
          {"frustum in rings", rings, 0.1, true},
          {"ogive", ogive(0.2, 0.1), 0.05, false},
          {"ogive in rings", ogive_rings, 0.1, true},
          {"points", points, 0, true}};
}

/// The units cut into `shares` stretches, taken from the last to the first.
Seeds in_shares(const SeedSource& from, std::uint64_t shares) {
  Seeds seeds;
  const std::uint64_t units = from.units();
  for (std::uint64_t r = shares; r-- > 0;) from.generate(r * units / shares, (r + 1) * units / shares, seeds);
  std::sort(seeds.begin(), seeds.end(), [](const Seed& a, const Seed& b) { return a.identity < b.identity; });
  return seeds;
}

bool same_bits(const Seeds& a, const Seeds& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Seed)) == 0;
}

}  // namespace

TEST_CASE("every source: shares, identities, bounds, mass, estimate", "[discretise]") {
  WorkPlane tilted;  // axes of a 3-4-5 triangle
  tilted.origin = {10, -20, 30};
  tilted.x_axis = {0.6, 0.8, 0};
  tilted.y_axis = {0, 0, 1};
  tilted.z_axis = {0.8, -0.6, 0};
  for (const Case& c : cases()) {
    INFO(c.name);
    const auto from = source(c.geometry, tilted);
    const Seeds whole = all(*from);
    REQUIRE(whole.size() > 1000);
    for (const std::uint64_t shares : {1, 3, 7}) CHECK(same_bits(in_shares(*from, shares), whole));

    std::set<std::uint64_t> identities;
    bool bounded = true;
    bool dense = true;
    const auto [lower, upper] = from->bounds();
    for (const Seed& seed : whole) {
      identities.insert(seed.identity);
      // The box and the seeds are turned separately: a few units in the last place of 40.
      for (std::size_t d = 0; d < 3; ++d)
        bounded = bounded && seed.position[d] >= lower[d] - 1e-13 && seed.position[d] <= upper[d] + 1e-13;
      dense = dense && std::abs(seed.mass - density * seed.volume) <= 1e-15 * seed.mass;
    }
    CHECK(identities.size() == whole.size());
    CHECK(*identities.rbegin() < from->identities());
    CHECK(bounded);
    CHECK(dense);

    const auto particles = static_cast<double>(whole.size());
    CHECK(std::abs(from->expected_particles() - particles) <= c.estimate_error * particles);
    // Round-off of sums of some 1e5 terms.
    CHECK(std::abs(volume_error(*from)) <= (c.fills ? 1e-12 : c.estimate_error));
  }
}

TEST_CASE("units are small and follow from the body alone", "[discretise]") {
  const auto from = source(block(0.01, {0, 0, 0}, {1, 1, 1}));
  CHECK(from->units() == 245);  // 10^6 candidates in 4096s
  CHECK(from->identities() == 1000000);
  Seeds seeds;
  from->generate(244, 245, seeds);
  CHECK(seeds.size() == 1000000 - 244 * 4096);
  seeds.clear();
  from->generate(245, 300, seeds);
  CHECK(seeds.empty());
}

TEST_CASE("absurd numbers of particles are answered without making them", "[discretise]") {
  PointGeometry one;
  one.points.push_back({1, {0, 0, 0}});
  SphereGeometry shells = ball(1e-9, 1);
  shells.layout = Layout::polar;
  CylinderGeometry rings = cylinder(1e-9, 1, 1);
  rings.layout = Layout::polar;
  CylinderGeometry graded = cylinder(1e-9, 1, 1);
  graded.top_spacing = 2e-9;
  const std::vector<std::pair<Geometry, double>> absurd{{block(1e-9, {0, 0, 0}, {1, 1, 1}), 1e27},
                                                        {ball(1e-9, 1), 4 * pi / 3 * 1e27},
                                                        {shells, 4 * pi / 3 * 1e27},
                                                        {cylinder(1e-9, 1, 1), pi * 1e27},
                                                        {rings, pi * 1e27},
                                                        // integral of pi/h^3 over the height
                                                        {graded, pi * 3 / 8 * 1e27},
                                                        {ball(1e-100, 1e300), -1},
                                                        {block(1e-100, {0, 0, 0}, {1, 1, 1}), -1}};
  for (const auto& [geometry, expected] : absurd) {
    INFO(geometry.index());
    const auto from = make_unchecked_source({}, body(geometry));
    CHECK(from->identities() >= identity_limit);
    CHECK(from->units() < identity_limit);
    Seeds seeds;
    CHECK_THROWS_AS(from->generate(0, 1, seeds), std::length_error);
    CHECK(seeds.capacity() == 0);
    // The estimate samples 512 groups of layers.
    if (expected > 0) CHECK(from->expected_particles() == Approx(expected).epsilon(1e-3));
    if (expected < 0) CHECK(from->expected_particles() > 1e100);
  }
}

TEST_CASE("a spacing whose particles would have no volume or no mass is refused", "[discretise]") {
  for (const Geometry& geometry :
       std::vector<Geometry>{block(1e-103, {0, 0, 0}, {1, 1, 1}), block(1e103, {0, 0, 0}, {1e103, 1, 1}),
                             ball(1e-300, 1), cylinder(1e-300, 1, 1)})
    CHECK_THROWS_AS(source(geometry), InputErrors);
}

TEST_CASE("a large body is numbered and estimated at once, and any unit of it is made at once",
          "[discretise]") {
  const auto from = source(ball(0.001, 10));  // 4.2e12 particles
  CHECK(from->identities() == 8000000000000);
  Seeds seeds;
  const std::uint64_t centre =
      from->units() / 2 + 48828;  // a layer has 97656 units: the middle of the middle one
  from->generate(centre, centre + 2, seeds);
  CHECK(seeds.size() == 2 * 4096);
}
