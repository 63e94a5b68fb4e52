// Mie-Grueneisen against the shock Hugoniot: the jump conditions (thesis 2-60 to 2-62) with Us = C0 + S1 up
// give states that the equation must reproduce exactly, being built about them; and its derivatives and
// limits.

#include "physics/eos/gruneisen.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::EosPoint;
using physics::Gruneisen;
using physics::LinearisedPressure;
using physics::PathKind;
using physics::PointDriver;

namespace {

constexpr double rho0 = 8960, c0 = 3940, s1 = 1.49, gamma0 = 1.96;

Gruneisen law(bool simplified = false) {
  Gruneisen g;
  g.c0 = c0, g.s1 = s1, g.gamma0 = gamma0, g.simplified = simplified;
  g.prepare(rho0);
  return g;
}

EosPoint<double> at(double mu) { return {mu, 1 / (1 + mu), 0, 0, 0}; }

double pressure(const Gruneisen& g, double mu, double energy) {
  const LinearisedPressure<double> line = g.linearise(at(mu));
  return line.a + line.b * energy;
}

}  // namespace

TEST_CASE("states behind a shock lie on the equation of state", "[physics][gruneisen]") {
  for (const double up : {10.0, 200.0, 500.0, 1000.0, 3000.0, 6000.0}) {
    INFO("particle velocity " << up);
    const double us = c0 + s1 * up;
    const double rho = rho0 * us / (us - up);    // 2-60
    const double p = rho0 * us * up;             // 2-61
    const double energy = rho0 * 0.5 * up * up;  // 2-62 with p0 = e0 = 0, per unit initial volume
    CHECK(pressure(law(), rho / rho0 - 1, energy) == Approx(p).epsilon(1e-12));
  }
}

TEST_CASE("the cubic form expands the exact one to third order", "[physics][gruneisen]") {
  double last = 0;
  for (const double mu : {0.02, 0.01}) {
    const double exact = pressure(law(), mu, 1e8), cubic = pressure(law(true), mu, 1e8);
    const double error = std::abs(exact - cubic) / exact;
    if (last > 0) CHECK(std::log2(last / error) == Approx(3).margin(0.1));  // mu^4 over mu
    last = error;
  }
  CHECK(pressure(law(), -0.05, 1e8) == pressure(law(true), -0.05, 1e8));
  CHECK(pressure(law(), -0.05, 1e8) == Approx(-0.05 * rho0 * c0 * c0 + gamma0 * 1e8).epsilon(1e-14));
}

TEST_CASE("derivatives of the equation of state", "[physics][gruneisen]") {
  for (const bool simplified : {false, true}) {
    const Gruneisen g = law(simplified);
    for (const double mu : {-0.1, -1e-3, 1e-3, 0.1, 0.5, 1.0}) {
      INFO("mu " << mu << ", simplified " << simplified);
      const double h = 1e-6;  // error h^2 and 1e-16/h
      const double slope = (g.linearise(at(mu + h)).a - g.linearise(at(mu - h)).a) / (2 * h);
      CHECK(g.linearise(at(mu)).da == Approx(slope).epsilon(1e-8));
      CHECK(g.linearise(at(mu)).b == gamma0);
      CHECK(g.linearise(at(mu)).db == 0);
    }
  }
}

TEST_CASE("compression beyond the pole of the Hugoniot is counted and stays finite", "[physics][gruneisen]") {
  const auto material = make(copper("IsoHarden", true));
  PointDriver point(*material, {});
  const double pole = 1 / (s1 - 1);
  drive(point, {.kind = PathKind::hydrostatic, .targets = {-std::log(1.5 * (1 + pole))}, .steps = 4000},
        [](double) {});
  CHECK(point.events().undefined_root > 0);
  CHECK(point.events().not_finite == 0);
  CHECK(point.value(Column::pressure) > 0);

  core::MaterialInput input = copper("IsoHarden", true);
  input.failures.push_back({{"Pmin", {{"pmin", -1e15}}, {}}, false});
  const auto brittle = make(input);
  PointDriver failing(*brittle, {});
  drive(failing, {.kind = PathKind::hydrostatic, .targets = {-std::log(1.5 * (1 + pole))}, .steps = 4000},
        [](double) {});
  CHECK(failing.value(Column::failed) == 1);
  CHECK(failing.events().failed == 1);
}

TEST_CASE("tension without a limit ends with an undefined sound speed that is counted",
          "[physics][gruneisen]") {
  const auto material = make(sample("Null + Gruneisen").input);
  PointDriver point(*material, {});
  drive(point, {.kind = PathKind::hydrostatic, .targets = {0.6}, .steps = 600}, [](double) {});
  CHECK(point.events().undefined_root > 0);
  CHECK(point.events().not_finite == 0);
  CHECK(point.sound_speed() == material->initial_sound_speed());
}

}  // namespace mpm::tests
