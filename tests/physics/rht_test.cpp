// RHT concrete: its surfaces against values worked out apart from this code from the manual's formulas (3-21
// to 3-34) for its concrete of 35 MPa (table 6.8), in MPa; hardening, damage and the loss of stiffness
// against closed forms.

#include "physics/strength/rht.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/eos/list.hpp"
#include "physics/point/point_driver.hpp"
#include "physics/strength/rht.hpp"
#include "tests/physics/brittle_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::Sym3;
using physics::PointDriver;
using physics::RHT;

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

RHT concrete_35() {
  RHT law;
  law.young = 40e3, law.poisson = 0.2;
  law.fc = 35, law.ft = 0.1, law.fs = 0.18, law.a = 1.6, law.n = 0.61, law.q20 = 0.6805, law.bq = 0.0105;
  law.prefact = 2, law.tensrat = 0.7, law.comprat = 0.53, law.b = 1.6, law.m = 0.61;
  law.alpha = 0.032, law.delta = 0.036, law.epso = 1, law.d1 = 0.04, law.d2 = 1, law.efmin = 0.01;
  law.shratd = 0.13;
  law.prepare();
  law.cap_end = 23.3 / 35;
  return law;
}

/// A deviator of unit von Mises stress with the Lode angle theta: 0 in tension, 60 degrees in compression.
Sym3<double> direction(double theta) {
  const auto principal = [&](double turn) { return 2.0 / 3 * std::cos((theta - turn) * degree); };
  return {principal(0), principal(120), principal(240), 0, 0, 0};
}

/// The sample in SI with other constants, elastic in volume.
core::MaterialInput concrete(const core::ParameterValues& more) {
  core::MaterialInput input = sample("RHT").input;
  for (const auto& [name, value] : more) input.strength.values.insert_or_assign(name, value);
  return input;
}
constexpr double g = 40e9 / 2.4, k = 40e9 / 1.8, fc = 35e6;
const core::ParameterValues at_rest{{"alpha", 0.0}, {"delta", 0.0}};

}  // namespace

TEST_CASE("the cosine of a third of the angle", "[physics][rht]") {
  for (const double x : {-1.0, -0.9999999, -0.5, 0.0, 0.3, 0.999, 1.0}) {
    INFO("cos(3 theta) = " << x);
    CHECK(physics::cosine_of_lode_angle(x) == Approx(std::cos(std::acos(x) / 3)).epsilon(1e-14));
  }
}

TEST_CASE("RHT surfaces at tabulated pressures, Lode angles and rates", "[physics][rht]") {
  const RHT law = concrete_35();
  struct Row {
    double p, theta, rate, failure, elastic, residual, rate_factor;  // p over fc
  };
  const double tension = -0.1 / 3, third = 1.0 / 3;
  for (const Row& row : {Row{0, 60, 0, 6.3, 4.312636364, 0, 1},
                         {third, 60, 0, 35, 25.07234403, 28.65128216, 1},
                         {1, 60, 0, 60.31658503, 0, 56, 1},
                         {1, 0, 0, 41.67876026, 0, 56, 1},
                         {1, 30, 0, 46.53283974, 0, 56, 1},
                         {3, 30, 0, 88.81067357, 0, 109.4540894, 1},
                         {tension, 0, 0, 2.380525, 1.0950415, 0, 1},
                         {-0.05, 0, 0, 1.4279475, 0.14279475, 0, 1},
                         {0.1, 30, 0, 11.37107809, 9.63265719, 13.74636993, 1},
                         {0.5, 60, 1, 50.43315316, 31.4052327, 36.69101531, 1.395507323},
                         {1, 60, 100, 75.84831628, 0, 56, 1.617082286},
                         {-0.06, 0, 100, 4.564251543, 2.16701264, 0, 1.865621916},
                         {-0.2, 30, 1, 0, 0, 0, 1.580606031}}) {
    INFO("p* " << row.p << ", theta " << row.theta << ", rate " << row.rate);
    const Sym3<double> s = 7.0 * direction(row.theta);
    CHECK(mises(s) == Approx(7).epsilon(1e-14));
    const auto y = law.surfaces(row.p * 35, s, mises(s), row.rate);
    CHECK(law.rate_factor(row.p, row.rate) == Approx(row.rate_factor).epsilon(1e-9));
    CHECK(y.failure == Approx(row.failure).epsilon(1e-9).margin(1e-9));
    CHECK(y.elastic == Approx(row.elastic).epsilon(1e-9).margin(1e-9));
    CHECK(y.residual == Approx(row.residual).epsilon(1e-9).margin(1e-9));
    CHECK(y.tip == Approx(-2.625 * row.rate_factor).epsilon(1e-9));
  }
}

TEST_CASE("RHT failure surface meets fc, fs and ft, and its parts meet each other", "[physics][rht]") {
  const RHT law = concrete_35();
  const double tension = -0.1 / 3, third = 1.0 / 3;
  CHECK(law.compressive_meridian(third) == Approx(1).epsilon(1e-14));
  CHECK(law.compressive_meridian(0.0) == Approx(0.18).epsilon(1e-14));
  CHECK(law.compressive_meridian(tension) == Approx(0.1).epsilon(1e-14));
  CHECK(law.compressive_meridian(-0.075) == Approx(0).margin(1e-15));  // the tip, -ft fs/(3 (fs - ft))
  for (const double p : {tension, 0.0, third}) {
    INFO("p* " << p);
    const double h = 1e-10;
    CHECK(law.compressive_meridian(p - h) == Approx(law.compressive_meridian(p + h)).epsilon(1e-8));
    CHECK(law.rate_factor(p - h, 50.0) == Approx(law.rate_factor(p + h, 50.0)).epsilon(1e-8));
    CHECK(law.cap(p - h) == Approx(law.cap(p + h)).epsilon(1e-8));
  }
}

TEST_CASE("RHT Lode angle: ratio of the meridians, smooth and convex between", "[physics][rht]") {
  RHT law = concrete_35();
  for (const double q : {0.5, 0.6805, 0.8, 1.0}) {
    law.q20 = q, law.bq = 0;
    const auto ratio = [&](double theta) {
      const Sym3<double> s = direction(theta);
      return law.meridian_ratio(0.0, s, mises(s));
    };
    INFO("Q " << q);
    CHECK(ratio(0) == Approx(q).epsilon(1e-12));
    CHECK(ratio(60) == Approx(1).epsilon(1e-7));  // cos(theta) has a root's accuracy there
    double before = ratio(0);
    for (double theta = 0.5; theta <= 60; theta += 0.5) {
      const double now = ratio(theta);
      CHECK(now >= before * (1 - 1e-12));
      // Convex in the deviatoric plane: 1/r + (1/r)'' >= 0 in polar coordinates.
      if (theta < 60) {
        const double h = 0.5 * degree, here = 1 / now;
        const double bend = (1 / ratio(theta + 0.5) - 2 * here + 1 / before) / (h * h);
        CHECK(here + bend > -1e-3);
      }
      before = now;
    }
  }
  law.q20 = 0.6805, law.bq = 0.0105;  // grows with the pressure, up to a circle and no further
  const Sym3<double> s = direction(0);
  CHECK(law.meridian_ratio(10.0, s, 1.0) == Approx(0.7855).epsilon(1e-12));
  CHECK(law.meridian_ratio(100.0, s, 1.0) == Approx(1).epsilon(1e-12));
}

TEST_CASE("RHT hardens from the elastic to the failure surface, with the slope of PREFACT",
          "[physics][rht]") {
  // 3-29 with 3-30: d(yield)/d(epef) = 3 G/PREFACT, hence d(stress)/d(strain) = 3 G/(PREFACT + 1).
  const auto material = make(concrete(at_rest));
  for (const double p : {0.0, 0.2, 1.0}) {
    INFO("p* " << p);
    PointDriver point(*material, {});
    if (p > 0) compress_to(point, 1 - p * fc / k);
    RHT law = concrete_35();
    law.cap_flag = 0;
    const auto y = law.surfaces(p * 35, direction(30), 1.0, 0.0);
    const double elastic = y.elastic * 1e6, failure = y.failure * 1e6;
    const double to_failure = elastic / (3 * g) + (failure - elastic) / g;
    double strain = 0;
    for (const double share : {0.1, 0.25, 0.4, 0.7, 0.99}) {
      shear_by(point, share * to_failure - strain);
      strain = share * to_failure;
      const double expected =
          strain < elastic / (3 * g) ? 3 * g * strain : elastic + g * (strain - elastic / (3 * g));
      CHECK(mises(point.deviator()) == Approx(expected).epsilon(1e-9));
      CHECK(point.value(Column::damage) == 0);
    }
    // A step across the failure surface: what is left of it after hardening breaks.
    const double beyond = 1e-4;
    shear_by(point, to_failure + beyond - strain);
    CHECK(mises(point.deviator()) == Approx(failure).epsilon(1e-9));
    const double ef = std::max(0.04 * (p + 0.1), 0.01);
    CHECK(point.value(Column::damage) == Approx(beyond / ef).epsilon(1e-6));
  }
}

TEST_CASE("RHT damage in shear at constant pressure follows its closed form", "[physics][rht]") {
  // With SHRATD = 1 as for HJC: from the failure surface on, strain = Y/(3 G) + epef is linear in D.
  core::ParameterValues values = at_rest;
  values["SHRATD"] = 1;
  const auto material = make(concrete(values));
  RHT law = concrete_35();
  law.cap_flag = 0;
  const auto y = law.surfaces(35.0 / 2, direction(30), 1.0, 0.0);
  const double elastic = y.elastic * 1e6, failure = y.failure * 1e6, residual = y.residual * 1e6;
  const double ef = 0.04 * 0.6;
  const double strain =
      elastic / (3 * g) + (failure - elastic) / g + 0.6 * (ef - (failure - residual) / (3 * g));
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const int steps = 400 << level;
    PointDriver point(*material, {});
    compress_to(point, 1 - 0.5 * fc / k);
    for (int i = 0; i < steps; ++i) shear_by(point, strain / steps);
    error[level] = std::abs(point.value(Column::damage) - 0.6);
    CHECK(mises(point.deviator()) == Approx(0.4 * failure + 0.6 * residual).epsilon(2e-3));
    // And all the way: nothing but the residual strength is left.
    for (int i = 0; i < steps; ++i) shear_by(point, strain / steps);
    CHECK(point.value(Column::damage) == 1);
    CHECK(mises(point.deviator()) == Approx(residual).epsilon(1e-9));
  }
  CHECK(error[0] < 2e-3);
  CHECK(error[1] < 0.6 * error[0]);
}

TEST_CASE("RHT strength follows the rate of the whole strain", "[physics][rht]") {
  const auto material = make(concrete({}));
  const RHT law = concrete_35();
  for (const double rate : {1e-7, 1e-4, 1.0, 1e3}) {
    INFO("rate " << rate << " /s");
    PointDriver point(*material, {});
    shear_by(point, 0.01, 0.01 / rate);
    // At no pressure: 0.18 fc Fr R3, with Fr ft/(1 + ft) of the way from tension to compression.
    const double tension = std::pow(std::max(rate / 3e-6, 1.0), 0.036),
                 compression = std::pow(std::max(rate / 3e-5, 1.0), 0.032);
    const double fr = tension + 0.1 / 1.1 * (compression - tension);
    CHECK(mises(point.deviator()) ==
          Approx(0.18 * fc * fr * law.meridian_ratio(0.0, direction(30), 1.0)).epsilon(1e-9));
  }
}

TEST_CASE("RHT loses shear stiffness with damage", "[physics][rht]") {
  const auto material = make(concrete(at_rest));
  PointDriver point(*material, {});
  compress_to(point, 1 - 0.5 * fc / k);
  for (int i = 0; i < 200; ++i) {
    shear_by(point, 1e-4);
    if (i % 50 != 49) continue;
    const double damage = point.value(Column::damage), before = mises(point.deviator());
    const PointDriver::State state = point.save();
    shear_by(point, -1e-6);
    CHECK((before - mises(point.deviator())) / 1e-6 ==
          Approx(3 * g * (1 - damage + 0.13 * damage)).epsilon(1e-6));
    CHECK(point.value(Column::damage) == damage);
    point.restore(state);
  }
  CHECK(point.value(Column::damage) > 0.5);
}

TEST_CASE("RHT tension ends at the tip of the failure surface, and with damage at nothing",
          "[physics][rht]") {
  const auto material = make(concrete(at_rest));
  PointDriver point(*material, {});
  compress_to(point, 1 + 2e6 / k);
  CHECK(point.value(Column::pressure) == Approx(-2e6).epsilon(1e-9));
  compress_to(point, 1 + 20e6 / k);
  CHECK(point.value(Column::pressure) == Approx(-2.625e6).epsilon(1e-9));
  for (int i = 0; i < 30; ++i) shear_by(point, 1e-3);
  CHECK(point.value(Column::damage) == 1);
  CHECK(point.value(Column::pressure) == 0);
  CHECK(mises(point.deviator()) == 0);
}

TEST_CASE("RHT with a cap needs the crush pressure of its equation of state", "[physics][rht]") {
  CHECK_THROWS_WITH(make(concrete({{"CapFlag", 1.0}})), Catch::Contains("set CapFlag to 0"));
  core::MaterialInput input = sample("RHT + PAlpha").input;
  const auto material = make(input);
  CHECK(physics::law_cast<RHT>(*material->laws().strength)->cap_end == Approx(23.3 / 35).epsilon(1e-14));
  input.eos->values["Pcrush"] = 11e6;
  CHECK_THROWS_WITH(make(input), Catch::Contains("above fc/3"));
  CHECK_THROWS_WITH(make(concrete({{"fs_fc", 0.1}})), Catch::Contains("fs_fc must be greater than ft_fc"));
}

}  // namespace mpm::tests
