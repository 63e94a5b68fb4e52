// Time integration rules, on an oscillator of one node: m a = -k x.
#include "core/implicit/time_rule.hpp"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

namespace mpm::core {
namespace {

struct Oscillator {
  double m = 2, k = 8, x = 1, v = 0, lag = 0, load = 0;
  double energy() const { return 0.5 * m * v * v + 0.5 * k * x * x; }
  void step(const TimeRule& rule) {
    // m (inertia u - start v - recall lag) - carry f = load - k (x + u), with f = load - k x
    const double f = load - k * x;
    const double u = (m * (rule.start * v + rule.recall * lag) + rule.carry * f + f) / (rule.inertia * m + k);
    const double at_end = rule.force_at_end(u, v, f / m, lag);
    CHECK(at_end * m == Approx(load - k * (x + u)).epsilon(1e-9).margin(1e-9 * k));
    v = rule.gain * u + rule.keep * v + rule.push * (f / m + lag);
    lag = rule.fresh * (at_end - f / m) - rule.fade * lag;
    x += u;
  }
};

/// Chung and Hulbert's method as they state it, with the acceleration.
struct AsPublished {
  double m = 2, k = 8, x = 1, v = 0, a = -4;
  void step(double radius, double dt) {
    const double am = (2 * radius - 1) / (radius + 1), af = radius / (radius + 1);
    const double gamma = 0.5 - am + af, beta = 0.25 * (1 - am + af) * (1 - am + af);
    const double ahead = x + dt * v + dt * dt * (0.5 - beta) * a;
    const double right = -m * am * a - k * ((1 - af) * ahead + af * x);
    const double now = right / (m * (1 - am) + k * (1 - af) * beta * dt * dt);
    x = ahead + dt * dt * beta * now;
    v += dt * ((1 - gamma) * a + gamma * now);
    a = now;
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

template <int percent>
TimeRule alpha(double dt) {
  return TimeRule::generalised_alpha(percent / 100.0, dt);
}

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

TEST_CASE("Generalised alpha is the published method, and of second order") {
  for (const double radius : {0.0, 0.3, 0.8, 1.0}) {
    Oscillator mine;
    AsPublished published;
    for (int i = 0; i < 50; ++i) {
      const double dt = 0.3;
      mine.step(TimeRule::generalised_alpha(radius, dt));
      published.step(radius, dt);
      CHECK(mine.x == Approx(published.x).margin(1e-12));
      CHECK(mine.v == Approx(published.v).margin(1e-12));
      CHECK(mine.lag - mine.k * mine.x / mine.m == Approx(published.a).margin(1e-11));
    }
  }
  for (TimeRule (*rule)(double) : {&alpha<0>, &alpha<50>, &alpha<90>, &alpha<100>})
    CHECK(std::log2(error_after_a_period(5e-3, rule) / error_after_a_period(2.5e-3, rule)) ==
          Approx(2).margin(0.05));
}

TEST_CASE("Generalised alpha leaves the stated part of what a long step does not resolve") {
  for (const double radius : {0.0, 0.5, 0.9}) {
    Oscillator o;
    const TimeRule rule = TimeRule::generalised_alpha(radius, 1e4);
    // The three roots are equal in the limit, so that a factor of the number of steps squared remains.
    double before = 0;
    for (int i = 0; i < 400; ++i) {
      before = std::abs(o.x);
      o.step(rule);
      if (std::abs(o.x) < 1e-250) break;
    }
    if (radius > 0) CHECK(std::abs(o.x) / before == Approx(radius).epsilon(0.02));
    CHECK(std::abs(o.x) < std::max(1e-9, 1e6 * std::pow(radius, 400)));
  }
}

TEST_CASE("With spectral radius 1 generalised alpha is the trapezoidal rule") {
  const TimeRule one = TimeRule::generalised_alpha(1, 0.7), other = trapezoidal(0.7);
  for (double TimeRule::*member : {&TimeRule::inertia, &TimeRule::start, &TimeRule::carry, &TimeRule::gain,
                                   &TimeRule::keep, &TimeRule::push, &TimeRule::fresh})
    CHECK(one.*member == Approx(other.*member).margin(1e-14));
}

TEST_CASE("A constant load acts in full, whatever the spectral radius") {
  for (const double radius : {0.0, 0.6, 1.0}) {
    Oscillator falling;
    falling.k = falling.x = 0;
    falling.load = 3;
    const double dt = 0.2;
    for (int i = 0; i < 10; ++i) falling.step(TimeRule::generalised_alpha(radius, dt));
    CHECK(falling.v == Approx(1.5 * 2));
    CHECK(falling.x == Approx(0.5 * 1.5 * 4));
  }
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
