// The normal along the widest gap: exact between flat faces at any edges, along the line of two particles,
// and none where bodies overlap.
#include "core/contact/widest_gap.hpp"

#include <vector>

#include <catch2/catch.hpp>

using namespace mpm::core;

namespace {

using Cloud = std::vector<Vec3<double>>;

LabelledPoints points_of(const Cloud& first, const Cloud& second) {
  LabelledPoints points;
  double label = -1;
  for (const Cloud* cloud : {&first, &second}) {
    for (const Vec3<double>& at : *cloud) {
      LabelledPoints::Row x[3], labels(0.0);
      for (int a = 0; a < 3; ++a) {
        x[a] = LabelledPoints::Row(0.0);
        x[a].set(0, at[a]);
      }
      labels.set(0, label);
      points.add(x[0], x[1], x[2], labels);
    }
    label = 1;
  }
  return points;
}

/// A lattice with spacing 1/2 from `lower` on.
Cloud block(const Vec3<double>& lower, int nx, int ny, int nz) {
  Cloud cloud;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k)
        cloud.push_back(lower + 0.5 * Vec3<double>{double(i), double(j), double(k)});
  return cloud;
}

}  // namespace

TEST_CASE("the widest gap is across flat faces, whatever edges are near") {
  const Cloud base = block({-2, -2, -1.75}, 8, 8, 4);
  for (const double shift : {0.0, 0.17, 0.4}) {
    for (const int n : {1, 2, 5}) {
      const auto normal =
          widest_gap_normal(points_of(base, block({shift - 1, 2 * shift - 1.3, 0.25}, n, 3, 2)));
      REQUIRE(normal);
      for (int a = 0; a < 3; ++a) CHECK((*normal)[a] == Approx(a == 2 ? 1 : 0).margin(1e-14));
    }
  }
}

TEST_CASE("the widest gap of one particle each is along the line between them") {
  const auto normal = widest_gap_normal(points_of({{0, 0, 0}}, {{0.3, 0, 0.4}}));
  REQUIRE(normal);
  CHECK(normal->x == Approx(0.6));
  CHECK(normal->z == Approx(0.8));
}

TEST_CASE("bodies that overlap or are alone have no gap") {
  CHECK(!widest_gap_normal(points_of(block({0, 0, 0}, 3, 3, 3), block({0.3, 0.4, 0.2}, 3, 3, 3))));
  CHECK(!widest_gap_normal(points_of(block({0, 0, 0}, 3, 3, 3), {})));
}
