// Fluids: shear stress of Newtonian and power-law fluids in simple shear and in extension (manual 3-7, 3-8),
// and the part of the viscosity in the critical speed.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::PointDriver;

namespace {
constexpr double rate = 1e3;
core::Mat3<double> shear_gradient() { return {0, rate, 0, 0, 0, 0, 0, 0, 0}; }
}  // namespace

TEST_CASE("a Newtonian fluid has tau = mu times the shear rate", "[physics][fluid]") {
  const auto material = make(sample("Null Newtonian + Polynomial solid").input);
  PointDriver point(*material, {});
  point.step(shear_gradient(), 1e-9);
  // The spin turns the increment by rate dt/2 within the step.
  CHECK(point.stress().xy == Approx(20.0 * rate).epsilon(1e-9));
  // A stretch of rate e along x at constant volume: s_xx = 2 mu e (Trouton).
  point.step({rate, 0, 0, 0, -rate / 2, 0, 0, 0, -rate / 2}, 1e-9);
  CHECK(point.deviator().xx == Approx(2 * 20.0 * rate).epsilon(1e-12));
  CHECK(point.deviator().yy == Approx(-20.0 * rate).epsilon(1e-12));
}

TEST_CASE("a power-law fluid has tau = ck rate^nn", "[physics][fluid]") {
  const auto material = make(sample("Null power law + Polynomial solid").input);
  for (const double r : {1.0, 1e2, 1e4}) {
    PointDriver point(*material, {});
    point.step({0, r, 0, 0, 0, 0, 0, 0, 0}, 1e-9 / r);
    // A rate below 1e-8/dt counts as that; here it is 1e-9/dt.
    CHECK(point.stress().xy == Approx(300.0 * std::pow(10 * r, 0.6 - 1) * r).epsilon(1e-8));
    PointDriver faster(*material, {});
    faster.step({0, r, 0, 0, 0, 0, 0, 0, 0}, 1e-6 / r);
    CHECK(faster.stress().xy == Approx(300.0 * std::pow(r, 0.6)).epsilon(1e-5));
  }
}

TEST_CASE("viscosity counts in the critical speed", "[physics][fluid]") {
  const double cell = 1e-3;
  for (const bool artificial : {true, false}) {
    const auto material = make(sample("Null Newtonian + Polynomial solid").input);
    PointDriver point(*material, {.cell_size = cell, .update = {.viscosity_in_wave_speed = artificial}});
    point.step(shear_gradient(), 1e-9);
    const double q = 4.0 / 3 * 20.0 / (point.density() * cell), speed = point.sound_speed();
    CHECK(point.critical_speed() == Approx(q + std::sqrt(q * q + speed * speed)).epsilon(1e-12));
  }
}

TEST_CASE("an inviscid fluid has no shear stress", "[physics][fluid]") {
  const auto material = make(sample("Null + Polynomial solid").input);
  PointDriver point(*material, {});
  for (int i = 0; i < 10; ++i) point.step({1e3, 2e3, 0, -1e3, -3e3, 0, 0, 0, 1e3}, 1e-6);
  CHECK(mises(point.deviator()) == 0);
}

}  // namespace mpm::tests
