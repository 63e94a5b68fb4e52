// The ways to update the volume (manual 3.10.5, and the mid-point rule's), its bounds, and volumes that would
// become zero or less.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::Mat3;
using physics::PointDriver;

namespace {

const Mat3<double> gradient{100, 30, -20, 10, -60, 40, 25, -15, 80};
constexpr double dt = 1e-3;

double ratio_after(int type, int steps) {
  const auto material = make(copper("IsoElastic"));
  PointDriver point(*material, {.update = {.volume_update = type}});
  for (int i = 0; i < steps; ++i) point.step(gradient, dt);
  return point.volume_ratio();
}

}  // namespace

TEST_CASE("volume updates follow their formulas", "[physics][volume]") {
  const double tr = dt * (100 - 60 + 80);
  const int n = 3;
  CHECK(ratio_after(0, n) == Approx(std::pow(1 + tr, n)).epsilon(1e-14));
  CHECK(ratio_after(1, n) ==
        Approx(std::pow(1 + tr, n)).epsilon(1e-14));  // the driver's cell is the particle
  CHECK(ratio_after(2, n) == Approx(std::exp(n * tr)).epsilon(1e-14));
  const Mat3<double> f{1.1, 0.03, -0.02, 0.01, 0.94, 0.04, 0.025, -0.015, 1.08};
  CHECK(ratio_after(3, n) == Approx(std::pow(determinant(f), n)).epsilon(1e-14));
  CHECK(ratio_after(4, n) == Approx((1 + n * 0.1) * (1 - n * 0.06) * (1 + n * 0.08)).epsilon(1e-14));
  const Mat3<double> ahead{1.05, 0.015, -0.01, 0.005, 0.97, 0.02, 0.0125, -0.0075, 1.04};
  const Mat3<double> behind{0.95, -0.015, 0.01, -0.005, 1.03, -0.02, -0.0125, 0.0075, 0.96};
  CHECK(ratio_after(5, n) == Approx(std::pow(determinant(ahead) / determinant(behind), n)).epsilon(1e-14));
}

TEST_CASE("the mid-point rule's volume is that of the laws' deformation gradient", "[physics][volume]") {
  const auto material = make(sample("NeoHookean").input);
  PointDriver point(*material, {.update = {.volume_update = 5}});
  for (int i = 0; i < 5; ++i) point.step(gradient, dt);
  const auto f = [&](Column c) { return point.value(c); };
  const Mat3<double> all{f(Column::f_xx), f(Column::f_xy), f(Column::f_xz), f(Column::f_yx), f(Column::f_yy),
                         f(Column::f_yz), f(Column::f_zx), f(Column::f_zy), f(Column::f_zz)};
  CHECK(point.volume_ratio() == Approx(determinant(all)).epsilon(1e-14));
  CHECK(point.volume_ratio() > 1.3);
}

TEST_CASE("accumulated strain is kept where it is asked for", "[physics][volume]") {
  const auto material = make(copper("IsoElastic"));
  PointDriver point(*material, {.update = {.keep_strain = true}});
  for (int i = 0; i < 4; ++i) point.step(gradient, dt);
  CHECK(point.value(Column::strain_xx) == Approx(0.4));
  CHECK(point.value(Column::strain_yy) == Approx(-0.24));
  CHECK(point.value(Column::strain_xy) == Approx(0.5 * 40 * 4e-3));
  CHECK(point.value(Column::strain_yz) == Approx(0.5 * 25 * 4e-3));
  CHECK(point.value(Column::strain_xz) == Approx(0.5 * 5 * 4e-3));
}

TEST_CASE("volume bounds hold and are counted", "[physics][volume]") {
  const auto material = make(copper("IsoElastic"));
  PointDriver point(*material, {.update = {.volume_min = 0.9, .volume_max = 1.05}});
  for (int i = 0; i < 20; ++i) point.step({10, 0, 0, 0, 0, 0, 0, 0, 0}, dt);
  CHECK(point.volume_ratio() == Approx(1.05).epsilon(1e-15));
  CHECK(point.events().volume_limited == 16);  // 1.01^n > 1.05 from the fifth on
  for (int i = 0; i < 40; ++i) point.step({-10, 0, 0, 0, 0, 0, 0, 0, 0}, dt);
  CHECK(point.volume_ratio() == Approx(0.9).epsilon(1e-15));
  CHECK(point.events().not_finite == 0);
}

TEST_CASE("a volume that would vanish stays, and is counted", "[physics][volume]") {
  for (const int type : {0, 1, 3, 4}) {
    INFO("update type " << type);
    const auto material = make(copper("IsoElastic"));
    PointDriver point(*material, {.update = {.volume_update = type}});
    point.step({-1500, 0, 0, 0, 0, 0, 0, 0, 0}, dt);
    CHECK(point.volume_ratio() == 1);
    CHECK(point.events().negative_volume == 1);
    CHECK(point.events().not_finite == 0);
  }
}

TEST_CASE("the mid-point rule stretches and compresses threefold at most, per axis", "[physics][volume]") {
  const auto material = make(copper("IsoElastic"));
  for (const double increment : {-2.5, 2.5}) {
    PointDriver point(*material, {.update = {.volume_update = 5}});
    point.step({increment / dt, 0, 0, 0, 0, 0, 0, 0, 0}, dt);
    CHECK(point.volume_ratio() == 1);
    CHECK(point.events().negative_volume == 1);
    point.step({0.4 * increment / dt, 0, 0, 0, 0, 0, 0, 0, 0}, dt);
    CHECK(point.volume_ratio() == Approx(increment > 0 ? 3.0 : 1.0 / 3).epsilon(1e-14));
  }
}

TEST_CASE("a gradient that is no number is counted", "[physics][volume]") {
  const auto material = make(copper("IsoHarden", true));
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    PointDriver point(*material, {});
    point.step({0, bad, 0, 0, 0, 0, 0, 0, 0}, dt);
    CHECK(point.events().not_finite == 1);
  }
}

}  // namespace mpm::tests
