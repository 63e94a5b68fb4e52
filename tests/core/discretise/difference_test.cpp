// Bool subtract, and the errors of impossible bodies.
#include <catch2/catch.hpp>

#include "tests/core/discretise/support.hpp"

using namespace mpm::core;
using namespace mpm::core::testing;
using Catch::Matchers::Contains;

namespace {

/// A scene of two components with these bodies, and last a Bool body: the first minus the second.
Scene difference(std::vector<BodyInput> bodies) {
  Scene scene;
  for (BodyInput& operand : bodies) operand.for_bool = true;
  bodies.push_back(body(BoolGeometry{{0, 0}, {1, 0}}));
  bodies.back().name = "rest";
  scene.components.resize(2);
  scene.components[0].bodies.push_back(bodies.front());
  scene.components[1].bodies.assign(bodies.begin() + 1, bodies.end());
  return scene;
}

Seeds rest(const Scene& scene) { return all(*make_seed_source(scene, scene.components[1].bodies.back())); }

std::string fault(const Geometry& geometry) {
  try {
    source(geometry);
  } catch (const InputErrors& errors) { return errors.what(); }
  return "no fault";
}

}  // namespace

TEST_CASE("Bool: the manual's example, a box minus a box", "[discretise]") {
  const Scene scene =
      difference({body(block(1, {16, 0, 20}, {88, 25, 20})), body(block(1, {20, 0, 25}, {80, 20, 10}))});
  const Seeds seeds = rest(scene);
  CHECK(seeds.size() == 88 * 25 * 20 - 80 * 20 * 10);
  const Seeds minuend = all(block(1, {16, 0, 20}, {88, 25, 20}));
  CHECK(is_part(seeds, minuend, [](const Position& p) {
    return !(p[0] > 20 && p[0] < 100 && p[1] > 0 && p[1] < 20 && p[2] > 25 && p[2] < 35);
  }));
}

TEST_CASE("Bool: round operands, sweeps and work planes", "[discretise]") {
  const BodyInput cube = body(block(0.05, {-1, -1, -1}, {2, 2, 2}));
  SphereGeometry quarter = ball(0.05, 0.8, 0.3);
  quarter.angle = 90;
  const auto radius = [](const Position& p) { return std::hypot(p[0], p[1], p[2]); };
  CHECK(is_part(
      rest(difference({cube, body(quarter)})), all(*make_seed_source({}, cube)),
      [&](const Position& p) { return !(p[0] > 0 && p[1] > 0 && radius(p) <= 0.8 && radius(p) >= 0.3); }));

  // A bore along global x; the Bool body's own density and work plane.
  CylinderGeometry bore = cylinder(0.05, 0.5, 3);
  bore.base_centre[2] = -1.5;
  Scene scene = difference({cube, body(bore)});
  scene.work_planes.resize(2);
  scene.work_planes[0].x_axis = {0, 0, -1};
  scene.work_planes[0].z_axis = {1, 0, 0};
  scene.work_planes[1].origin = {0, 0, 100};
  scene.components[1].bodies[0].work_plane = 0;
  scene.components[1].bodies[1].work_plane = 1;
  scene.components[1].bodies[1].density = 1000;
  const Seeds seeds = rest(scene);
  CHECK(mass(seeds) == Approx(1000 * volume(seeds)).epsilon(1e-12));
  bool bored = true;
  for (const Seed& seed : seeds) bored = bored && std::hypot(seed.position[1], seed.position[2] - 100) > 0.5;
  CHECK(bored);
  // The bore's lattice holds 316 points in a circle of ten spacings.
  CHECK(seeds.size() == 40 * (40 * 40 - 316));
}

TEST_CASE("Bool: points take away what is within half a spacing", "[discretise]") {
  const BodyInput cube = body(block(1, {0, 0, 0}, {10, 10, 10}));
  PointGeometry points;
  points.points = {{1, {0.5, 0.5, 0.5}}, {1, {9.5, 9.4, 9.9}}, {1, {5, 5, 5}}, {1, {3, 5.5, 5.5}}};
  // On one, within half a spacing of one, at a corner of eight cells: none; between two: both.
  CHECK(rest(difference({cube, body(points)})).size() == 1000 - 1 - 1 - 0 - 2);
}

TEST_CASE("Bool: nothing left, and a body made of itself", "[discretise]") {
  const BodyInput cube = body(block(1, {0, 0, 0}, {10, 10, 10}));
  CHECK_THROWS_WITH(rest(difference({cube, cube})),
                    "case.xmp:7: <Body BoolBodyB=\"bar\">: body `rest`: the body has no particles: no "
                    "particle of body 'bar' is outside the subtracted body");
  Scene scene = difference({cube, cube});
  scene.components[1].bodies[1].geometry = BoolGeometry{{0, 0}, {1, 1}};
  scene.components[1].bodies[1].for_bool = true;
  CHECK_THROWS_WITH(
      rest(scene),
      "case.xmp:7: <Body BoolBodyB=\"rest\">: body `rest`: the body is an operand of itself: rest -> "
      "rest; expected operands that do not contain it");
}

TEST_CASE("impossible geometries are refused by their attributes' names", "[discretise]") {
  CHECK(fault(block(0, {0, 0, 0}, {1, -1, 1})) ==
        "case.xmp:7: <Geometry dp=\"0\">: body `bar`: expected a number greater than 0\n"
        "case.xmp:7: <Geometry ly=\"-1\">: body `bar`: expected a number greater than 0");
  CHECK_THAT(fault(block(std::nan(""), {0, 0, 0}, {1, 1, 1})), Contains("dp=\"nan\""));
  CHECK_THAT(fault(ball(0.1, 1, 1)),
             Contains("Outer_Radius=\"1\"") && Contains("expected more than Inner_Radius, 1"));
  SphereGeometry wide = ball(0.1, 1);
  wide.angle = 361;
  CHECK_THAT(fault(wide), Contains("angle=\"361\"") && Contains("expected a number in (0, 360]"));
  CylinderGeometry tube = cylinder(0.1, 1, 1);
  tube.top_inner_radius = 2;
  CHECK_THAT(fault(tube),
             Contains("Top_Outer_Radius=\"1\"") && Contains("expected more than Top_Inner_Radius, 2"));
  OgiveGeometry blunt = ogive(0.1, 0.1);
  blunt.ogive_radius = 1;
  CHECK_THAT(fault(blunt), Contains("expected at least End_Radius, 2"));
  CHECK_THAT(fault(ball(1, 0.5)), Contains("body `bar`: the body has no particles"));
  BarLinesGeometry bars;
  bars.expand_direction = 1;
  CHECK_THAT(fault(bars), Contains("known but not implemented yet"));
  CHECK_THAT(fault(HexahedronBlockGeometry{block(1, {0, 0, 0}, {1, 1, 1})}),
             Contains("known but not implemented yet"));
}
