// Time integration rules, on an oscillator of one node: m a = -k x.
#include "core/implicit/time_rule.hpp"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

namespace mpm::core {
namespace {

struct Oscillator {
  double m = 2, k = 8, x = 1, v = 0;
  double energy() const { return 0.5 * m * v * v + 0.5 * k * x * x; }
  void step(const TimeRule& rule) {
    // m (inertia u - start v) - carry f = -k (x + u), with f = -k x
    const double f = -k * x;
    const double u = (rule.start * m * v + rule.carry * f + f) / (rule.inertia * m + k);
    v = rule.gain * u + rule.keep * v + rule.push * f / m;
    x += u;
  }
};

double error_after_a_period(double dt_over_period, TimeRule (*rule)(double)) {
  Oscillator o;
  const double period = 2 * std::numbers::pi / std::sqrt(o.k / o.m);
  const int steps = static_cast<int>(std::lround(1 / dt_over_period));
  for (int i = 0; i < steps; ++i) o.step(rule(period / steps));
  return std::hypot(o.x - 1, o.v / std::sqrt(o.k / o.m));
}

TimeRule trapezoidal(double dt) { return TimeRule::newmark(0.25, 0.5, dt); }
TimeRule average(double dt) { return TimeRule::newmark(0.3025, 0.6, dt); }

TEST_CASE("The trapezoidal rule keeps the energy with steps of any length") {
  for (const double dt : {0.01, 1.0, 100.0}) {
    Oscillator o;
    const double before = o.energy();
    for (int i = 0; i < 1000; ++i) o.step(trapezoidal(dt));
    CHECK(o.energy() == Approx(before).epsilon(1e-10));
  }
}

TEST_CASE("Orders of the rules") {
  CHECK(std::log2(error_after_a_period(1e-2, trapezoidal) / error_after_a_period(5e-3, trapezoidal)) ==
        Approx(2).margin(0.05));
  CHECK(std::log2(error_after_a_period(1e-3, TimeRule::backward_euler) /
                  error_after_a_period(5e-4, TimeRule::backward_euler)) == Approx(1).margin(0.05));
  CHECK(std::log2(error_after_a_period(1e-3, average) / error_after_a_period(5e-4, average)) ==
        Approx(1).margin(0.05));
}

TEST_CASE("Backward Euler and Newmark's rule with gamma above one half lose energy") {
  for (TimeRule (*rule)(double) : {&TimeRule::backward_euler, &average}) {
    Oscillator o;
    double before = o.energy();
    for (int i = 0; i < 20; ++i) {
      o.step(rule(0.5));
      CHECK(o.energy() < before);
      before = o.energy();
    }
  }
}

}  // namespace
}  // namespace mpm::core
