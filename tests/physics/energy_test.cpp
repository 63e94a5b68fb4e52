// Energy and pressure solved together (thesis 2-82 to 2-92): isentropes with their order of convergence and
// the sound speed (2-57). The balance of energy against the work of the stresses stands in laws_test.cpp.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::PathKind;
using physics::PointDriver;

namespace {

constexpr double gas_energy = 250e6, gas_gamma = 1.4;

/// Error of p V^gamma after compression to about half the volume.
double isentrope_error(int steps) {
  const auto material = make(sample("Null + Polynomial gas").input);
  PointDriver point(*material, {});
  const double start = point.value(Column::pressure);
  drive(point, {.kind = PathKind::hydrostatic, .targets = {-0.7}, .steps = steps}, [](double) {});
  return std::abs(point.value(Column::pressure) * std::pow(point.volume_ratio(), gas_gamma) / start - 1);
}

}  // namespace

TEST_CASE("a gamma-law gas follows its isentrope with second order", "[physics][energy]") {
  PointDriver at_rest(*make(sample("Null + Polynomial gas").input), {});
  CHECK(at_rest.value(Column::pressure) == Approx((gas_gamma - 1) * gas_energy).epsilon(1e-14));
  const double coarse = isentrope_error(50), fine = isentrope_error(200);
  CHECK(fine < 1e-5);
  CHECK(std::log2(coarse / fine) / 2 == Approx(2).margin(0.05));
}

TEST_CASE("the sound speed of a gas is sqrt(gamma p / rho)", "[physics][energy]") {
  const auto material = make(sample("Null + Polynomial gas").input);
  PointDriver point(*material, {});
  drive(point, {.kind = PathKind::hydrostatic, .targets = {-0.5, 0.3}, .steps = 100}, [&](double) {
    CHECK(point.sound_speed() ==
          Approx(std::sqrt(gas_gamma * point.value(Column::pressure) / point.density())).epsilon(1e-12));
  });
}

TEST_CASE("the isentrope of Grueneisen copper converges with second order", "[physics][energy]") {
  // Against dE = -p dV by the classical Runge-Kutta rule on the equation itself (2-129).
  const double rho0 = 8960, c0 = 3940, s1 = 1.49, gamma0 = 1.96, volume = std::exp(-0.2);
  const auto pressure = [&](double v, double energy) {
    const double mu = 1 / v - 1;
    return rho0 * c0 * c0 * mu * (1 + (1 - gamma0 / 2) * mu) / std::pow(1 - (s1 - 1) * mu, 2) +
           gamma0 * energy;
  };
  double energy = 0, v = 1;
  const int steps = 2000;
  const double h = (volume - 1) / steps;
  for (int i = 0; i < steps; ++i, v += h) {
    const double k1 = -pressure(v, energy), k2 = -pressure(v + h / 2, energy + h / 2 * k1);
    const double k3 = -pressure(v + h / 2, energy + h / 2 * k2), k4 = -pressure(v + h, energy + h * k3);
    energy += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  const auto material = make(sample("Null + Gruneisen").input);
  const auto error = [&](int n) {
    PointDriver point(*material, {.update = {.volume_update = 2}});
    drive(point, {.kind = PathKind::hydrostatic, .targets = {-0.2}, .steps = n}, [](double) {});
    return std::abs(point.energy() / energy - 1);
  };
  const double coarse = error(50), fine = error(200);
  CHECK(fine < 1e-5);
  CHECK(std::log2(coarse / fine) / 2 == Approx(2).margin(0.05));
}

TEST_CASE("E0 is the energy at the start, whatever the density", "[physics][energy]") {
  core::MaterialInput input = copper("IsoHarden", true);
  input.eos->values["E0"] = 5e7;
  const auto material = make(input);
  for (const double ratio : {0.99, 1.0, 1.02}) {
    PointDriver point(*material, {.density = ratio * 8960});
    CHECK(point.energy() == 5e7);
    const double mu = ratio - 1, stiffness = 8960 * 3940.0 * 3940.0;
    const double cold = mu > 0 ? mu * (1 + (1 - 0.98) * mu) / std::pow(1 - 0.49 * mu, 2) : mu;
    CHECK(point.value(Column::pressure) == Approx(stiffness * cold + 1.96 * 5e7).epsilon(1e-12));
  }
}

}  // namespace mpm::tests
