// Polynomial2 against its formula (manual 3-45, 3-46) in either branch and at the joint, and its slopes,
// which make the sound speed.

#include "physics/eos/polynomial2.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::PointDriver;

namespace {

// Water: A1 and T1 its bulk modulus, the others of a size that shows.
constexpr double a1 = 2.2e9, a2 = 9.54e9, a3 = 14.57e9, b0 = 0.28, b1 = 0.31, t1 = 2.0e9, t2 = -1.5e9;
constexpr double density = 1000, e0 = 3e8;

core::MaterialInput water(double energy) {
  core::MaterialInput input;
  input.name = "water";
  input.reference_density = density;
  input.strength.type = "Null";
  input.eos = core::LawInput{
      "Polynomial2",
      {{"A1", a1}, {"A2", a2}, {"A3", a3}, {"B0", b0}, {"B1", b1}, {"T1", t1}, {"T2", t2}, {"E0", energy}},
      {}};
  return input;
}

double formula(double mu, double energy) {
  if (mu >= 0) return a1 * mu + a2 * mu * mu + a3 * mu * mu * mu + (b0 + b1 * mu) * energy;
  return t1 * mu + t2 * mu * mu + b0 * energy;
}

}  // namespace

TEST_CASE("Polynomial2 is its formula in compression and in tension", "[physics][polynomial2]") {
  for (const double energy : {0.0, e0}) {
    const auto material = make(water(energy));
    for (const double mu : {-0.4, -0.1, -1e-3, 1e-3, 0.05, 0.3, 1.0}) {
      INFO("mu " << mu << ", E " << energy);
      PointDriver point(*material, {.density = (1 + mu) * density});
      // mu comes out of a division: 1e-16 of 1, times the stiffness.
      CHECK(point.value(Column::pressure) == Approx(formula(mu, energy)).epsilon(1e-12));
    }
  }
}

TEST_CASE("Polynomial2 is continuous where tension begins", "[physics][polynomial2]") {
  const auto material = make(water(e0));
  const double mu = 1e-9;
  const auto at = [&](double m) {
    return PointDriver(*material, {.density = (1 + m) * density}).value(Column::pressure);
  };
  CHECK(at(0) == Approx(b0 * e0).epsilon(1e-12));
  CHECK(std::abs(at(mu) - at(-mu)) < 1.01 * (a1 + b1 * e0 + t1) * mu);
}

TEST_CASE("the sound speed of Polynomial2 is that of its isentrope", "[physics][polynomial2]") {
  // c^2 = dp/drho at constant entropy, thesis 2-57: (1 + mu)(dp/dmu) + p/(1 + mu) dp/dE, over rho.
  for (const double mu : {-0.2, -0.01, 0.01, 0.2, 0.7}) {
    INFO("mu " << mu);
    const auto material = make(water(e0));
    PointDriver point(*material, {.density = (1 + mu) * density});
    const double h = 1e-6, p = formula(mu, e0);
    const double slope = (formula(mu + h, e0) - formula(mu - h, e0)) / (2 * h);
    const double by_energy = mu >= 0 ? b0 + b1 * mu : b0;
    const double modulus = (1 + mu) * slope + p / (1 + mu) * by_energy;
    CHECK(point.sound_speed() == Approx(std::sqrt(modulus / point.density())).epsilon(1e-8));
  }
}

TEST_CASE("tension that turns back has no sound speed and is counted", "[physics][polynomial2]") {
  core::MaterialInput input = water(0);
  input.eos->values["T2"] = 4e9;  // p falls to mu = -0.25 and rises from there on
  const auto material = make(input);
  PointDriver point(*material, {});
  drive(point, {.kind = physics::PathKind::hydrostatic, .targets = {0.2}, .steps = 200}, [](double) {});
  CHECK(point.events().undefined_root == 0);
  drive(point, {.kind = physics::PathKind::hydrostatic, .targets = {0.3}, .steps = 200}, [](double) {});
  CHECK(point.events().undefined_root > 0);
  CHECK(point.events().not_finite == 0);
}

}  // namespace mpm::tests
