// Principal values against Eigen's iterative solver: random tensors, nearly double and triple values, any
// scale.

#include "core/tensor/principal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <catch2/catch.hpp>

namespace mpm::tests {

namespace {

using core::Sym3;
using core::Vec3;

Eigen::Matrix3d matrix(const Sym3<double>& a) {
  Eigen::Matrix3d m;
  m << a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz;
  return m;
}

double largest(const Sym3<double>& a) { return matrix(a).cwiseAbs().maxCoeff(); }

/// Error of the three values over the largest component.
double error(const Sym3<double>& a) {
  const Eigen::Vector3d exact =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix(a), Eigen::EigenvaluesOnly).eigenvalues();
  const Vec3<double> mine = core::principal_values(a);
  CHECK(mine.x >= mine.y);
  CHECK(mine.y >= mine.z);
  return std::max({std::abs(mine.x - exact[2]), std::abs(mine.y - exact[1]), std::abs(mine.z - exact[0])}) /
         largest(a);
}

/// Tensors with the values given, turned at random.
struct Turned {
  std::mt19937 random{4711};
  std::normal_distribution<double> normal;
  Sym3<double> operator()(double x, double y, double z) {
    const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    const Eigen::Matrix3d r = q.normalized().toRotationMatrix();
    const Eigen::Matrix3d m = r * Eigen::Vector3d(x, y, z).asDiagonal() * r.transpose();
    return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(0, 2)};
  }
};

// Twice the worst seen, which is 3.8e-15 and has the other solver's error in it.
constexpr double allowed = 8e-15;

}  // namespace

TEST_CASE("principal values of random tensors", "[core][tensor][principal]") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> component(-1, 1);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    worst = std::max(worst, error({component(random), component(random), component(random), component(random),
                                   component(random), component(random)}));
  }
  INFO("worst error " << worst);
  CHECK(worst < allowed);
}

TEST_CASE("principal values that nearly coincide keep their digits", "[core][tensor][principal]") {
  Turned turned;
  double worst = 0;
  for (double gap = 1; gap > 1e-18; gap *= 0.1) {
    for (int i = 0; i < 200; ++i) {
      const double mean = turned.normal(turned.random), middle = turned.normal(turned.random);
      for (const double sign : {-1.0, 1.0}) {
        worst = std::max({worst, error(turned(1, 1 + gap, sign)), error(turned(1, -0.5, -0.5 - sign * gap)),
                          error(turned(mean, mean + gap, mean - sign * gap * middle))});
      }
    }
  }
  INFO("worst error " << worst);
  CHECK(worst < allowed);
  // The difference of two close values is what the shear criteria look at.
  const Vec3<double> close = core::principal_values(Sym3<double>{1, 1, 3, 1e-9, 0, 0});
  CHECK(close.y - close.z == Approx(2e-9).epsilon(1e-6));
}

TEST_CASE("principal values in closed form", "[core][tensor][principal]") {
  const auto check = [](const Sym3<double>& a, double x, double y, double z) {
    const Vec3<double> p = core::principal_values(a);
    CHECK(p.x == Approx(x).epsilon(1e-15).margin(1e-15));
    CHECK(p.y == Approx(y).epsilon(1e-15).margin(1e-15));
    CHECK(p.z == Approx(z).epsilon(1e-15).margin(1e-15));
  };
  check({0, 0, 0, 0, 0, 0}, 0, 0, 0);
  check({3, 3, 3, 0, 0, 0}, 3, 3, 3);
  check({1, 2, 3, 0, 0, 0}, 3, 2, 1);
  check({0, 0, 0, 1, 0, 0}, 1, 0, -1);
  check({2, 0, 0, 0, 0, 0}, 2, 0, 0);
  check({-2, 0, 0, 0, 0, 0}, 0, 0, -2);
  check({0, 0, 0, 1, 1, 1}, 2, -1, -1);
  check({0, 0, 0, -1, -1, -1}, 1, 1, -2);
}

TEST_CASE("principal values do not depend on the unit", "[core][tensor][principal]") {
  Turned turned;
  for (const double unit : {1e-300, 1e-160, 1e-3, 1e9, 1e150, 1e300}) {
    for (int i = 0; i < 100; ++i) {
      Sym3<double> a = turned(2, -0.7, 0.3);
      a = unit * a;
      const Vec3<double> p = core::principal_values(a);
      CHECK(p.x / unit == Approx(2).epsilon(1e-14));
      CHECK(p.y / unit == Approx(0.3).epsilon(3e-14));
      CHECK(p.z / unit == Approx(-0.7).epsilon(3e-14));
    }
  }
  const double nan = std::nan("");
  for (int i = 0; i < 6; ++i) {
    std::array<double, 6> c{1, 2, 3, 4, 5, 6};
    c[static_cast<std::size_t>(i)] = nan;
    const Vec3<double> p = core::principal_values(Sym3<double>{c[0], c[1], c[2], c[3], c[4], c[5]});
    CHECK(p.x != p.x);
    CHECK(p.z != p.z);
  }
}

TEST_CASE("lanes have the principal values of their own tensors", "[core][tensor][principal]") {
  using core::Real;
  constexpr int width = core::real_width;
  Turned turned;
  for (int k = 0; k < 500; ++k) {
    std::array<std::array<double, 8>, 6> c{};
    std::array<Sym3<double>, 8> a{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i) {
      // Neighbours of all kinds: zero, double values, far apart in size.
      a[i] = i == 1 ? Sym3<double>{} : turned(1, i == 2 ? 1 : 0.3, i == 3 ? 1e12 : -1);
      c[0][i] = a[i].xx, c[1][i] = a[i].yy, c[2][i] = a[i].zz;
      c[3][i] = a[i].xy, c[4][i] = a[i].yz, c[5][i] = a[i].xz;
    }
    const auto get = [&](std::size_t i) { return core::load<Real>(c[i].data()); };
    const Vec3<Real> p = core::principal_values(Sym3<Real>{get(0), get(1), get(2), get(3), get(4), get(5)});
    std::array<std::array<double, 8>, 3> out{};
    core::store(out[0].data(), p.x), core::store(out[1].data(), p.y), core::store(out[2].data(), p.z);
    for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i) {
      const Vec3<double> alone = core::principal_values(a[i]);
      const double round_off = allowed * std::max(largest(a[i]), 1e-300);
      CHECK(std::abs(out[0][i] - alone.x) <= round_off);
      CHECK(std::abs(out[1][i] - alone.y) <= round_off);
      CHECK(std::abs(out[2][i] - alone.z) <= round_off);
    }
  }
}

}  // namespace mpm::tests
