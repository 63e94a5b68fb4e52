// The limiter of the artificial viscosity: where its factor is 0, where near 1, and that nothing else
// changes.

#include "physics/material/viscosity_limiter.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "core/tensor/tensor.hpp"
#include "physics/checks/law_checks.hpp"
#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::Mat3;
using physics::PointDriver;

namespace {

constexpr double pi = 3.14159265358979323846, cell = 1e-3;

core::MaterialInput limited(core::MaterialInput input) {
  input.limiter = core::ViscosityLimiter::shock;
  return input;
}

Mat3<double> uniaxial(double rate) { return {rate, 0, 0, 0, 0, 0, 0, 0, 0}; }
double factor(const PointDriver& point) { return point.value(Column::viscosity_factor); }

/// Largest factor while rate(t) acts for `steps` steps along x.
template <class Rate>
double largest_factor(PointDriver& point, Rate rate, double dt, int steps) {
  double largest = 0;
  for (int i = 0; i < steps; ++i) {
    point.step(uniaxial(rate((i + 0.5) * dt)), dt);
    REQUIRE(factor(point) >= 0);
    REQUIRE(factor(point) <= 1);
    largest = std::max(largest, factor(point));
  }
  return largest;
}

/// The equations in the head of viscosity_limiter.hpp, for one particle.
double expected_factor(double alpha, double before, const Mat3<double>& l, double c, double dt) {
  const double d = l.xx + l.yy + l.zz;
  double s2 = 0;
  const double v[3][3] = {{l.xx, l.xy, l.xz}, {l.yx, l.yy, l.yz}, {l.zx, l.zy, l.zz}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) s2 += std::pow(0.5 * (v[i][j] + v[j][i]) - (i == j ? d / 3 : 0), 2);
  const double r = d < 0 ? -1 : 1, own = std::pow(2 * std::pow(1 - r, 4) * d, 2);
  const double growth = alpha < 0 ? d * d : std::max((before - d) / dt, 0.0);
  const double a = (own > 0 ? own / (own + s2) : 0) * growth, width = physics::shock_width * cell;
  const double signal = c + cell * std::max(-d, 0.0);
  const double local = std::min(width * width * a / (signal * signal), 1.0);
  const double old = std::max(alpha, 0.0);
  if (old <= local) return local;
  const double tau = cell / (2 * 0.05 * signal);
  return local + (old - local) / (1 + dt / tau);
}

}  // namespace

TEST_CASE("the factor is that of the equations", "[physics][viscosity]") {
  for (const char* label : {"IsoHarden", "Null + Polynomial gas"}) {
    INFO(label);
    const auto material = make(limited(sample(label).input));
    const double c = material->initial_sound_speed(), rate = 0.05 * c / cell, dt = 1e-4 * cell / c;
    const std::vector<Mat3<double>> gradients{
        uniaxial(-rate),
        {-rate, 3 * rate, 0, -rate, -0.2 * rate, rate, 0, 2 * rate, 0.1 * rate},
        {-0.01 * rate, 30 * rate, 0, 0, 0, 0, 0, 0, 0},
        {-rate, 0, 0, 0, -rate, 0, 0, 0, -rate},
        uniaxial(rate)};
    for (const Mat3<double>& l : gradients) {
      for (const double alpha : {-1.0, 0.0, 0.4, 1.0}) {
        // The second: dD/dt at which alpha_loc is below 1. The step is so short that c is that at rest.
        for (const double before : {-2 * rate, l.xx + l.yy + l.zz + 1e-2 * dt * c * c / cell / cell, rate}) {
          PointDriver point(*material, {.cell_size = cell});
          point.set(Column::viscosity_factor, alpha);
          point.set(Column::velocity_divergence, before);
          point.step(l, dt);
          CHECK(factor(point) ==
                Approx(expected_factor(alpha, before, l, c, dt)).epsilon(1e-4).margin(1e-12));
          CHECK(point.value(Column::velocity_divergence) == Approx(l.xx + l.yy + l.zz).epsilon(1e-12));
        }
      }
    }
  }
}

TEST_CASE("smooth isentropic compression hardly has viscosity", "[physics][viscosity]") {
  const auto material = make(limited(sample("Null + Polynomial gas").input));
  const double c = material->initial_sound_speed(), dt = 0.4 * cell / c;
  // A sound wave of a hundred cells and a hundredth of the sound speed: of its own time scale, no shock.
  const double omega = 2 * pi * c / (100 * cell);
  PointDriver wave(*material, {.cell_size = cell});
  CHECK(largest_factor(
            wave, [&](double t) { return -0.01 * omega * std::sin(omega * t); }, dt, 500) < 2e-3);
  // Compression at a constant rate, from the first step on: a fifth of the volume.
  PointDriver steady(*material, {.cell_size = cell});
  CHECK(largest_factor(
            steady, [&](double) { return -1e-3 * c / cell; }, dt, 500) < 1e-3);
  CHECK(steady.volume_ratio() < 0.85);
  CHECK(factor(steady) < 1e-6);
}

TEST_CASE("a shock has nearly all of its viscosity", "[physics][viscosity]") {
  // A front three cells wide, dv = c/4, at 1.4 c: a copper bar that hits a wall at 1000 m/s.
  const auto material = make(limited(sample("Null + Gruneisen").input));
  const double c = material->initial_sound_speed(), dt = 0.2 * cell / c, width = 3 * cell, speed = 1.4 * c;
  const auto rate = [&](double t) {
    return -0.25 * c / width / std::pow(std::cosh(2 * (speed * t - 4 * width) / width), 2);
  };
  PointDriver point(*material, {.cell_size = cell});
  const int to_the_middle = static_cast<int>(4 * width / speed / dt);
  largest_factor(point, rate, dt, to_the_middle);
  CHECK(factor(point) > 0.85);  // where the compression is fastest
  const double peak = factor(point);
  // It goes in about ten crossings of a cell by sound.
  largest_factor(point, rate, dt, to_the_middle);
  const double behind = factor(point);
  CHECK(behind < peak);
  largest_factor(
      point, [](double) { return 0.0; }, dt, 250);
  CHECK(factor(point) < 0.01 * behind);
  CHECK(factor(point) > 0);
}

TEST_CASE("rotation, shear and expansion have no viscosity", "[physics][viscosity]") {
  const auto material = make(limited(copper("IsoHarden", true)));
  const double c = material->initial_sound_speed(), rate = 0.01 * c / cell, dt = 0.2 * cell / c;
  for (const Mat3<double>& l :
       {Mat3<double>{0, -rate, 0, rate, 0, 0, 0, 0, 0}, Mat3<double>{0, rate, 0, 0, 0, 0, 0, 0, 0},
        Mat3<double>{rate, 0, 0, 0, -rate, 0, 0, 0, 0}, uniaxial(rate)}) {
    PointDriver point(*material, {.cell_size = cell});
    for (int i = 0; i < 20; ++i) {
      point.step((1 + 0.1 * i) * l, dt);
      CHECK(factor(point) == 0);
      CHECK(point.value(Column::viscous_pressure) == 0);
    }
  }
}

TEST_CASE("shear takes the viscosity from compression that is slower", "[physics][viscosity]") {
  const auto material = make(limited(sample("Null + Gruneisen").input));
  const double c = material->initial_sound_speed(), rate = 1e-3 * c / cell, dt = 0.2 * cell / c;
  const auto after = [&](double shear) {
    PointDriver point(*material, {.cell_size = cell});
    point.step({0, shear, 0, 0, 0, 0, 0, 0, 0}, dt);
    point.step({-rate, shear, 0, 0, 0, 0, 0, 0, 0}, dt);
    return factor(point);
  };
  CHECK(after(0) > 0.15);
  CHECK(after(rate) == Approx(after(0)).epsilon(1e-2));
  CHECK(after(1000 * rate) < 0.01 * after(0));
}

TEST_CASE("the factor acts on both terms, and not on the critical speed", "[physics][viscosity]") {
  for (const bool quadratic : {true, false}) {
    core::MaterialInput input = copper("IsoHarden", true);
    input.strength.values[quadratic ? "bq2" : "bq1"] = 0;
    const auto plain = make(input), with = make(limited(input));
    PointDriver a(*plain, {.cell_size = cell}), b(*with, {.cell_size = cell});
    const double dt = 0.2 * cell / plain->initial_sound_speed();
    a.step(uniaxial(-1e4), dt), b.step(uniaxial(-1e4), dt);
    REQUIRE(factor(b) > 1e-5);
    CHECK(b.value(Column::viscous_pressure) ==
          Approx(factor(b) * a.value(Column::viscous_pressure)).epsilon(1e-12));
    CHECK(b.critical_speed() == Approx(a.critical_speed()).epsilon(1e-6));  // heated differently
  }
}

TEST_CASE("the factor does not depend on the frame", "[physics][viscosity][objectivity]") {
  const auto material = make(limited(sample("Null + Gruneisen").input));
  const double c = material->initial_sound_speed(), dt = 0.2 * cell / c;
  const core::Mat3<double> q = core::mid_point_rotation(core::Vec3<double>{0.3, -1.1, 0.7});
  const core::Mat3<double> back{q.xx, q.yx, q.zx, q.xy, q.yy, q.zy, q.xz, q.yz, q.zz};
  // The rate of deformation turned; the spin of the observer, large beside it.
  const double spin = 0.1 * c / cell;
  PointDriver point(*material, {.cell_size = cell}), turned(*material, {.cell_size = cell});
  for (int i = 0; i < 50; ++i) {
    const double rate = 1e-3 * i * c / cell;
    const Mat3<double> l{-rate, 0.5 * rate, 0, 0.1 * rate, 0.2 * rate, 0, 0.3 * rate, 0, -0.1 * rate};
    const Mat3<double> r = q * l * back;
    point.step(l, dt);
    turned.step({r.xx, r.xy - spin, r.xz, r.yx + spin, r.yy, r.yz, r.zx, r.zy, r.zz}, dt);
    CHECK(factor(turned) == Approx(factor(point)).epsilon(1e-9));
  }
  CHECK(factor(point) > 0.1);
}

TEST_CASE("only a limited viscosity takes columns", "[physics][viscosity][columns]") {
  const core::ColumnSet both{Column::viscosity_factor, Column::velocity_divergence};
  core::MaterialInput input = copper("IsoElastic");
  CHECK(make(input)->columns({}) == core::ColumnSet{});
  CHECK(make(limited(input))->columns({}) == both);
  CHECK(make(limited(input))->columns({.artificial_viscosity = false}) == core::ColumnSet{});
  input.strength.values["bq1"] = 0;
  CHECK(make(limited(input))->columns({}) == both);
  input.strength.values["bq2"] = 0;
  CHECK(make(limited(input))->columns({}) == core::ColumnSet{});
  CHECK(make(limited(sample("Rigid").input))->columns({}) == core::ColumnSet{});
}

TEST_CASE("without a cell size there is nothing to limit", "[physics][viscosity]") {
  const auto material = make(limited(copper("IsoElastic")));
  PointDriver point(*material, {});
  point.step(uniaxial(-1e5), 1e-9);
  CHECK(factor(point) == physics::factor_unknown);
  CHECK(point.value(Column::viscous_pressure) == 0);
  CHECK(std::isfinite(point.energy()));
}

TEST_CASE("what holds for every law holds with a limited viscosity", "[physics][viscosity][laws]") {
  for (const char* name : {"instances", "rest", "restart", "units", "neighbours", "undeclared", "declared",
                           "objectivity", "energy", "pure"}) {
    for (const char* label : {"IsoHarden", "JohnsonCook damaged", "Null + Polynomial gas"}) {
      physics::LawSample limited_sample = of(sample(label));
      limited_sample.input.limiter = core::ViscosityLimiter::shock;
      for (const std::string& fault :
           physics::law_check(name).failures(limited_sample, physics::built_in_laws()))
        FAIL_CHECK(name << ", " << label << ": " << fault);
    }
  }
}

}  // namespace mpm::tests
