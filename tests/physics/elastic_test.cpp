// Linear elasticity against its moduli: thesis 2-93 to 2-97, 2-57 to 2-59.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::Sym3;
using physics::Path;
using physics::PathKind;
using physics::PointDriver;

namespace {
constexpr double young = 124e9, poisson = 0.34, rho0 = 8960;
constexpr double shear = young / (2 * (1 + poisson)), bulk = young / (3 * (1 - 2 * poisson));
}  // namespace

TEST_CASE("uniaxial strain, shear and hydrostatic strain give the elastic moduli", "[physics][elastic]") {
  for (const char* law : {"IsoElastic", "CauchyElastic"}) {
    INFO(law);
    const auto material = make(copper(law));
    const double e = 1e-3;
    // The rate form adds equal increments without spin: the sum is exact to round-off.
    PointDriver uniaxial(*material, {}), hydrostatic(*material, {});
    drive(uniaxial, {.kind = PathKind::uniaxial_strain, .targets = {e}, .steps = 50}, [](double) {});
    CHECK(uniaxial.stress().xx == Approx((bulk + 4 * shear / 3) * e).epsilon(1e-12));
    CHECK(uniaxial.stress().yy == Approx((bulk - 2 * shear / 3) * e).epsilon(1e-12));
    CHECK(uniaxial.stress().xy == 0);
    drive(hydrostatic, {.kind = PathKind::hydrostatic, .targets = {-e}, .steps = 50}, [](double) {});
    CHECK(hydrostatic.value(Column::pressure) == Approx(bulk * e).epsilon(1e-12));
    CHECK(hydrostatic.deviator().xx == Approx(0).margin(1e-15 * bulk));
  }
}

TEST_CASE("uniaxial stress gives Young's modulus and Poisson's ratio", "[physics][elastic]") {
  const auto material = make(copper("IsoElastic"));
  PointDriver point(*material, {.extra_columns = material->columns({.keep_strain = true})});
  REQUIRE(drive(point, {.kind = PathKind::uniaxial_stress, .targets = {1e-3}, .steps = 20}, [](double) {}));
  CHECK(point.stress().xx == Approx(young * 1e-3).epsilon(1e-8));
  CHECK(point.value(Column::strain_yy) == Approx(-poisson * 1e-3).epsilon(1e-8));
  // Half stress times strain, over the volume that the stress acts on.
  CHECK(point.energy() == Approx(0.5 * young * 1e-6).epsilon(1e-3));
}

TEST_CASE("simple shear of a Jaumann elastic body is G sin(gamma)", "[physics][elastic]") {
  // Jaumann rate under constant spin: s_xy = G sin(gamma), s_xx = G (1 - cos(gamma)); e.g. Dienes, Acta
  // Mechanica 32 (1979) 217, whose objection to the rate this oscillation is.
  const auto material = make(copper("IsoElastic"));
  const double gamma = 2;
  double last = 0;
  for (const int steps : {100, 200}) {
    PointDriver point(*material, {});
    drive(point, {.kind = PathKind::simple_shear, .targets = {gamma}, .steps = steps}, [](double) {});
    const double error = std::hypot(point.stress().xy - shear * std::sin(gamma),
                                    point.deviator().xx - shear * (1 - std::cos(gamma))) /
                         shear;
    CHECK(error < 2e-4);
    if (last > 0) CHECK(std::log2(last / error) == Approx(2).margin(0.05));
    last = error;
  }
}

TEST_CASE("elastic wave speed at rest, compressed and stretched", "[physics][elastic]") {
  const auto material = make(copper("IsoElastic"));
  CHECK(material->initial_sound_speed() == Approx(std::sqrt((bulk + 4 * shear / 3) / rho0)).epsilon(1e-14));
  for (const double strain : {-0.1, 0.0, 0.1}) {
    PointDriver point(*material, {});
    drive(point, {.kind = PathKind::hydrostatic, .targets = {strain}, .steps = 100}, [](double) {});
    point.step({}, 1e-9);
    CHECK(point.sound_speed() == Approx(std::sqrt((bulk + 4 * shear / 3) / point.density())).epsilon(1e-12));
  }
}

TEST_CASE("a body placed at another density starts with the pressure and energy of that density",
          "[physics][elastic]") {
  const auto material = make(copper("IsoElastic"));
  for (const double ratio : {1.05, 1.0, 0.96}) {
    PointDriver point(*material, {.density = ratio * rho0});
    CHECK(point.value(Column::pressure) == Approx(bulk * std::log(ratio)).epsilon(1e-12).margin(1e-6));
    // Released to the reference density, it has given back all: E is zero there, to the second order of the
    // steps.
    const int steps = 400;
    drive(point, {.kind = PathKind::hydrostatic, .rate = 1, .targets = {std::log(ratio)}, .steps = steps},
          [](double) {});
    CHECK(std::abs(point.value(Column::pressure)) < 1e-9 * bulk);
    CHECK(std::abs(point.energy()) < 1e-3 * bulk * std::pow(std::log(ratio), 2) + 1e-12);
  }
}

}  // namespace mpm::tests
