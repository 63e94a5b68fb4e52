// Holmquist-Johnson-Cook concrete: strength, strain to fracture and pressure against values worked out apart
// from this code from the manual's formulas (3-14 to 3-16, 3-53 to 3-59) for its concrete of 48 MPa (table
// 6.4), in MPa; damage against the closed form of shear at constant pressure.

#include "physics/eos/holmquist_johnson_cook.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "physics/strength/holmquist_johnson_cook.hpp"
#include "tests/physics/brittle_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::EosPoint;
using physics::HolmquistJohnsonCook;
using physics::HolmquistJohnsonCookBulk;
using physics::LinearisedPressure;
using physics::PathKind;
using physics::PointDriver;

namespace {

HolmquistJohnsonCook strength_law() {
  HolmquistJohnsonCook law;
  law.young = 35664, law.poisson = 0.2;
  law.a = 0.79, law.b = 1.6, law.n = 0.61, law.c = 0.007, law.fc = 48, law.smax = 7;
  law.d1 = 0.04, law.d2 = 1, law.efmin = 0.01, law.t = 4, law.epso = 1;
  law.prepare();
  return law;
}

HolmquistJohnsonCookBulk bulk_law(double k2 = -171e3, double k3 = 208e3) {
  HolmquistJohnsonCookBulk law;
  law.p_crush = 16, law.mu_crush = 0.001, law.k1 = 85e3, law.k2 = k2, law.k3 = k3;
  law.p_lock = 800, law.mu_lock = 0.1, law.poisson = 0.2;
  REQUIRE(law.fault().empty());
  law.prepare();
  return law;
}

/// One particle's pressure, with its memory.
struct Pores {
  explicit Pores(const HolmquistJohnsonCookBulk& bulk) : law(bulk) {}
  double operator()(double mu) {
    point.compression = mu, point.relative_volume = 1 / (1 + mu);
    line = law.linearise(point);
    CHECK(line.b == 0);
    return line.a;
  }
  HolmquistJohnsonCookBulk law;
  EosPoint<double> point{};
  LinearisedPressure<double> line{};
};

/// The sample in SI with other switches.
core::MaterialInput concrete(const core::ParameterValues& more, bool crushing = true) {
  core::MaterialInput input = sample(crushing ? "HolmquistJohnsonCook both" : "HolmquistJohnsonCook").input;
  for (const auto& [name, value] : more) input.strength.values.insert_or_assign(name, value);
  return input;
}

}  // namespace

TEST_CASE("HJC strength at tabulated pressures, damages and rates", "[physics][hjc]") {
  const HolmquistJohnsonCook law = strength_law();
  struct Row {
    double pressure, damage, rate, strength;
  };
  for (const Row& row : {Row{0, 0, 1, 37.92},
                         {16, 0, 1, 77.2131869606},
                         {48, 0, 1, 114.72},
                         {48, 0.5, 1, 95.76},
                         {48, 1, 1, 76.8},
                         {48, 1, 1000, 80.513609238},
                         {240, 0, 1, 242.910116696},
                         {240, 1, 100, 211.598217313},
                         {960, 0, 1, 336},  // SMax
                         {-2, 0, 1, 18.96},
                         {-2, 0.5, 100, 9.78559909354},
                         {-4, 0, 1, 0},
                         {-6, 0.2, 1, 0},
                         {-1, 1, 1, 0},
                         {0, 1, 1, 0},
                         {48, 0, 1e-6, 114.72}}) {
    INFO(row.pressure << " MPa, damage " << row.damage << ", rate " << row.rate);
    CHECK(law.strength(row.pressure, row.damage, row.rate) == Approx(row.strength).epsilon(1e-11));
  }
}

TEST_CASE("HJC with a threshold of zero fails at the first damage, and not before", "[physics][hjc]") {
  const auto material = make(concrete({{"DamageToFail", 1}, {"FailureDamageThreshold", 0}}));
  PointDriver point(*material, {});
  drive(point, {.kind = PathKind::uniaxial_stress, .rate = 1, .targets = {-0.01}, .steps = 1000},
        [&](double) { CHECK((point.value(Column::failed) > 0) == (point.value(Column::damage) > 0)); });
  CHECK(point.value(Column::failed) == 1);
}

TEST_CASE("HJC strain to fracture, with and without softening tension", "[physics][hjc]") {
  HolmquistJohnsonCook law = strength_law(), softening = strength_law();
  softening.tensile_damage = 1;
  struct Row {
    double pressure, damage, plain, softened;
  };
  for (const Row& row : {Row{0, 0, 1.0 / 300, 1.0 / 300},
                         {48, 0, 0.13 / 3, 0.13 / 3},
                         {16, 0.3, 0.05 / 3, 0.047 / 3},
                         {-4, 0, 0, 0},
                         {-6, 0.5, 0, 0}}) {
    INFO(row.pressure << " MPa, damage " << row.damage);
    CHECK(law.fracture_strain(row.pressure, row.damage) == Approx(row.plain).epsilon(1e-12));
    CHECK(softening.fracture_strain(row.pressure, row.damage) == Approx(row.softened).epsilon(1e-12));
  }
}

TEST_CASE("HJC pressure in loops of loading, unloading and reloading", "[physics][hjc]") {
  Pores pressure(bulk_law());
  struct Row {
    double mu, pressure;
  };
  for (const Row& row : {// elastic: there and back, into tension, and again
                         Row{0.0005, 8},
                         {0.001, 16},
                         {0.0002, 3.2},
                         {-0.0003, -4.8},
                         {0.0005, 8},
                         {0.001, 16},
                         // crushing, unloaded and reloaded on one line, then on along the curve
                         {0.02, 151.969119282},
                         {0.0195, 137.985784314},
                         {0.018, 96.0357794087},
                         {0.0195, 137.985784314},
                         {0.02, 151.969119282},
                         {0.05, 366.65720236},
                         {0.049, 319.795790417},
                         {0.0455, 155.780848619},
                         {0.044, 85.4887307055},
                         {0.05, 366.65720236},
                         // locked
                         {0.11055428761044743, 800},
                         {0.11, 752.885553112},
                         {0.14, 2874.79489106},
                         {0.139, 2797.52216379},
                         {0.12, 1329.3403456},
                         {0.0999, -223.841472577},
                         {0.09, -988.841472577},
                         {0.14, 2874.79489106},
                         {0.2, 6470.32306536}}) {
    INFO("mu " << row.mu);
    CHECK(pressure(row.mu) == Approx(row.pressure).epsilon(1e-10));
  }
}

TEST_CASE("HJC pressure has no step where the pores are closed", "[physics][hjc]") {
  for (const double k2 : {-171e3, 0.0, 135e3}) {
    const HolmquistJohnsonCookBulk law = bulk_law(k2);
    INFO("K2 " << k2 << ", mu_plock " << law.mu_plock);
    Pores below(law), above(law);
    CHECK(below(law.mu_plock * (1 - 1e-13)) == Approx(800).epsilon(1e-9));
    CHECK(above(law.mu_plock * (1 + 1e-13)) == Approx(800).epsilon(1e-9));
  }
  // Without the higher terms it is the manual's 3-56.
  CHECK(bulk_law(0, 0).mu_plock == Approx(800 / 85e3 * 1.1 + 0.1).epsilon(1e-14));
}

TEST_CASE("HJC stiffness is that of unloading, or of loading where that is more", "[physics][hjc]") {
  for (const double k2 : {-171e3, 135e3}) {
    const HolmquistJohnsonCookBulk law = bulk_law(k2);
    for (const double mu : {0.0005, 0.003, 0.05, 0.108, 0.12, 0.15}) {
      INFO("K2 " << k2 << ", mu " << mu);
      Pores pores(law);
      const double p = pores(mu), stiffness = pores.line.da, h = 1e-7;
      Pores on = pores, back = pores;
      const double loading = (on(mu + h) - p) / h, unloading = (p - back(mu - h)) / h;
      CHECK(stiffness == Approx(std::max(loading, unloading)).epsilon(1e-4));
    }
  }
}

TEST_CASE("HJC ledger the compression that unloading would leave", "[physics][hjc]") {
  const HolmquistJohnsonCookBulk law = bulk_law();
  Pores pores(law);
  pores(0.001);
  CHECK(pores.point.plastic_volumetric_strain == Approx(0).margin(1e-15));
  for (const double mu : {0.002, 0.02, 0.05, 0.1, law.mu_plock}) {
    INFO("mu " << mu);
    pores(mu);
    const double left = pores.point.plastic_volumetric_strain;
    CHECK(left > 0);
    Pores unloaded = pores;
    CHECK(unloaded(left) == Approx(0).margin(1e-9));
    CHECK(unloaded.point.plastic_volumetric_strain == left);
  }
  const double closed = pores.point.plastic_volumetric_strain;
  pores(0.3);
  CHECK(pores.point.plastic_volumetric_strain == closed);  // dense: nothing is left to crush
}

TEST_CASE("HJC damage in shear at constant pressure follows its closed form", "[physics][hjc]") {
  // Y = Y0 - fc A D and epef = D ef, so that strain = Y/(3 G) + epef is linear in D. Without an equation of
  // state the pressure is elastic, K times the trace of the strain.
  const auto material = make(concrete({{"C", 0.0}}, false));
  const double g = 14.86e9, k = 35.664e9 / 1.8, fc = 48e6, pressure = 48e6;
  const double y0 = fc * (0.79 + 1.6), ef = 0.04 * (52.0 / 48);
  const double strain = y0 / (3 * g) + 0.6 * (ef - fc * 0.79 / (3 * g));  // where D = 0.6
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const int steps = 400 << level;
    PointDriver point(*material, {});
    compress_to(point, 1 - pressure / k);
    for (int i = 0; i < steps; ++i) shear_by(point, strain / steps);
    CHECK(point.value(Column::pressure) == Approx(pressure).epsilon(1e-12));
    error[level] = std::abs(point.value(Column::damage) - 0.6);
    CHECK(point.value(Column::effective_plastic_strain) ==
          Approx(point.value(Column::damage) * ef).epsilon(1e-10));
    CHECK(mises(point.deviator()) == Approx(y0 - fc * 0.79 * 0.6).epsilon(2e-3));
  }
  CHECK(error[0] < 2e-3);
  CHECK(std::log2(error[0] / error[1]) == Approx(1).margin(0.1));
}

TEST_CASE("HJC strength follows the rate of the whole strain", "[physics][hjc]") {
  const auto material = make(concrete({}, false));
  for (const double rate : {1e-3, 1.0, 50.0, 2e4}) {
    INFO("rate " << rate << " /s");
    PointDriver point(*material, {});
    shear_by(point, 0.01, 0.01 / rate);
    CHECK(mises(point.deviator()) ==
          Approx(48e6 * 0.79 * (1 + 0.007 * std::log(std::max(rate, 1.0)))).epsilon(1e-12));
  }
}

TEST_CASE("HJC damage by crushing pores", "[physics][hjc]") {
  // D = integral of d mu_p/max(D1 (p* + T*), EFMin) along the virgin curve, by quadrature of mu_p.
  const HolmquistJohnsonCookBulk law = bulk_law();
  Pores pores(law);
  double damage = 0, left = 0;
  const double end = 0.02;
  for (int i = 1; i <= 20000; ++i) {
    const double p_before = pores.line.a, p = pores(end * i / 20000);
    const double now = pores.point.plastic_volumetric_strain;
    damage += (now - left) / std::max(0.04 * (0.5 * (p_before + p) + 4) / 48, 0.01);
    left = now;
  }
  CHECK(damage > 0.1);
  CHECK(damage < 0.5);
  const auto material = make(concrete({}));
  double error[2];
  for (int level = 0; level < 2; ++level) {
    PointDriver point(*material, {});
    compress_to(point, 1 / (1 + end), 500 << level);
    compress_to(point, 1 / (1 + end));  // damage is a step behind
    error[level] = std::abs(point.value(Column::damage) - damage);
    CHECK(point.value(Column::pressure) == Approx(1e6 * pores.line.a).epsilon(1e-8));
  }
  CHECK(error[0] < 4e-3 * damage);  // of first order, in 500 steps
  CHECK(error[1] < 0.7 * error[0]);
}

TEST_CASE("HJC tension is held at T (1 - D), and closes as it opened", "[physics][hjc]") {
  const auto material = make(concrete({}));
  PointDriver point(*material, {});
  // Kel = 16 GPa: -4 MPa at mu = -0.00025.
  compress_to(point, 1 / (1 - 0.0002));
  CHECK(point.value(Column::pressure) == Approx(-3.2e6).epsilon(1e-9));
  compress_to(point, 1 / (1 - 0.01));
  CHECK(point.value(Column::pressure) == Approx(-4e6).epsilon(1e-12));
  CHECK(point.value(Column::damage) == 0);
  compress_to(point, 1 / (1 - 0.0001));
  CHECK(point.value(Column::pressure) == Approx(-1.6e6).epsilon(1e-9));
  // Sheared while stretched it breaks at EFMin = 0.01, and carries nothing any more.
  compress_to(point, 1 / (1 - 0.01));
  for (int i = 0; i < 40; ++i) shear_by(point, 1e-3);
  CHECK(point.value(Column::damage) == 1);
  CHECK(point.value(Column::pressure) == 0);
  CHECK(mises(point.deviator()) == 0);
  // As rubble it has friction under pressure.
  compress_to(point, 1 / (1 + 0.0005));
  for (int i = 0; i < 40; ++i) shear_by(point, 1e-3);
  CHECK(point.value(Column::pressure) == Approx(8e6).epsilon(1e-9));
  CHECK(mises(point.deviator()) == Approx(48e6 * 1.6 * std::pow(8.0 / 48, 0.61)).epsilon(1e-9));
}

TEST_CASE("HJC fails and is eroded where the switches say so", "[physics][hjc]") {
  const auto failed_after_tension = [](const core::ParameterValues& switches, double mu) {
    const auto material = make(concrete(switches));
    PointDriver point(*material, {});
    compress_to(point, 1 / (1 + mu), 4);
    return point.has(Column::failed) ? point.value(Column::failed) : -1;
  };
  CHECK(failed_after_tension({}, -0.01) == -1);
  CHECK(failed_after_tension({{"TensileFailure", 1.0}}, -0.00024) == 0);
  CHECK(failed_after_tension({{"TensileFailure", 1.0}}, -0.00026) == 1);
  CHECK(failed_after_tension({{"ErosionByPressure", 1.0}}, -0.00024) == 0);
  CHECK(failed_after_tension({{"ErosionByPressure", 1.0}}, -0.00026) == 2);

  const auto failed_after_shear = [](const core::ParameterValues& switches, double largest_damage) {
    const auto material = make(concrete(switches));
    PointDriver point(*material, {});
    for (int i = 0; i < 4000 && point.value(Column::damage) < largest_damage; ++i) shear_by(point, 1e-5);
    return point.has(Column::failed) ? point.value(Column::failed) : -1;
  };
  CHECK(failed_after_shear({}, 1) == -1);
  CHECK(failed_after_shear({{"DamageToFail", 1.0}}, 0.99) == 0);
  CHECK(failed_after_shear({{"DamageToFail", 1.0}}, 1) == 1);
  CHECK(failed_after_shear({{"DamageToFail", 1.0}, {"FailureDamageThreshold", 0.5}}, 0.49) == 0);
  CHECK(failed_after_shear({{"DamageToFail", 1.0}, {"FailureDamageThreshold", 0.5}}, 0.51) == 1);
  CHECK(failed_after_shear({{"ErosionByDamage", 1.0}}, 0.99) == 0);
  CHECK(failed_after_shear({{"ErosionByDamage", 1.0}}, 1) == 2);
}

TEST_CASE("HJC with Threshold takes no damage below EFMin", "[physics][hjc]") {
  // At no pressure D1 T* = 1/300 < EFMin; at 16 MPa D1 (p* + T*) = 1/60 > EFMin.
  for (const double mu : {0.0, 0.001}) {
    INFO("mu " << mu);
    const auto plain = make(concrete({})), held = make(concrete({{"Threshold", 1.0}}));
    PointDriver a(*plain, {}), b(*held, {});
    for (PointDriver* point : {&a, &b}) {
      compress_to(*point, 1 / (1 + mu));
      for (int i = 0; i < 10; ++i) shear_by(*point, 1e-3);
    }
    CHECK(a.value(Column::damage) > 0.1);
    CHECK(b.value(Column::damage) == (mu > 0 ? a.value(Column::damage) : 0));
  }
}

TEST_CASE("HJC equations that contradict themselves are refused", "[physics][hjc]") {
  HolmquistJohnsonCookBulk law = bulk_law();
  law.p_lock = 16;
  CHECK(law.fault() == "PLock must be greater than PCrush");
  law.p_lock = 800, law.k2 = -4e6, law.k3 = 0;  // its greatest pressure is K1^2/(4 |K2|) = 452
  CHECK(law.fault() == "PLock is not reached by K1 m + K2 m^2 + K3 m^3: check K2 and K3");
  law = bulk_law();
  law.mu_crush = 0.12;
  CHECK(law.fault() == "MuCrush must be smaller than the locking compression");
}

}  // namespace mpm::tests
