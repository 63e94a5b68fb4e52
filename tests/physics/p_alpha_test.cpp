// P-alpha over each solid: the crush curve, unloading, reloading and full compaction. A pressure and the
// curve give the distension, the solid's equation turned round gives the density that belongs to them, and
// the law must lead from that density back to the pressure. For a linear solid all of it is in closed form.

#include "physics/eos/p_alpha.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/eos/list.hpp"
#include "physics/point/point_driver.hpp"
#include "tests/physics/brittle_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::EosPoint;
using physics::Gruneisen;
using physics::LinearisedPressure;
using physics::PAlpha;
using physics::PointDriver;
using physics::Polynomial;
using physics::Polynomial2;

namespace {

constexpr double rho0 = 2314, rho0s = 2750, p_crush = 23.3e6, p_lock = 6e9, n = 3;

template <class Solid>
PAlpha<Solid> finished(PAlpha<Solid> law) {
  law.p_lock = p_lock, law.p_crush = p_crush, law.n = n, law.solid_density = rho0s;
  INFO(law.fault(rho0));
  REQUIRE(law.fault(rho0).empty());
  law.prepare(rho0);
  return law;
}

PAlpha<Polynomial> over_linear(double sound_speed = 0) {
  PAlpha<Polynomial> law;
  law.c0 = law.c2 = law.c3 = law.c4 = law.c5 = law.c6 = 0;
  law.c1 = 35.27e9;
  law.sound_speed = sound_speed;
  return finished(law);
}
PAlpha<Polynomial> over_polynomial(double sound_speed) {
  PAlpha<Polynomial> law;
  law.c0 = law.c6 = 0;
  law.c1 = 35.27e9, law.c2 = 39.58e9, law.c3 = 9.04e9, law.c4 = law.c5 = 1.22;
  law.sound_speed = sound_speed;
  return finished(law);
}
PAlpha<Polynomial2> over_polynomial2() {
  PAlpha<Polynomial2> law;
  law.a1 = law.t1 = 35.27e9, law.a2 = 39.58e9, law.a3 = 9.04e9, law.b0 = law.b1 = 1.22, law.t2 = 0;
  return finished(law);
}
PAlpha<Gruneisen> over_gruneisen() {
  PAlpha<Gruneisen> law;
  law.c0 = 3580, law.s1 = 1.3, law.gamma0 = 1.2;
  return finished(law);
}

/// One particle with its memory.
template <class Law>
struct Pores {
  explicit Pores(const Law& which) : law(which) { law.initialise(point); }
  double operator()(double mu, double energy = 0) {
    point.compression = mu, point.relative_volume = 1 / (1 + mu), point.energy = energy;
    line = law.linearise(point);
    return line.a + line.b * energy;
  }
  double distension() const { return 1 / (1 - point.porosity); }
  Law law;
  EosPoint<double> point{};
  LinearisedPressure<double> line{};
};

/// The compression mu at which the solid under alpha p has the density alpha rho; E per initial volume of the
/// porous solid.
template <class Solid>
double compression(const PAlpha<Solid>& law, double distension, double p, double energy) {
  double low = -0.5, high = 2;
  const Solid& solid = law;
  for (int i = 0; i < 100; ++i) {
    const double mu = 0.5 * (low + high);
    const EosPoint<double> point{mu, 1 / (1 + mu), 0, 0, energy * rho0s / rho0};
    const LinearisedPressure<double> line = solid.linearise(point);
    (line.a + line.b * point.energy < distension * p ? low : high) = mu;
  }
  return (1 + low) * rho0s / (rho0 * distension) - 1;
}

double curve(double p, double first) {
  return p < p_lock ? 1 + (first - 1) * std::pow((p_lock - p) / (p_lock - p_crush), n) : 1;
}

template <class Solid>
void check_crush_curve(const PAlpha<Solid>& law, double energy) {
  INFO(Solid::name << ", energy " << energy);
  Pores<PAlpha<Solid>> pores(law);
  for (const double p : {23.3e6, 24e6, 0.1e9, 0.5e9, 2e9, 5e9, 5.9e9, 5.999999e9, 6e9, 7e9, 9e9}) {
    INFO("pressure " << p);
    const double alpha = curve(p, law.first_distension);
    const double mu = compression(law, alpha, p, energy);
    CHECK(pores(mu, energy) == Approx(p).epsilon(1e-10));
    CHECK(pores.distension() == Approx(alpha).epsilon(1e-9));
    // Down half the way and up again along the same line, whatever the steps; the pores stay as they are.
    auto unloaded = pores;
    const double down = unloaded(mu - 0.002, energy);
    CHECK(down < p);
    unloaded(mu - 0.004, energy);
    CHECK(unloaded(mu - 0.002, energy) == Approx(down).epsilon(1e-12).margin(1e-3));
    CHECK(unloaded(mu, energy) == Approx(p).epsilon(1e-9));
    CHECK(unloaded.distension() == Approx(pores.distension()).epsilon(1e-9));
  }
}

}  // namespace

TEST_CASE("p-alpha follows its crush curve over every solid", "[physics][p-alpha]") {
  for (const double energy : {0.0, 50e6}) {
    check_crush_curve(over_linear(), energy);
    check_crush_curve(over_polynomial(0), energy);
    check_crush_curve(over_polynomial(3000), energy);
    check_crush_curve(over_polynomial2(), energy);
    check_crush_curve(over_gruneisen(), energy);
  }
}

TEST_CASE("p-alpha of a soft foam of a stiff solid", "[physics][p-alpha]") {
  // Plock is 1e-4 of the solid's stiffness, whose round-off is what remains; three quarters are pores.
  PAlpha<Gruneisen> law;
  law.c0 = 5350, law.s1 = 1.34, law.gamma0 = 2;
  law.p_lock = 10e6, law.p_crush = 1e6, law.n = 2, law.solid_density = 2700;
  REQUIRE(law.fault(675).empty());
  law.prepare(675);
  Pores<PAlpha<Gruneisen>> pores(law);
  const double solid = 2700 * 5350.0 * 5350.0;
  for (const double p : {1e6, 1.5e6, 4e6, 9e6, 9.99e6, 11e6}) {
    INFO("pressure " << p);
    const double x = std::max(10e6 - p, 0.0) / 9e6, alpha = 1 + 3 * x * x;
    double low = 0, high = 0.01;  // the solid's compression under alpha p
    for (int i = 0; i < 100; ++i) {
      const double mu = 0.5 * (low + high), r = 1 - 0.34 * mu;
      (solid * mu / (r * r) < alpha * p ? low : high) = mu;  // gamma0 = 2: mu (1 + mu)(1 - mu/(1 + mu)) = mu
    }
    CHECK(pores((1 + low) * 4 / alpha - 1) == Approx(p).margin(1e-14 * solid));
    CHECK(pores.distension() == Approx(alpha).epsilon(1e-9));
  }
}

TEST_CASE("p-alpha over a linear solid: elastic, crushed and compacted in closed form",
          "[physics][p-alpha]") {
  const double solid = 35.27e9, alpha0 = rho0s / rho0;
  Pores<PAlpha<Polynomial>> pores(over_linear());
  // The pores keep their share: p = K/alpha (rho alpha/rho_s - 1), from the start K mu/alpha0.
  const double mu_crush = p_crush * alpha0 / solid;
  CHECK(pores(0) == Approx(0).margin(1e-15 * solid));
  CHECK(pores(0.5 * mu_crush) == Approx(0.5 * p_crush).epsilon(1e-9));
  CHECK(pores(-mu_crush) == Approx(-p_crush).epsilon(1e-9));
  CHECK(pores(mu_crush) == Approx(p_crush).epsilon(1e-9));
  CHECK(pores.distension() == Approx(alpha0).epsilon(1e-12));
  // Crushed to 1 GPa: rho = rho_s (1 + alpha p/K)/alpha.
  const double alpha = 1 + (alpha0 - 1) * std::pow((6e9 - 1e9) / (6e9 - 23.3e6), 3);
  const double mu = alpha0 / alpha * (1 + alpha * 1e9 / solid) - 1;
  CHECK(pores(mu) == Approx(1e9).epsilon(1e-11));
  // Unloaded fully: what is left is the compaction, rho = rho_s/alpha; then tension, and reloading.
  const double left = alpha0 / alpha - 1;
  CHECK(pores(left) == Approx(0).margin(1e-3));
  CHECK(pores(left - 0.001) == Approx(-0.001 * solid / alpha0).epsilon(1e-9));
  CHECK(pores(0.5 * (left + mu)) == Approx(0.5e9).epsilon(1e-9));
  CHECK(pores(mu) == Approx(1e9).epsilon(1e-9));
  // Compacted: the solid, and nothing else, both ways.
  CHECK(pores(alpha0 * (1 + 8e9 / solid) - 1) == Approx(8e9).epsilon(1e-11));
  CHECK(pores.distension() == 1);
  CHECK(pores(alpha0 * (1 + 1e9 / solid) - 1) == Approx(1e9).epsilon(1e-9));
  CHECK(pores(alpha0 - 1) == Approx(0).margin(1e-3));
}

TEST_CASE("p-alpha has the elastic stiffness that C0 states, less so the more it is crushed",
          "[physics][p-alpha]") {
  const double stiffness = rho0 * 3000.0 * 3000.0;
  const auto law = over_linear(3000);
  Pores<PAlpha<Polynomial>> pores(law);
  // Through (Pcrush, Pcrush/K) exactly, and straight to within Pcrush/K_solid before.
  CHECK(pores(p_crush / stiffness) == Approx(p_crush).epsilon(1e-9));
  CHECK(pores(0.5 * p_crush / stiffness) == Approx(0.5 * p_crush).epsilon(2e-3));
  // alpha_p by the manual's formula with the solid's density at alpha_p Pcrush.
  const double solid_density = rho0s * (1 + law.first_distension * p_crush / 35.27e9);
  CHECK(law.first_distension == Approx(solid_density / (rho0 * (1 + p_crush / stiffness))).epsilon(1e-12));
  // The slope of unloading is what the law says of its stiffness, everywhere.
  for (const double mu : {0.0005, 0.01, 0.1, 0.25, 0.5}) {
    INFO("mu " << mu);
    const double p = pores(mu), h = 1e-6, da = pores.line.da;
    auto unloaded = pores;
    CHECK((p - unloaded(mu - h)) / h == Approx(da).epsilon(1e-4));
  }
}

TEST_CASE("p-alpha derivatives are those of its unloading", "[physics][p-alpha]") {
  const auto check = [](auto law) {
    for (const double mu : {0.0003, 0.05, 0.15, 0.5}) {
      INFO("mu " << mu);
      const double energy = 20e6, h = 1e-6, de = 1e2;
      Pores<decltype(law)> pores(law);
      const double p = pores(mu, energy);
      const LinearisedPressure<double> line = pores.line;
      auto cooler = pores, unloaded = pores;
      CHECK((p - cooler(mu, energy - de)) / de == Approx(line.b).epsilon(1e-4));
      CHECK((p - unloaded(mu - h, energy)) / h == Approx(line.da + line.db * energy).epsilon(1e-3));
    }
  };
  check(over_polynomial(0));
  check(over_polynomial(3000));
  check(over_polynomial2());
  check(over_gruneisen());
}

TEST_CASE("a porous particle compressed and released keeps the work of crushing", "[physics][p-alpha]") {
  // Closed form for the linear solid without heat: E = integral of p dV along the curve, up and down, per V0.
  core::MaterialInput input = sample("IsoHarden + PAlpha over Polynomial").input;
  for (const char* name : {"c2", "c3", "c4", "c5"}) input.eos->values[name] = 0;
  input.eos->values.erase("C0");
  input.strength = {"Null", {}, {}};
  const auto material = make(input);
  const auto law = over_linear();
  Pores<PAlpha<Polynomial>> pores(law);
  const double peak = 1 / (1 + compression(law, curve(1e9, law.first_distension), 1e9, 0));
  const double left = curve(1e9, law.first_distension) / law.first_distension;  // V/V0 at no pressure again
  const int fine = 20000;
  double work = 0;
  for (const auto& [from, to] : {std::pair{1.0, peak}, std::pair{peak, left}}) {
    for (int i = 0; i < fine; ++i) {
      const double a = from + (to - from) * i / fine, b = from + (to - from) * (i + 1) / fine;
      const double pa = pores(1 / a - 1), pb = pores(1 / b - 1);
      work -= 0.5 * (pa + pb) * (b - a);
    }
  }
  PointDriver point(*material, {});
  compress_to(point, peak, 2000);
  CHECK(point.value(Column::pressure) == Approx(1e9).epsilon(1e-8));
  compress_to(point, left, 500);
  CHECK(point.value(Column::pressure) == Approx(0).margin(1e3));
  CHECK(point.energy() == Approx(work).epsilon(1e-5));
  CHECK(work > 10e6);
  CHECK(point.value(Column::porosity) == Approx(1 - 1 / curve(1e9, law.first_distension)).epsilon(1e-9));
}

TEST_CASE("p-alpha asks for what its solid needs, and for numbers that go together", "[physics][p-alpha]") {
  const auto refused = [](const std::string& label, const char* name, double value, const char* message) {
    core::MaterialInput input = sample("IsoHarden + PAlpha over " + label).input;
    if (value == value) {
      input.eos->values[name] = value;
    } else {
      input.eos->values.erase(name);
    }
    CHECK_THROWS_WITH(make(input), Catch::Contains(message));
  };
  const double absent = std::nan("");
  refused("Polynomial", "c2", absent, "EOSID 1, Polynomial, needs the attribute c2");
  refused("Polynomial2", "T1", absent, "EOSID 2, Polynomial2, needs the attribute T1");
  refused("Gruneisen", "C0", absent, "EOSID 3, Gruneisen, needs the attribute C0");
  refused("Gruneisen", "Plock", 20e6, "Plock must be greater than Pcrush");
  refused("Gruneisen", "rho0s", 2000, "rho0s must be greater than ReferenceDensity");
  refused("Polynomial", "C0", 4000, "C0 must be smaller");
  refused("Polynomial", "C0", 200, "C0 must be greater");
}

}  // namespace mpm::tests
