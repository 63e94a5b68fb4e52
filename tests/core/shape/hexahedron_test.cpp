// The means over a trilinear hexahedron, as polynomials of its modes, against quadrature.
#include "core/shape/hexahedron.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "tests/support/reference_shape.hpp"

using mpm::tests::HexahedronMeans;
using mpm::tests::means_over;
using mpm::tests::smallest_corner;
using mpm::tests::Vector;
using namespace mpm::core;

namespace {

using Corner = mpm::tests::DomainCorners;

/// A box whose corners are moved by up to `share` of its half-sizes, anywhere.
Corner distorted(std::mt19937& random, double share) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const Vector half = {1.2, 0.7, 0.9}, middle = {unit(random), unit(random), unit(random)};
  Corner corner = mpm::tests::box(half);
  for (Vector& x : corner)
    for (std::size_t a = 0; a < 3; ++a) x[a] += middle[a] + share * half[a] * unit(random);
  return corner;
}

void by_component(const Corner& corner, double (&x)[3][corners]) {
  for (std::size_t c = 0; c < 8; ++c)
    for (std::size_t a = 0; a < 3; ++a) x[a][c] = corner[c][a];
}

}  // namespace

TEST_CASE("Volume, weights and centroid of a hexahedron are those of quadrature") {
  std::mt19937 random(3);
  double value = 0, slope = 0, centroid = 0, volume = 0, smallest = 0;
  for (int n = 0; n < 500; ++n) {
    const Corner corner = distorted(random, n < 250 ? 0.2 : 0.45);
    double x[3][corners];
    by_component(corner, x);
    const HexahedronMeans exact = means_over(corner);
    const Hexahedron<double> domain(x);
    const CornerWeights<double> weights = domain.weights();
    volume = std::max(volume, std::abs(8 * domain.mean_jacobian - exact.volume));
    for (std::size_t c = 0; c < 8; ++c) {
      value = std::max(value, std::abs(weights.value[c] - exact.value[c]));
      for (std::size_t a = 0; a < 3; ++a)
        slope = std::max(slope, std::abs(weights.slope[a][c] - exact.slope[c][a]));
    }
    for (std::size_t a = 0; a < 3; ++a)
      centroid = std::max(centroid, std::abs(domain.centroid()[static_cast<int>(a)] - exact.centroid[a]));
    // Triple products of whole edges there.
    smallest = std::max(smallest, std::abs(8 * smallest_jacobian(x, 1e30) - smallest_corner(corner)));
  }
  CHECK(volume < 1e-13);
  CHECK(value < 1e-14);
  CHECK(slope < 1e-14);
  CHECK(centroid < 1e-14);
  CHECK(smallest < 1e-13);
}

TEST_CASE("A hexahedron's weights reproduce linear fields, and its gradients are its volume's derivatives") {
  std::mt19937 random(4);
  double sums = 0, linear = 0, derivative = 0;
  for (int n = 0; n < 200; ++n) {
    const Corner corner = distorted(random, 0.3);
    double x[3][corners];
    by_component(corner, x);
    const Hexahedron<double> domain(x);
    const CornerWeights<double> weights = domain.weights();
    double one = 0, zero[3] = {}, at[3] = {}, gradient[3][3] = {};
    for (int c = 0; c < corners; ++c) {
      one += weights.value[c];
      for (int a = 0; a < 3; ++a) {
        zero[a] += weights.slope[a][c];
        at[a] += weights.value[c] * x[a][c];
        for (int b = 0; b < 3; ++b) gradient[a][b] += weights.slope[b][c] * x[a][c];
      }
    }
    sums = std::max(sums, std::abs(one - 1));
    for (int a = 0; a < 3; ++a) {
      sums = std::max(sums, std::abs(zero[a]));
      linear = std::max(linear, std::abs(at[a] - domain.centroid()[a]));
      for (int b = 0; b < 3; ++b) linear = std::max(linear, std::abs(gradient[a][b] - (a == b ? 1 : 0)));
    }
    const int c = n % 8, a = n % 3;
    const double d = 1e-4, before = domain.mean_jacobian;  // the volume is linear in each coordinate
    x[a][c] += d;
    const double rate = (Hexahedron<double>(x).mean_jacobian - before) / d;
    derivative = std::max(derivative, std::abs(rate - weights.slope[a][c] * before));
  }
  CHECK(sums < 1e-14);
  CHECK(linear < 1e-14);
  CHECK(derivative < 1e-11);
}

TEST_CASE("Lanes have the weights of their own hexahedra") {
  using R = Lanes<8>;
  std::mt19937 random(5);
  R x[3][corners];
  Corner corner[8];
  for (int i = 0; i < 8; ++i) {
    corner[i] = distorted(random, 0.3);
    for (std::size_t c = 0; c < 8; ++c)
      for (std::size_t a = 0; a < 3; ++a) x[a][c].set(i, corner[i][c][a]);
  }
  const CornerWeights<R> weights = Hexahedron<R>(x).weights();
  for (int i = 0; i < 8; ++i) {
    const HexahedronMeans exact = means_over(corner[i]);
    for (std::size_t c = 0; c < 8; ++c) {
      CHECK(std::abs(weights.value[c][i] - exact.value[c]) < 1e-14);
      for (std::size_t a = 0; a < 3; ++a) CHECK(std::abs(weights.slope[a][c][i] - exact.slope[c][a]) < 1e-14);
    }
  }
}
