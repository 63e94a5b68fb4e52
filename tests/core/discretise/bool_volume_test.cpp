// Ogives and Bool bodies against exact volumes; what Bool bodies of Bool bodies may be made of.
#include <vector>

#include <catch2/catch.hpp>

#include "core/discretise/parts.hpp"
#include "core/discretise/shape_check.hpp"
#include "tests/core/discretise/support.hpp"

using namespace mpm::core;
using namespace mpm::core::testing;
using Catch::Matchers::Contains;

namespace {

/// A scene of one component.
Scene scene_of(std::vector<BodyInput> bodies) {
  Scene scene;
  scene.components.resize(1);
  scene.components[0].bodies = std::move(bodies);
  return scene;
}

BodyInput named(std::string name, Geometry geometry, bool for_bool = true) {
  BodyInput made = body(std::move(geometry));
  made.name = std::move(name);
  made.for_bool = for_bool;
  return made;
}

BoolGeometry minus(std::size_t a, std::size_t b) { return {{0, a}, {0, b}}; }

double made_volume(const Scene& scene, std::size_t number) {
  return volume(all(*make_seed_source(scene, scene.components[0].bodies[number])));
}

struct Volumes {
  double difference = 0, intersection = 0, sum = 0;
};

/// Of the unit cube and the ball of radius 3/4 about its corner at the origin.
Volumes cube_and_ball(double dp) {
  const Scene scene = scene_of({named("cube", block(dp, {0, 0, 0}, {1, 1, 1})), named("ball", ball(dp, 0.75)),
                                named("rest", minus(0, 1)), named("both", minus(0, 2), false),
                                named("outside", minus(1, 0), false)});
  // The sum: the cube as a body of its own, and beside it what of the ball lies outside.
  const double cube = volume(all(block(dp, {0, 0, 0}, {1, 1, 1})));
  return {made_volume(scene, 2), made_volume(scene, 3), cube + made_volume(scene, 4)};
}

/// Integral of pi r^2 over z, r(z) = sqrt(R^2 - z^2) - (R - E), by Simpson's rule in the angle at the arc's
/// centre: z = R sin(angle), r = E - 2 R sin^2(angle/2).
double ogive_volume(double arc, double base) {
  const double last = 2 * std::asin(std::sqrt(base / (2 * arc)));
  const int intervals = 2000;
  double sum = 0;
  for (int i = 0; i <= intervals; ++i) {
    const double angle = last * i / intervals, half = std::sin(angle / 2), r = base - 2 * arc * half * half;
    const double weight = i == 0 || i == intervals ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * pi * r * r * arc * std::cos(angle);
  }
  return sum * last / intervals / 3;
}

/// Least-squares slope of log(error) over log(dp).
double observed_order(const std::vector<double>& dp, const std::vector<double>& error) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(dp.size());
  for (std::size_t i = 0; i < dp.size(); ++i) {
    const double a = std::log(dp[i]), b = std::log(error[i]);
    x += a / n, y += b / n, xx += a * a / n, xy += a * b / n;
  }
  return (xy - x * y) / (xx - x * x);
}

/// Particles along a unit length: three levels, and at each five numbers close to each other. The surface
/// cuts through a share of the particles that falls like the spacing dp, and the errors of the cut ones
/// scatter about zero and shift with the lattice; the largest of five falls at least like dp.
const std::vector<int> levels{12, 24, 48};
const std::vector<double> spacings{1. / 12, 1. / 24, 1. / 48};

template <class Visit>
void for_each_near(int level, Visit visit) {
  for (int k = 0; k < 5; ++k) visit(1. / (level + k * level / 12));
}

void keep_larger(double& largest, double error) { largest = std::max(largest, std::abs(error)); }

}  // namespace

TEST_CASE("Bool: difference, intersection and sum converge to the exact volumes", "[discretise]") {
  const double octant = pi / 6 * 0.75 * 0.75 * 0.75;
  const Volumes exact{1 - octant, octant, 1 + 7 * octant};
  std::vector<double> difference, intersection, sum;
  for (const int level : levels) {
    Volumes largest;
    for_each_near(level, [&](double dp) {
      INFO(dp);
      const Volumes found = cube_and_ball(dp);
      keep_larger(largest.difference, found.difference - exact.difference);
      keep_larger(largest.intersection, found.intersection - exact.intersection);
      keep_larger(largest.sum, found.sum - exact.sum);
      // Every particle of the cube is in one of the two, and in one only: sums of a hundred thousand terms.
      CHECK(found.difference + found.intersection == Approx(1).epsilon(1e-11));
    });
    difference.push_back(largest.difference);
    intersection.push_back(largest.intersection);
    sum.push_back(largest.sum);
  }
  CHECK(difference.back() < 0.1 * spacings.back());
  CHECK(sum.back() < 0.7 * spacings.back());  // seven octants
  CHECK(observed_order(spacings, difference) > 1);
  CHECK(observed_order(spacings, intersection) > 1);
  CHECK(observed_order(spacings, sum) > 1);
}

TEST_CASE("Ogive: both layouts against the integral of pi r^2", "[discretise]") {
  const double arc = 3, base = 1, exact = ogive_volume(arc, base);
  OgiveGeometry nose = ogive(1, 1);
  nose.ogive_radius = arc;
  nose.end_radius = base;
  std::vector<double> errors;
  for (const int level : levels) {
    errors.push_back(0);
    for_each_near(level, [&](double dp) {
      INFO(dp);
      nose.bottom_spacing = nose.top_spacing = dp;
      nose.layout = Layout::orthogonal;
      keep_larger(errors.back(), volume(all(nose)) / exact - 1);
      nose.layout = Layout::polar;  // cells that fill the solid: round-off of a million terms
      CHECK(volume(all(nose)) == Approx(exact).epsilon(1e-10));
    });
  }
  CHECK(errors.back() < 0.5 * spacings.back());
  CHECK(observed_order(spacings, errors) > 1);
  // The most slender that is accepted: round-off of R^2/E^2 units in the last place.
  nose.ogive_radius = 1000;
  nose.bottom_spacing = nose.top_spacing = 0.5;
  CHECK(volume(all(nose)) == Approx(ogive_volume(1000, 1)).epsilon(1e-9));
}

TEST_CASE("Bool: an ogive in a block, and a hole in the shape of an ogive", "[discretise]") {
  OgiveGeometry nose = ogive(0.05, 0.05);
  nose.ogive_radius = nose.end_radius = 1;  // half a ball
  const Scene scene = scene_of({named("block", block(0.05, {-1.5, -1.5, 0}, {3, 3, 1.5})),
                                named("nose", nose), named("mould", minus(0, 1), false)});
  CHECK(made_volume(scene, 2) == Approx(3 * 3 * 1.5 - 2 * pi / 3).epsilon(2e-3));
  bool hollow = true;
  for (const Seed& seed : all(*make_seed_source(scene, scene.components[0].bodies[2])))
    hollow = hollow && std::hypot(seed.position[0], seed.position[1], seed.position[2]) > 1;
  CHECK(hollow);
}

TEST_CASE("Bool: a plate with many holes, each taken from the plate with the holes before", "[discretise]") {
  std::vector<BodyInput> bodies{named("plate", block(0.25, {0, 0, 0}, {20, 1, 1}))};
  std::size_t rest = 0;
  for (std::size_t i = 0; i < 20; ++i) {
    bodies.push_back(named("hole", block(0.25, {double(i), 0, 0}, {0.5, 1, 1})));
    bodies.push_back(named("rest", minus(rest, bodies.size() - 1)));
    rest = bodies.size() - 1;
  }
  bodies.back().for_bool = false;
  const Scene scene = scene_of(bodies);
  CHECK(made_volume(scene, rest) == Approx(10).epsilon(1e-12));
  CHECK(Parts(scene, scene.components[0].bodies[rest]).shapes() == 21);
}

TEST_CASE("Bool: too many shapes are refused without counting them one by one", "[discretise]") {
  // Each takes the one before from itself: 2^40 shapes.
  std::vector<BodyInput> bodies{named("0", block(1, {0, 0, 0}, {1, 1, 1}))};
  for (std::size_t i = 0; i < 40; ++i) bodies.push_back(named(std::to_string(i + 1), minus(i, i)));
  const Scene scene = scene_of(bodies);
  CHECK(Parts(scene, scene.components[0].bodies[3]).shapes() == 8);
  const auto faults = shape_faults(scene, scene.components[0].bodies[40]);
  REQUIRE(faults.size() == 1);
  CHECK_THAT(faults[0].message, Contains("consists of more than 1000 shapes"));
}

TEST_CASE("Bool: points far denser than the particles that they take away", "[discretise]") {
  PointGeometry dust;  // of a mass that makes their volumes tiny
  for (int i = 0; i < 100; ++i) dust.points.push_back({1e-30, {0.01 * i, 0.5, 0.5}});
  const Scene scene = scene_of({named("cube", block(1, {0, 0, 0}, {10, 10, 10})), named("dust", dust),
                                named("rest", minus(0, 1), false)});
  CHECK(made_volume(scene, 2) == Approx(999));
}
