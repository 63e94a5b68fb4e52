// Small tensors; the mid-point rotation against what Hughes and Winget promise of it.
#include "core/tensor/tensor.hpp"

#include <cmath>
#include <random>

#include <catch2/catch.hpp>

using namespace mpm::core;

namespace {

constexpr double epsilon = 2.2e-16;

double largest(const Mat3<double>& a) {
  double m = 0;
  for (const double x : {a.xx, a.xy, a.xz, a.yx, a.yy, a.yz, a.zx, a.zy, a.zz}) m = std::max(m, std::abs(x));
  return m;
}
Mat3<double> transposed(const Mat3<double>& a) {
  return {a.xx, a.yx, a.zx, a.xy, a.yy, a.zy, a.xz, a.yz, a.zz};
}
constexpr Mat3<double> identity{1, 0, 0, 0, 1, 0, 0, 0, 1};

/// Rodrigues: the rotation by |w| about w.
Mat3<double> exact_rotation(const Vec3<double>& w) {
  const double angle = std::sqrt(dot(w, w)), s = std::sin(angle) / angle,
               c = (1 - std::cos(angle)) / (angle * angle);
  const Mat3<double> a{0, -w.z, w.y, w.z, 0, -w.x, -w.y, w.x, 0}, aa = a * a;
  return {1 + c * aa.xx,        s * a.xy + c * aa.xy, s * a.xz + c * aa.xz,
          s * a.yx + c * aa.yx, 1 + c * aa.yy,        s * a.yz + c * aa.yz,
          s * a.zx + c * aa.zx, s * a.zy + c * aa.zy, 1 + c * aa.zz};
}

}  // namespace

TEST_CASE("The mid-point rotation is orthogonal to round-off, whatever the angle") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double size : {1e-12, 1e-3, 0.3, 2.0, 50.0, 1e6}) {
    for (int i = 0; i < 100; ++i) {
      const Vec3<double> w{size * unit(random), size * unit(random), size * unit(random)};
      const Mat3<double> r = mid_point_rotation(w);
      // Each entry is a few operations on numbers up to 1 (in 1 + k (x x - n) numbers up to 2 cancel).
      CHECK(largest(r * transposed(r) - identity) < 20 * epsilon);
      CHECK(std::abs(determinant(r) - 1) < 20 * epsilon);
      // It leaves its own axis alone.
      const double n = std::sqrt(dot(w, w));
      CHECK(std::abs(r.xx * w.x + r.xy * w.y + r.xz * w.z - w.x) < 20 * epsilon * n);
      CHECK(std::abs(r.yx * w.x + r.yy * w.y + r.yz * w.z - w.y) < 20 * epsilon * n);
    }
  }
}

TEST_CASE("The mid-point rotation turns the right way, with second order in the angle") {
  const Mat3<double> quarter = mid_point_rotation(Vec3<double>{0, 0, 2});  // tan(angle / 2) = 1
  CHECK(largest(quarter - Mat3<double>{0, -1, 0, 1, 0, 0, 0, 0, 1}) < 4 * epsilon);
  // Many small turns make up one of 1 rad: the error of all falls with the square of the single turn.
  const Vec3<double> whole{0.48, -0.6, 0.64};
  double error[3];
  for (int level = 0; level < 3; ++level) {
    const int turns = 16 << level;
    const Mat3<double> r = mid_point_rotation((1.0 / turns) * whole);
    Mat3<double> all = identity;
    for (int i = 0; i < turns; ++i) all = r * all;
    error[level] = largest(all - exact_rotation(whole));
  }
  // Angle 2 atan(h/2) = h - h^3/12: h^2/12 over the whole turn; the ratio of errors is 4 but for h^2 of it.
  CHECK(error[0] < 1.1 / 12 / (16 * 16));
  CHECK(error[0] / error[1] == Approx(4).epsilon(0.01));
  CHECK(error[1] / error[2] == Approx(4).epsilon(0.01));
}

TEST_CASE("A rotation takes a symmetric tensor along and keeps its invariants") {
  const Mat3<double> quarter{0, -1, 0, 1, 0, 0, 0, 0, 1};
  const Sym3<double> a{1, 2, 3, 4, 5, 6}, b = rotate(quarter, a);
  CHECK((b.xx == 2 && b.yy == 1 && b.zz == 3 && b.xy == -4 && b.yz == 6 && b.xz == -5));
  const Mat3<double> r = mid_point_rotation(Vec3<double>{0.3, -1.1, 0.7});
  const Sym3<double> c = rotate(r, a);
  CHECK(trace(c) == Approx(trace(a)).epsilon(1e-14));
  CHECK(contract(c, c) == Approx(contract(a, a)).epsilon(1e-14));
  CHECK(contract(a, a) == 1 + 4 + 9 + 2 * (16 + 25 + 36));
}

TEST_CASE("Deviator and von Mises stress of known states") {
  const Sym3<double> pressure = deviator(Sym3<double>{-7, -7, -7, 0, 0, 0});
  CHECK((pressure.xx == 0 && pressure.yy == 0 && pressure.zz == 0));
  CHECK(mises(deviator(Sym3<double>{250, 0, 0, 0, 0, 0})) == Approx(250).epsilon(1e-15));
  CHECK(mises(Sym3<double>{0, 0, 0, 0, 90, 0}) == Approx(90 * std::sqrt(3.0)).epsilon(1e-15));
  CHECK(std::abs(trace(deviator(Sym3<double>{1, 20, -300, 4, 5, 6}))) < 300 * epsilon);
}

TEST_CASE("Tensors of lanes are tensors of doubles, lane by lane") {
  // Round-off apart: which product and sum are fused is the compiler's choice in each instance.
  using Four = Lanes<4>;
  Vec3<Four> w;
  for (int i = 0; i < 4; ++i) w.x.set(i, 0.1 * i), w.y.set(i, 1.0 - i), w.z.set(i, 0.5 * i * i);
  const Mat3<Four> r = mid_point_rotation(w);
  for (int i = 0; i < 4; ++i) {
    const Mat3<double> one = mid_point_rotation(Vec3<double>{w.x[i], w.y[i], w.z[i]});
    CHECK(r.xy[i] == Approx(one.xy).epsilon(1e-14).margin(1e-16));
    CHECK(r.zz[i] == Approx(one.zz).epsilon(1e-14).margin(1e-16));
  }
}
