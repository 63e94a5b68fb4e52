// Johnson-Cook: flow curves at three rates, adiabatic and isothermal, and the damage law, against manual 3-2
// to 3-5.

#include <algorithm>
#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::PathKind;
using physics::PointDriver;

namespace {

constexpr double a = 90e6, b = 292e6, n = 0.31, c = 0.025, m = 1.09, room = 293, melt = 1356;
constexpr double heat = 0.9 / (8960 * 383.0);
constexpr double d1 = 0.54, d2 = 4.89, d3 = -3.03, d4 = 0.014, d5 = 1.12;
constexpr std::array rates{0.5, 1e2, 1e5};  // 1/s; the first below the reference rate

double log_rate(double rate) { return std::log(std::max(rate, 1.0)); }
double homologous(double temperature) { return std::clamp((temperature - room) / (melt - room), 0.0, 1.0); }
double flow_stress(double strain, double rate, double temperature) {
  return (a + b * std::pow(strain, n)) * (1 + c * log_rate(rate)) *
         (1 - std::pow(homologous(temperature), m));
}

core::MaterialInput isothermal(const std::string& law) {
  core::MaterialInput input = copper(law);
  input.strength.values["PlasticWorkCoefficient"] = 0;
  return input;
}

/// Pure shear without spin; the path's strain is the equivalent strain.
physics::Path pure_shear(double rate, double strain, int steps) {
  const double component = 0.5 * std::sqrt(3.0);
  return {.kind = PathKind::gradient,
          .rate = rate,
          .targets = {strain},
          .steps = steps,
          .gradient = {0, component, 0, component, 0, 0, 0, 0, 0}};
}

/// Temperature after plastic strain at a constant plastic rate: dT/d(strain) = heat * flow stress, classical
/// Runge-Kutta. The strain is t^3, which makes the right-hand side smooth at zero.
double adiabatic_temperature(double strain, double rate) {
  const int steps = 2000;
  const double end = std::cbrt(strain), h = end / steps;
  const auto slope = [&](double t, double temperature) {
    return heat * flow_stress(t * t * t, rate, temperature) * 3 * t * t;
  };
  double temperature = room;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const double k1 = slope(t, temperature), k2 = slope(t + h / 2, temperature + h / 2 * k1);
    const double k3 = slope(t + h / 2, temperature + h / 2 * k2), k4 = slope(t + h, temperature + h * k3);
    temperature += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return temperature;
}

/// Walks pure shear and returns the largest relative distance from the flow stress of the state reached.
double worst_distance(PointDriver& point, const physics::Path& path) {
  double worst = 0, epef = 0, time = 0;
  drive(point, path, [&](double) {
    const double next = point.value(Column::effective_plastic_strain);
    const double temperature = point.has(Column::temperature) ? point.value(Column::temperature) : room;
    if (next > epef) {
      const double expected = flow_stress(next, (next - epef) / (point.time() - time), temperature);
      worst = std::max(worst, std::abs(mises(point.deviator()) / expected - 1));
    }
    epef = next;
    time = point.time();
  });
  return worst;
}

}  // namespace

TEST_CASE("isothermal flow curves at three rates", "[physics][johnson-cook]") {
  for (const char* law : {"SimJohnsonCook", "JohnsonCook"}) {
    const auto material = make(isothermal(law));
    for (const double rate : rates) {
      INFO(law << " at " << rate << "/s");
      PointDriver point(*material, {});
      CHECK(worst_distance(point, pure_shear(rate, 0.3, 600)) < 1e-10);
      // Far beyond yield the plastic rate is the total rate, but for the elastic part of the hardening.
      const double epef = point.value(Column::effective_plastic_strain);
      CHECK(epef == Approx(0.3).epsilon(0.02));
      CHECK(mises(point.deviator()) == Approx(flow_stress(epef, rate, room)).epsilon(1e-4));
    }
  }
}

TEST_CASE("adiabatic flow curves at three rates", "[physics][johnson-cook]") {
  const auto material = make(copper("JohnsonCook"));
  for (const double rate : rates) {
    INFO(rate << "/s");
    PointDriver point(*material, {});
    CHECK(worst_distance(point, pure_shear(rate, 1.0, 1000)) < 1e-10);
    const double epef = point.value(Column::effective_plastic_strain);
    const double temperature = adiabatic_temperature(epef, rate);
    CHECK(temperature > 350);
    // The rate of the reference is that of the path; the elastic part changes it by 1e-3, the stress by 1e-4.
    CHECK(point.value(Column::temperature) - room == Approx(temperature - room).epsilon(2e-4));
    CHECK(mises(point.deviator()) == Approx(flow_stress(epef, rate, temperature)).epsilon(2e-4));
  }
}

TEST_CASE("heating converges with second order", "[physics][johnson-cook]") {
  // A constant flow stress but for heat, B = C = 0, so that the path has no kink but the first yield.
  core::MaterialInput input = copper("JohnsonCook");
  input.strength.values["B"] = 0;
  input.strength.values["C"] = 0;
  input.strength.values["Yield0"] = 500e6;
  const auto material = make(input);
  const auto temperature = [&](int steps) {
    PointDriver point(*material, {});
    drive(point, pure_shear(1e4, 2.0, steps), [](double) {});
    return point.value(Column::temperature);
  };
  const double exact = temperature(25600);
  const double coarse = std::abs(temperature(100) - exact), fine = std::abs(temperature(400) - exact);
  CHECK(coarse / (exact - room) < 1e-3);
  CHECK(std::log2(coarse / fine) / 2 > 1.8);
}

TEST_CASE("damage follows triaxiality, rate and temperature, and fails the particle at one",
          "[physics][johnson-cook]") {
  const auto material = make(copper("JohnsonCook damaged"));
  const double rate = 1e3;
  for (const double compression : {0.0, 0.001, -0.001}) {
    INFO("volumetric strain " << -compression);
    PointDriver point(*material, {});
    drive(point, {.kind = PathKind::hydrostatic, .rate = rate, .targets = {-compression}, .steps = 10},
          [](double) {});
    double expected = 0, epef = 0, time = point.time(), temperature = room, worst = 0;
    bool failed = false;
    drive(point, pure_shear(rate, 20, 20000), [&](double) {
      const double next = point.value(Column::effective_plastic_strain);
      if (failed || point.value(Column::failed) > 0) {
        failed = true;
        return;
      }
      if (next > epef) {
        const double plastic_rate = (next - epef) / (point.time() - time);
        const double triaxiality = -point.value(Column::pressure) / mises(point.deviator());
        const double failure_strain = (d1 + d2 * std::exp(d3 * triaxiality)) *
                                      (1 + d4 * log_rate(plastic_rate)) *
                                      (1 + d5 * std::pow(homologous(temperature), m));
        expected += (next - epef) / failure_strain;
        worst = std::max(worst, std::abs(point.value(Column::damage) - expected));
      }
      epef = next;
      time = point.time();
      temperature = point.value(Column::temperature);
    });
    CHECK(worst < 1e-10);
    if (compression > 0) continue;  // heat softens it, triaxiality grows, and it never fails
    CHECK(failed);
    CHECK(expected > 0.999);
    CHECK(point.value(Column::damage) == 1);
    CHECK(point.value(Column::failed) == 1);
    CHECK(point.events().failed == 1);
    CHECK(mises(point.deviator()) == 0);
  }
}

TEST_CASE("damage without heat reaches one at the failure strain", "[physics][johnson-cook]") {
  const auto material = make(isothermal("JohnsonCook damaged"));
  PointDriver point(*material, {});
  double last_intact = 0;
  drive(point, pure_shear(0.5, 10, 4000), [&](double) {
    if (point.value(Column::failed) == 0) last_intact = point.value(Column::effective_plastic_strain);
  });
  CHECK(last_intact == Approx(d1 + d2).margin(10.0 / 4000));  // within a step
}

TEST_CASE("a molten particle has no shear stress and stays finite", "[physics][johnson-cook]") {
  for (const char* law : {"JohnsonCook", "JohnsonCook damaged"}) {
    const auto material = make(copper(law));
    PointDriver point(*material, {});
    point.set(Column::temperature, melt - 1);
    drive(point, pure_shear(1e4, 20.0, 2000), [](double) {});
    CHECK(point.value(Column::temperature) <= melt + 1);
    CHECK(mises(point.deviator()) < 1e-2 * a);
    point.set(Column::temperature, 2 * melt);
    drive(point, pure_shear(1e4, 0.1, 100), [](double) {});
    CHECK(mises(point.deviator()) <= 1e-9 * a);
    CHECK(point.events().not_finite == 0);
  }
}

TEST_CASE("flow below the reference rate is that of the reference rate", "[physics][johnson-cook]") {
  const auto material = make(isothermal("SimJohnsonCook"));
  PointDriver slow(*material, {}), slower(*material, {});
  drive(slow, pure_shear(0.9, 0.1, 200), [](double) {});
  drive(slower, pure_shear(1e-6, 0.1, 200), [](double) {});
  CHECK(mises(slow.deviator()) == Approx(mises(slower.deviator())).epsilon(1e-10));
}

}  // namespace mpm::tests
