// Which points of a face have particles below them.
#include "core/implicit/face_cover.hpp"

#include <vector>

#include <catch2/catch.hpp>

#include "tests/core/implicit/blocks.hpp"

using namespace mpm::core;
using testing::block;
using testing::Blocks;

namespace {

constexpr double face = 6;       ///< coordinate of the face
constexpr double spacing = 0.5;  ///< of particles; cells have edges of 1

/// (along the face, beside, across it) with the face normal to an axis.
Vec3<double> turned(double along, double beside, double across, int axis) {
  Vec3<double> x{};
  x[axis] = across;
  x[(axis + 1) % 3] = along;
  x[(axis + 2) % 3] = beside;
  return x;
}

/// A block whose upper side is `gap` below the face, from `first` to `last` along it.
testing::Block below(double first, double last, double gap, int axis, double of_particles = spacing) {
  return {false,
          block(of_particles, turned(first, 3, face - 2 - gap, axis), turned(last - first, 4, 2, axis))};
}

/// Of body 0, whose outward normal is downward, from 0 to 12 along the face.
std::vector<FacePoint> row(double between, int axis) {
  std::vector<FacePoint> points;
  for (double along = 0.5 * between; along < 12; along += between)
    points.push_back({0, turned(along, 5.03, face, axis), turned(0, 0, -1, axis), between * between});
  return points;
}

/// Where points have material below them.
struct Covered {
  double first = 0, last = 0;
  std::size_t count = 0;
  bool operator==(const Covered&) const = default;
};

Covered covered(Blocks& blocks, const std::vector<FacePoint>& points, int axis,
                const Vec3<double>& moved = {}) {
  const std::vector<Vec3<double>> of_bodies{moved, {}, {}};
  const std::vector<bool> found = FaceCover(blocks.model, blocks.solo.reductions, points).find(of_bodies);
  REQUIRE(found.size() == points.size());
  Covered all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!found[i]) continue;
    const double along = points[i].place[(axis + 1) % 3];
    if (all.count++ == 0) all.first = along;
    all.last = along;
  }
  return all;
}

/// By a block from `first` to `last`, below a rigid body of which it is half as wide.
Covered covered_by(double first, double last, double gap, double between = spacing, int axis = 2) {
  const std::vector<testing::Block> both{
      {true, block(spacing, turned(0, 3, face, axis), turned(12, 4, 1, axis))},
      below(first, last, gap, axis)};
  Blocks blocks(both);
  return covered(blocks, row(between, axis), axis);
}

}  // namespace

TEST_CASE("A face is covered where the material is, not beside it and not by its own body", "[implicit]") {
  for (const int axis : {0, 1, 2}) {
    CHECK(covered_by(3, 6, 0, spacing, axis) == Covered{3.25, 5.75, 6});
    CHECK(covered_by(3, 6, 0.4, spacing, axis) == Covered{3.25, 5.75, 6});
  }
}

TEST_CASE("Material reaches a quarter of a particle beyond its edge", "[implicit]") {
  CHECK(covered_by(3.1, 6.1, 0) == Covered{3.25, 5.75, 6});  // points are 0.15 outside
  CHECK(covered_by(3.2, 6.2, 0) == Covered{3.25, 6.25, 7});  // 0.05
  CHECK(covered_by(3.3, 6.3, 0) == Covered{3.25, 6.25, 7});
}

TEST_CASE("Points need not be as far from each other as particles", "[implicit]") {
  CHECK(covered_by(3.05, 6.05, 0, 0.25) == Covered{3.125, 6.125, 13});
  CHECK(covered_by(3.2, 6.2, 0, 0.25) == Covered{3.125, 6.125, 13});
  CHECK(covered_by(3, 6, 0, 1) == Covered{3.5, 5.5, 3});
  // A point has an area: any particle in it counts.
  CHECK(covered_by(3.2, 6.2, 0, 1) == Covered{3.5, 5.5, 3});
  CHECK(covered_by(3.8, 6.8, 0, 1) == Covered{4.5, 6.5, 3});
  CHECK(covered_by(3.1, 3.6, 0, 1) == Covered{3.5, 3.5, 1});
  CHECK(covered_by(3.4, 3.9, 0, 2) == Covered{3, 3, 1});
}

TEST_CASE("Material covers a face up to half a cell away, and not from behind", "[implicit]") {
  CHECK(covered_by(3, 6, 0.45).count == 6);
  CHECK(covered_by(3, 6, 0.55).count == 0);
  CHECK(covered_by(3, 6, -1.9).count == 6);  // a part of it is still in front of the face
  CHECK(covered_by(3, 6, -2.7).count == 0);  // it is behind
}

TEST_CASE("Points move with their bodies", "[implicit]") {
  for (const int axis : {0, 1, 2}) {
    const std::vector<testing::Block> both{
        {true, block(spacing, turned(0, 3, 11, axis), turned(1, 1, 1, axis))},
        below(3, 6, 0.7, axis),
        {true, block(spacing, turned(11, 3, 11, axis), turned(1, 1, 1, axis))}};
    Blocks blocks(both);
    std::vector<FacePoint> points = row(spacing, axis);
    CHECK(covered(blocks, points, axis).count == 0);
    CHECK(covered(blocks, points, axis, turned(0, 0, -0.5, axis)) == Covered{3.25, 5.75, 6});
    CHECK(covered(blocks, points, axis, turned(1, 0, -0.5, axis)) == Covered{2.25, 4.75, 6});
    // Those of another body stay.
    for (FacePoint point : row(spacing, axis)) {
      point.body = 2;
      points.push_back(point);
    }
    CHECK(covered(blocks, points, axis, turned(0, 0, -0.5, axis)) == Covered{3.25, 5.75, 6});
  }
}

TEST_CASE("Material that is compressed covers what it did", "[implicit]") {
  const std::vector<testing::Block> one{{true, block(spacing, {0, 3, face}, {1, 1, 1})},
                                        below(3.2, 6.2, 0.4, 2)};
  Blocks blocks(one);
  for (const ParticleBlock& of : blocks_of(blocks.model))
    for (const Particle p : of) p[Column::volume] *= 0.5;
  CHECK(covered(blocks, row(spacing, 2), 2) == Covered{3.25, 6.25, 7});
}
