// The soft material of partly filled cells.
#include "core/implicit/cell_stabilisation.hpp"

#include <cmath>

#include <catch2/catch.hpp>

namespace mpm::core {
namespace {

const Vec3<double> edges{1, 2, 0.5};

/// Energy u K u / 2 of the corner displacements u(x).
template <class F>
double energy(const CellMatrix& k, F u) {
  double at[24];
  for (int n = 0; n < 8; ++n) {
    const Vec3<double> v = u(Vec3<double>{(n & 1) * edges.x, (n >> 1 & 1) * edges.y, (n >> 2) * edges.z});
    for (int a = 0; a < 3; ++a) at[3 * n + a] = v[a];
  }
  double sum = 0;
  for (std::size_t p = 0; p < 24; ++p)
    for (std::size_t q = 0; q < 24; ++q) sum += 0.5 * at[p] * k[p][q] * at[q];
  return sum;
}

TEST_CASE("A soft cell stores the energy of its strain, and none of rigid motion") {
  const CellMatrix k = cell_matrix(edges);
  const auto x = [](const Vec3<double>& at) { return at; };
  CHECK(std::abs(energy(k, [](const auto&) { return Vec3<double>{1, -2, 3}; })) < 1e-13);
  CHECK(std::abs(energy(k, [&](const auto& at) { return Vec3<double>{-x(at).y, x(at).x, 0}; })) < 1e-13);
  // volume 1, sym grad u : sym grad u / 2
  CHECK(energy(k, [&](const auto& at) { return Vec3<double>{0.3 * at.x, 0, 0}; }) == Approx(0.5 * 0.09));
  CHECK(energy(k, [&](const auto& at) { return Vec3<double>{0.2 * at.z, 0, 0}; }) == Approx(0.5 * 2 * 0.01));
  for (std::size_t p = 0; p < 24; ++p)
    for (std::size_t q = 0; q < 24; ++q) CHECK(k[p][q] == Approx(k[q][p]).margin(1e-15));
}

TEST_CASE("A soft cell resists every deformation of its corners") {
  const CellMatrix k = cell_matrix(edges);
  for (int axis = 0; axis < 3; ++axis) {
    // The hourglass modes and the checkerboard.
    for (int mode = 0; mode < 4; ++mode) {
      const double found = energy(k, [&](const auto& at) {
        const double s[3] = {at.x > 0 ? 1.0 : -1.0, at.y > 0 ? 1.0 : -1.0, at.z > 0 ? 1.0 : -1.0};
        const double products[4] = {s[0] * s[1], s[1] * s[2], s[0] * s[2], s[0] * s[1] * s[2]};
        Vec3<double> u{};
        u[axis] = products[mode];
        return u;
      });
      CHECK(found > 0.05);
    }
  }
}

}  // namespace
}  // namespace mpm::core
