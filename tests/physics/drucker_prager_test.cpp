// Drucker-Prager plasticity (thesis 6.2): strength in triaxial compression and extension and in plane strain
// against Mohr-Coulomb, the return to cone, cut-off and edge, dilation, and what the input may not say.

#include "physics/strength/drucker_prager.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "core/scene/errors.hpp"
#include "physics/point/point_driver.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

namespace {

using core::Column;
using core::Sym3;
using physics::DruckerPrager;
using physics::PointDriver;

constexpr double young = 70e6, poisson = 0.3;
constexpr double shear = young / (2 * (1 + poisson)), bulk = young / (3 * (1 - 2 * poisson));
const double degree = std::acos(-1.0) / 180;

core::MaterialInput soil(const core::ParameterValues& more) {
  core::MaterialInput input;
  input.name = "soil";
  input.reference_density = 2000;
  input.strength.type = "DruckerPrager";
  input.strength.values = {{"Young", young}, {"Poisson", poisson}};
  for (const auto& [name, value] : more) input.strength.values[name] = value;
  return input;
}

const DruckerPrager& law(const physics::Material& material) {
  return *physics::law_cast<DruckerPrager>(*material.laws().strength);
}

double tau(const PointDriver& point) { return std::sqrt(0.5 * contract(point.deviator(), point.deviator())); }
double mean(const PointDriver& point) { return -point.value(Column::pressure); }

/// Triaxial test: the lateral stress is held at -cell_pressure while the axial strain grows; returns the
/// axial stress at the end. The lateral rate that holds it is found by the secant in every step.
double triaxial(const physics::Material& material, double cell_pressure, double axial_strain) {
  PointDriver point(material, {});
  const int steps = 200;
  const double confine = -cell_pressure / (3 * bulk), dt = 1e-3;
  point.step({confine / dt, 0, 0, 0, confine / dt, 0, 0, 0, confine / dt}, dt);
  double lateral = -poisson * axial_strain / steps;
  for (int i = 0; i < steps; ++i) {
    const PointDriver::State before = point.save();
    const auto excess = [&](double rate) {
      point.restore(before);
      point.step({axial_strain / steps / dt, 0, 0, 0, rate / dt, 0, 0, 0, rate / dt}, dt);
      return point.stress().yy + cell_pressure;
    };
    double a = lateral, b = lateral - 0.01 * axial_strain / steps, fa = excess(a), fb = excess(b);
    for (int k = 0; k < 60 && std::abs(fb) > 1e-9 * cell_pressure; ++k) {
      const double c = b - fb * (b - a) / (fb - fa);
      a = b, fa = fb, b = c, fb = excess(c);
    }
    REQUIRE(std::abs(fb) <= 1e-6 * cell_pressure);
    lateral = b;
  }
  return point.stress().xx;
}

std::string fault(const core::ParameterValues& values) {
  try {
    make(soil(values));
  } catch (const core::InputErrors& errors) { return errors.what(); }
  return "";
}

}  // namespace

TEST_CASE("a cone through the edges of the pyramid has Mohr-Coulomb's triaxial strength",
          "[physics][drucker-prager]") {
  // Mohr-Coulomb, principal stresses s1 >= s3: s1 - s3 = 2 c cos(phi) - (s1 + s3) sin(phi).
  const double c = 10e3, p0 = 100e3;
  for (const double phi : {20.0, 35.0}) {
    const double n = (1 + std::sin(phi * degree)) / (1 - std::sin(phi * degree));
    const double cohesive = 2 * c * std::sqrt(n);
    for (const double psi : {0.0, phi}) {
      INFO("phi " << phi << " psi " << psi);
      const auto with_match = [&](double match) {
        return make(soil({{"phi", phi}, {"c", c}, {"psi", psi}, {"ten_f", 0.0}, {"match", match}}));
      };
      // The axial stress is the most compressed one in compression, the least compressed one in extension.
      CHECK(triaxial(*with_match(1), p0, -0.03) == Approx(-(n * p0 + cohesive)).epsilon(1e-6));
      CHECK(triaxial(*with_match(2), p0, 0.03) == Approx(-(p0 - cohesive) / n).epsilon(1e-6));
      // And each is a circle: the other meridian is the too strong (1) or too weak (2) one.
      CHECK(triaxial(*with_match(2), p0, -0.03) > -(n * p0 + cohesive));
      CHECK(triaxial(*with_match(1), p0, 0.03) > -(p0 - cohesive) / n);
    }
  }
}

TEST_CASE("the inscribed cone has Mohr-Coulomb's strength in associated plane strain",
          "[physics][drucker-prager]") {
  // Drucker and Prager, Quarterly of Applied Mathematics 10 (1952) 157, for plane strain and psi = phi:
  // the radius of Mohr's circle at failure is c cos(phi) - (s1 + s3)/2 sin(phi).
  const double phi = 20, c = 10e3;
  const auto material = make(soil({{"phi", phi}, {"c", c}, {"psi", phi}, {"ten_f", 0.0}, {"match", 3.0}}));
  PointDriver point(*material, {});
  const double confine = -100e3 / (3 * bulk), dt = 1e-3;
  point.step({confine / dt, 0, 0, 0, confine / dt, 0, 0, 0, confine / dt}, dt);
  // Flow at the rate that the flow rule wants in the plane, d_v = sin(phi) of the shear rate: the stress
  // stays.
  const double a = 1e-4 / dt, ratio = (1 - std::sin(phi * degree)) / (1 + std::sin(phi * degree));
  for (int i = 0; i < 2000; ++i) point.step({a, 0, 0, 0, -a * ratio, 0, 0, 0, 0}, dt);
  const Sym3<double> s = point.stress();
  const double radius = 0.5 * (s.xx - s.yy), centre = 0.5 * (s.xx + s.yy);
  CHECK(radius == Approx(c * std::cos(phi * degree) - centre * std::sin(phi * degree)).epsilon(1e-6));
}

TEST_CASE("clay and soil of the thesis' tables have the constants of their matching",
          "[physics][drucker-prager]") {
  // The UTTR soil of table 6.5: phi 20 degrees, c 40.84 kPa, ten_f 112.21 kPa, which is the apex but for its
  // rounding; matched as the thesis does, by (6-53), (6-54).
  const auto material = make(soil({{"phi", 20.0}, {"c", 40.84e3}, {"psi", 0.0}, {"ten_f", 112.21e3}}));
  CHECK(law(*material).friction ==
        Approx(2 * std::sin(20 * degree) * std::sqrt(3.0) / (3 + std::sin(20 * degree))).epsilon(1e-12));
  CHECK(law(*material).apex() == Approx(40.84e3 / std::tan(20 * degree)).epsilon(1e-12));
  CHECK(law(*material).tension == law(*material).apex());
  CHECK(law(*material).dilation == 0);
}

TEST_CASE("the stress returns to cone, cut-off and edge", "[physics][drucker-prager]") {
  for (const double dilation : {0.0, 0.15, 0.4}) {
    const core::ParameterValues values{{"qfai", 0.4}, {"kfai", 200e3}, {"qpsi", dilation}, {"ten_f", 150e3}};
    const auto material = make(soil(values));
    const double strength = 200e3, edge = 200e3 - 0.4 * 150e3;
    int cone = 0, cut = 0, corner = 0;
    // Strains of shear and of the volume in all proportions, from the unstressed state, in one step.
    for (int i = 0; i <= 40; ++i) {
      const double angle = (-90 + 4.5 * i) * degree, size = 0.03, dt = 1e-3;
      const double gamma = size * std::cos(angle), volume = size * std::sin(angle);
      PointDriver point(*material, {});
      point.step(
          {volume / 3 / dt, 0.5 * gamma / dt, 0, 0.5 * gamma / dt, volume / 3 / dt, 0, 0, 0, volume / 3 / dt},
          dt);
      // The trial stress, and the answer by hand from the three mechanisms.
      const double tau_trial = shear * std::abs(gamma), mean_trial = bulk * volume;
      const double on_cone = tau(point) + 0.4 * mean(point) - 200e3, on_cut = mean(point) - 150e3;
      INFO("dilation " << dilation << " angle " << -90 + 4.5 * i);
      CHECK(on_cone <= 1e-8 * strength);
      CHECK(on_cut <= 1e-8 * strength);
      const double plastic_volume = (mean_trial - mean(point)) / bulk,
                   slip = (tau_trial - tau(point)) / shear;
      const bool sheared = slip > 1e-12, torn = std::abs(on_cut) < 1e-8 * strength;
      if (sheared && !torn) {
        ++cone;
        CHECK(std::abs(on_cone) < 1e-8 * strength);
        CHECK(plastic_volume == Approx(dilation * slip).epsilon(1e-9).margin(1e-12));
        // (6-39)
        CHECK(point.value(Column::effective_plastic_strain) ==
              Approx(slip * std::sqrt(1.0 / 3 + 2.0 / 9 * dilation * dilation)).epsilon(1e-10));
      } else if (!sheared && torn) {
        ++cut;
        CHECK(tau(point) == Approx(tau_trial).margin(1e-9 * strength));
        // (6-48)
        CHECK(point.value(Column::effective_plastic_strain) ==
              Approx(std::sqrt(2.0) / 3 * plastic_volume).epsilon(1e-10));
      } else if (sheared && torn) {
        ++corner;
        CHECK(tau(point) == Approx(edge).epsilon(1e-10));
        CHECK(plastic_volume > dilation * slip);  // Koiter: both multipliers positive
      } else {
        CHECK(point.value(Column::effective_plastic_strain) == 0);
      }
    }
    CHECK(cone > 3);
    CHECK(cut > 0);
    CHECK(corner > 3);
  }
}

TEST_CASE("with closes=1 what tension has opened must close first", "[physics][drucker-prager]") {
  // Stretched by 1 %, of which ten_f/K is elastic, then compressed by 1.2 %, in steps of 0.1 %. With closes=1
  // the strain is the logarithm of the volume.
  const double tension = 50e3, dt = 1e-3;
  for (const bool closes : {false, true}) {
    INFO("closes " << closes);
    core::ParameterValues values{{"qfai", 0.4}, {"kfai", 200e3}, {"qpsi", 0.1}, {"ten_f", tension}};
    if (closes) values["closes"] = 1;
    const auto material = make(soil(values));
    PointDriver point(*material, {});
    const auto strain = [&](double volume, int steps) {
      const double rate = volume / (3 * steps * dt);
      for (int i = 0; i < steps; ++i) point.step({rate, 0, 0, 0, rate, 0, 0, 0, rate}, dt);
      return closes ? steps * std::log1p(volume / steps) : volume;
    };
    const double opened = strain(0.01, 10) - tension / bulk;
    CHECK(mean(point) == Approx(tension).epsilon(1e-12));
    const double flow = std::sqrt(2.0) / 3 * opened;
    CHECK(point.value(Column::effective_plastic_strain) == Approx(flow).epsilon(1e-9));
    const double half = strain(-0.5 * opened, 5);
    CHECK(mean(point) == Approx(closes ? tension : tension + bulk * half).epsilon(1e-9));
    const double rest = strain(-0.007, 5);
    const double pressed = (closes ? opened : 0.0) + half + rest;
    CHECK(mean(point) == Approx(tension + bulk * pressed).epsilon(1e-9));
    if (closes) CHECK(point.value(Column::plastic_volumetric_strain) == Approx(0).margin(1e-15));
    CHECK(point.value(Column::effective_plastic_strain) == Approx(flow).epsilon(1e-9));
  }
}

TEST_CASE("grains that open and close often are not denser than before", "[physics][drucker-prager]") {
  const auto material =
      make(soil({{"qfai", 0.4}, {"kfai", 0.0}, {"qpsi", 0.0}, {"ten_f", 0.0}, {"closes", 1.0}}));
  PointDriver point(*material, {});
  const double dt = 1e-3, size = 0.05;
  double volume = 0;  // its logarithm
  for (int i = 0; i < 100; ++i) {
    // Back to the volume before, of which 1e-6 is missing at the end.
    for (const double change : {size, 1 / (1 + size) - 1 - (i == 99 ? 1e-6 : 0)}) {
      const double rate = change / (3 * dt);
      point.step({rate, 0, 0, 0, rate, 0, 0, 0, rate}, dt);
      volume += std::log1p(change);
    }
  }
  CHECK(mean(point) == Approx(bulk * volume).epsilon(1e-6));
}

TEST_CASE("grains that have lost touch bear nothing, and open to eight times their volume",
          "[physics][drucker-prager]") {
  for (const double closes : {0.0, 1.0}) {
    INFO("closes " << closes);
    const auto material =
        make(soil({{"qfai", 0.4}, {"kfai", 0.0}, {"qpsi", 0.0}, {"ten_f", 0.0}, {"closes", closes}}));
    PointDriver point(*material, {});
    const double dt = 1e-3;
    for (int i = 0; i < 1000; ++i) {
      point.step({0.1 / dt, 0.2 / dt, 0, 0, 0.02 / dt, 0, 0, 0, 0.03 / dt}, dt);
      CHECK(mean(point) == 0);
      CHECK(tau(point) == 0);
    }
    CHECK(point.volume_ratio() == Approx(8).epsilon(1e-14));
    // Pressed together again they bear pressure as soon as they are as dense as before, or at once.
    const int steps = 100;
    const double ratio = std::pow(0.999 / (closes != 0 ? 8 : 1), 1.0 / steps), rate = (ratio - 1) / (3 * dt);
    for (int i = 0; i < steps; ++i) point.step({rate, 0, 0, 0, rate, 0, 0, 0, rate}, dt);
    CHECK(mean(point) == Approx(bulk * std::log(0.999)).epsilon(1e-3));
  }
}

TEST_CASE("loose soil begins open: it bears nothing, and has no elastic energy",
          "[physics][drucker-prager]") {
  for (const double tension : {0.0, 50e3}) {
    const auto material =
        make(soil({{"qfai", 0.4}, {"kfai", 200e3}, {"qpsi", 0.0}, {"ten_f", tension}, {"closes", 1.0}}));
    const double held = tension / bulk;
    PointDriver loose(*material, {.density = 0.9 * 2000}), dense(*material, {.density = 1.001 * 2000});
    CHECK(mean(loose) == tension);
    CHECK(loose.energy() ==
          Approx(bulk * (std::exp(held) * (held - 1) + 1)).margin(1e-9 * bulk * held * held));
    CHECK(loose.value(Column::plastic_volumetric_strain) == Approx(-std::log(0.9) - held).epsilon(1e-12));
    CHECK(mean(dense) == Approx(-bulk * std::log(1.001)).epsilon(1e-12));
    CHECK(dense.energy() == Approx(bulk * (1 - (1 + std::log(1.001)) / 1.001)).epsilon(1e-6));
  }
}

TEST_CASE("what dilation has opened bears pressure, with closes=1 too", "[physics][drucker-prager]") {
  const core::ParameterValues values{
      {"qfai", 0.4}, {"kfai", 0.0}, {"qpsi", 0.2}, {"ten_f", 0.0}, {"closes", 1.0}};
  const auto material = make(soil(values));
  PointDriver point(*material, {});
  const double dt = 1e-3;
  for (int i = 0; i < 100; ++i) {
    point.step({i == 0 ? -1e-3 / dt : 0, 1e-4 / dt, 0, 1e-4 / dt, 0, 0, 0, 0, 0}, dt);
  }
  CHECK(point.value(Column::plastic_volumetric_strain) == 0);
  CHECK(mean(point) < -1e-3 * bulk);
}

TEST_CASE("after a random path the stress is on or within the surface", "[physics][drucker-prager]") {
  for (const char* label : {"DruckerPrager", "DruckerPrager Mohr-Coulomb"}) {
    const Sample& s = sample(label);
    const auto material = make(s.input);
    const DruckerPrager& dp = law(*material);
    PointDriver point(*material, {});
    double outside = 0, plastic = 0;
    int flowing = 0;
    for (const unsigned seed : {3u, 8u, 12u}) {
      const RandomPath path(seed, s.strain, 2e-5);
      for (int i = 0; i < 300; ++i) {
        point.step(path.gradient((i + 0.5) * 2e-5 / 300), 2e-5 / 300);
        const double cone = tau(point) + dp.friction * mean(point) - dp.cohesion;
        const double cut = mean(point) - dp.tension;
        outside = std::max({outside, cone, cut});
        if (point.value(Column::effective_plastic_strain) > plastic) {
          ++flowing;
          CHECK(std::max(cone, cut) > -1e-8 * dp.cohesion);
        }
        plastic = point.value(Column::effective_plastic_strain);
      }
    }
    CHECK(outside < 1e-8 * dp.cohesion);
    CHECK(flowing > 100);
  }
}

TEST_CASE("without friction the cone is von Mises' cylinder", "[physics][drucker-prager]") {
  const double yield = 90e3;
  const auto cone =
      make(soil({{"qfai", 0.0}, {"kfai", yield / std::sqrt(3.0)}, {"qpsi", 0.0}, {"ten_f", 1e9}}));
  core::MaterialInput input = soil({});
  input.strength.type = "ElaPlastic";
  input.strength.values = {{"Young", young}, {"Poisson", poisson}, {"Yield0", yield}};
  const auto cylinder = make(input);
  PointDriver a(*cone, {}), b(*cylinder, {});
  const RandomPath path(4, 0.02, 2e-5);
  for (int i = 0; i < 200; ++i) {
    a.step(path.gradient((i + 0.5) * 1e-7), 1e-7);
    b.step(path.gradient((i + 0.5) * 1e-7), 1e-7);
  }
  const Sym3<double> d = a.stress() - b.stress();
  CHECK(std::sqrt(contract(d, d)) < 1e-9 * yield);
  CHECK(a.value(Column::effective_plastic_strain) ==
        Approx(b.value(Column::effective_plastic_strain)).epsilon(1e-9));
  CHECK(b.value(Column::effective_plastic_strain) > 0.001);
}

TEST_CASE("what a Drucker-Prager soil may not be is refused by name", "[physics][drucker-prager]") {
  using Catch::Matchers::Contains;
  CHECK_THAT(fault({{"qfai", 0.4}, {"kfai", 2e5}, {"qpsi", 0.1}, {"ten_f", 5.1e5}}),
             Contains("ten_f must not exceed the apex of the cone, kfai/qfai = 500000"));
  CHECK_THAT(fault({{"qfai", 0.4}, {"kfai", 2e5}, {"qpsi", 0.5}, {"ten_f", 0.0}}),
             Contains("qpsi must not exceed qfai"));
  CHECK_THAT(fault({{"phi", 20.0}, {"c", 1e4}, {"psi", 21.0}, {"ten_f", 0.0}}),
             Contains("psi must not exceed phi"));
  CHECK_THAT(fault({{"ten_f", 0.0}}), Contains("either qfai, kfai and qpsi or phi, c and psi"));
  CHECK_THAT(fault({{"qfai", 0.4},
                    {"kfai", 2e5},
                    {"qpsi", 0.1},
                    {"phi", 20.0},
                    {"c", 1e4},
                    {"psi", 0.0},
                    {"ten_f", 0.0}}),
             Contains("either qfai, kfai and qpsi or phi, c and psi"));
  CHECK_THAT(fault({{"qfai", 0.0}, {"kfai", 0.0}, {"qpsi", 0.0}, {"ten_f", 0.0}}), Contains("no strength"));
  core::MaterialInput input = soil({{"qfai", 0.4}, {"kfai", 2e5}, {"qpsi", 0.1}, {"ten_f", 0.0}});
  input.eos = core::LawInput{"Gruneisen", {{"C0", 2000.0}, {"S1", 1.5}, {"gamma0", 1.0}}, {}};
  CHECK_THROWS_WITH(make(input), Contains("remove the EquationOfState"));
}

}  // namespace mpm::tests
