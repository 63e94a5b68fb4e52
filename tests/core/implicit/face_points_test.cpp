// Points on the faces of bodies: their number, places, normals and areas.
#include "core/implicit/face_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "core/discretise/frame.hpp"
#include "tests/core/implicit/blocks.hpp"

using namespace mpm::core;
using testing::ball;
using testing::block;
using testing::body;

namespace {

constexpr double rounding = 1e-12;  // of places a few units from the origin

/// Of these bodies of the scene's active ones, in a grid of several bricks around the origin.
std::vector<FacePoint> points_of(const Scene& scene, std::vector<int> bodies) {
  GridGeometry g;
  g.origin = {-8, -8, -8};
  g.cell = g.inverse_cell = {1, 1, 1};
  g.cells = {16, 16, 16};
  SoloCommunication solo;
  Model model;
  testing::make_bodies(model, scene, g, solo);
  return find_face_points(model, bodies, solo.reductions);
}

/// Of a scene of one body, in a work plane where one is given.
std::vector<FacePoint> points_of(Geometry geometry, const WorkPlane* plane = nullptr) {
  Scene scene;
  scene.components.resize(1);
  BodyInput& input = scene.components[0].bodies.emplace_back(body(std::move(geometry)));
  if (plane != nullptr) {
    scene.work_planes = {*plane};
    input.work_plane = 0;
  }
  return points_of(scene, {0});
}

/// Of 2 x 3 x 4 particles.
BlockGeometry brick() { return block(0.5, {0.25, -3, 1.1}, {1, 1.5, 2}); }

/// Checks the points of brick() in the axes of a frame, whose axes they have as normals, bit for bit.
void check_brick(const std::vector<FacePoint>& points, const WorkPlane& plane) {
  const BlockGeometry of = brick();
  const Frame frame(plane);
  const Vec3<double> axes[3] = {plane.x_axis, plane.y_axis, plane.z_axis};
  REQUIRE(points.size() == 52);
  int sides[3][2] = {}, off_the_lattice = 0;
  double area = 0, volume = 0;
  std::set<std::array<int, 4>> places;
  for (const FacePoint& point : points) {
    CHECK(point.body == 0);
    area += point.area;
    volume += point.area * dot(point.place, point.normal) / 3;
    int axis = -1, side = 0;
    for (int a = 0; a < 3; ++a)
      for (const int s : {0, 1})
        if (point.normal == (s == 0 ? -1.0 : 1.0) * axes[a]) axis = a, side = s;
    REQUIRE(axis >= 0);
    ++sides[axis][side];
    const Vec3<double> at = frame.to_local(point.place) - of.origin;
    CHECK(at[axis] == Approx(side == 0 ? 0 : of.size[axis]).margin(rounding));
    std::array<int, 4> place{2 * axis + side};
    for (int a = 0; a < 3; ++a) {
      // In half spacings: odd across the side.
      const double n = at[a] / (0.5 * of.spacing);
      const int whole = place[static_cast<std::size_t>(a) + 1] = static_cast<int>(std::lround(n));
      const bool inside = whole > 0 && whole < std::lround(2 * of.size[a] / of.spacing);
      if (std::abs(n - whole) > 1e-10 || (a != axis && (whole % 2 == 0 || !inside))) ++off_the_lattice;
    }
    places.insert(place);
  }
  CHECK(off_the_lattice == 0);
  CHECK(places.size() == points.size());  // each place once
  for (int a = 0; a < 3; ++a)
    for (const int s : {0, 1}) CHECK(sides[a][s] == (a == 0 ? 12 : a == 1 ? 8 : 6));
  CHECK(area == Approx(2 * (1 * 1.5 + 1.5 * 2 + 2 * 1)).epsilon(rounding));
  CHECK(volume == Approx(1 * 1.5 * 2).epsilon(rounding));  // by the theorem of Gauss: closed, and outward
}

/// Checks the normals of a ball or of a shell, whose inner face points to the centre.
void check_ball(const SphereGeometry& of, const WorkPlane& plane) {
  CAPTURE(of.outer_radius, of.inner_radius);
  // Its lattice steps: of these balls and shells, the farthest is 12 degrees off.
  const double least = std::cos(14 * std::numbers::pi / 180);
  const Vec3<double> centre = Frame(plane).to_global(of.centre);
  double smallest = 1, off_the_face = 0;
  double area[2] = {}, longest = 0;
  for (const FacePoint& point : points_of(of, &plane)) {
    const Vec3<double> from = point.place - centre;
    const double r = std::sqrt(dot(from, from));
    const bool inner = r < 0.5 * (of.inner_radius + of.outer_radius);
    off_the_face = std::max(off_the_face, std::abs(r - (inner ? of.inner_radius : of.outer_radius)));
    smallest = std::min(smallest, (inner ? -1 : 1) * dot(point.normal, from) / r);
    longest = std::max(longest, std::abs(dot(point.normal, point.normal) - 1));
    area[inner ? 1 : 0] += point.area;
  }
  CHECK(smallest > least);
  CHECK(longest < rounding);
  CHECK(off_the_face < of.spacing);
  // Areas are those of the sides that face outward, a quarter more than the sphere's. Coarse balls differ.
  for (const int inner : {0, 1}) {
    const double r = inner == 1 ? of.inner_radius : of.outer_radius;
    CHECK(area[inner] == Approx(1.25 * 4 * std::numbers::pi * r * r).epsilon(0.15));
  }
}

}  // namespace

TEST_CASE("A block's points are those of its faces, with the axes as normals", "[implicit]") {
  check_brick(points_of(brick()), {});
}

TEST_CASE("A block in a work plane has the plane's axes as normals", "[implicit]") {
  WorkPlane plane;
  plane.origin = {1, -0.5, 2};
  SECTION("about z") {
    plane.x_axis = {0.8, 0.6, 0};
    plane.y_axis = {-0.6, 0.8, 0};
  }
  SECTION("about all axes") {
    plane.x_axis = {2.0 / 3, 1.0 / 3, 2.0 / 3};
    plane.y_axis = {-2.0 / 3, 2.0 / 3, 1.0 / 3};
    plane.z_axis = {-1.0 / 3, -2.0 / 3, 2.0 / 3};
  }
  check_brick(points_of(brick(), &plane), plane);
}

TEST_CASE("A plate of one layer of particles has both its faces", "[implicit]") {
  const std::vector<FacePoint> points = points_of(block(0.5, {-2, -2, 0}, {4, 4, 0.5}));
  int up = 0, down = 0;
  for (const FacePoint& point : points) {
    up += point.normal == Vec3<double>{0, 0, 1} && std::abs(point.place.z - 0.5) < rounding ? 1 : 0;
    down += point.normal == Vec3<double>{0, 0, -1} && std::abs(point.place.z) < rounding ? 1 : 0;
  }
  CHECK(up == 64);
  CHECK(down == 64);
  CHECK(points.size() == 64 + 64 + 4 * 8);
}

TEST_CASE("Normals of a ball point outward along its radius", "[implicit]") {
  WorkPlane plane;
  SECTION("in the global frame") {}
  SECTION("in a work plane") {
    plane.x_axis = {0.8, 0.6, 0};
    plane.y_axis = {-0.6, 0.8, 0};
  }
  for (const auto& [outer, inner] : {std::pair(0.5, 0.0), {1.0, 0.0}, {2.0, 0.0}, {3.0, 0.0}, {3.0, 1.5}}) {
    SphereGeometry of = ball(0.25, outer, inner);
    of.centre = {0.3, -0.2, 0.1};
    check_ball(of, plane);
  }
}

TEST_CASE("A thin shell has normals on both sides", "[implicit]") {
  for (const double thickness : {0.5, 0.75}) {
    SphereGeometry of = ball(0.25, 3.0, 3.0 - thickness);
    for (const FacePoint& point : points_of(of)) {
      const Vec3<double> from = point.place - of.centre;
      const double along = dot(point.normal, from) / std::sqrt(dot(from, from));
      CHECK(std::abs(along) > 0.6);
    }
  }
}

TEST_CASE("Particles in rings have no lattice and no points", "[implicit]") {
  SphereGeometry of = ball(0.25, 2.0, 0.0);
  of.layout = Layout::polar;
  CHECK(points_of(of).empty());
}

TEST_CASE("Face points are those of the bodies asked for, in their order", "[implicit]") {
  Scene scene;
  scene.components.resize(2);
  const auto add = [&](std::size_t component, Geometry geometry) -> BodyInput& {
    return scene.components[component].bodies.emplace_back(body(std::move(geometry)));
  };
  add(0, block(0.5, {-6, -6, -6}, {1, 1, 1})).deactivated = true;  // the model does not count it
  add(0, block(0.5, {-4, -4, -4}, {0.5, 0.5, 0.5}));
  add(0, block(0.5, {0, 0, 0}, {1, 1, 1}));
  // Beside the first: bodies that touch both have a face there.
  add(1, block(0.5, {-3.5, -4, -4}, {0.5, 0.5, 0.5}));
  const std::vector<FacePoint> points = points_of(scene, {2, 0});
  REQUIRE(points.size() == 6 + 6);
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(points[i].body == (i < 6 ? 0 : 2));
    CHECK(points[i].place.x == Approx(i < 6 ? -3.75 : -3.25).margin(0.25 + rounding));
  }
  CHECK(points_of(scene, {}).empty());
  CHECK(points_of(scene, {1}).size() == 24);
}
