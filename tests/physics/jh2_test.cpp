// JH-2 ceramics: strength and strain to fracture against values worked out apart from this code from the
// manual's formulas (3-35, 3-36) for its alumina (table 6.7, with a rate constant of 0.01 and SFMax 0.4), in
// MPa; damage, bulking and pressure against closed forms.

#include "physics/strength/jh2.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/brittle_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::JH2;
using physics::PointDriver;

namespace {

JH2 alumina() {
  JH2 law;
  law.young = 220e3, law.poisson = 0.22;
  law.a = 0.93, law.b = 0.31, law.c = 0.01, law.m = 0.6, law.n = 0.6, law.epso = 1;
  law.t = 200, law.sfmax = 0.4, law.shel = 2000, law.phel = 1460, law.beta = 1;
  law.d1 = 0.005, law.d2 = 1;
  law.prepare(3.7e-3);
  return law;
}

/// The sample, silicon carbide in SI.
core::MaterialInput carbide(const core::ParameterValues& more) {
  core::MaterialInput input = sample("JH2").input;
  for (const auto& [name, value] : more) input.strength.values.insert_or_assign(name, value);
  return input;
}
constexpr double young = 423e9, poisson = 0.156, g = young / (2 * (1 + poisson)),
                 k = young / (3 * (1 - 2 * poisson));

}  // namespace

TEST_CASE("JH2 intact and fractured strength and strain to fracture at tabulated pressures",
          "[physics][jh2]") {
  const JH2 law = alumina();
  struct Row {
    double pressure, rate, intact, fractured, fracture;
  };
  for (const Row& row : {Row{0, 1, 564.311925387, 0, 0.000684931506849},
                         {730, 1, 1419.02811409, 409.04745234, 0.00318493150685},
                         {1460, 1, 2008.9359177, 620, 0.00568493150685},
                         {1460, 1e3, 2147.70829461, 662.82808273, 0.00568493150685},
                         {1460, 1e-3, 2008.9359177, 620, 0.00568493150685},
                         {2920, 1, 2933.55332565, 800, 0.0106849315068},  // SFMax
                         {2920, 1e3, 3136.19601037, 800, 0.0106849315068},
                         {-100, 1, 372.307024846, 0, 0.000342465753425},
                         {-200, 1, 0, 0, 0},
                         {-300, 1, 0, 0, 0}}) {
    INFO(row.pressure << " MPa, rate " << row.rate);
    const auto both = law.strengths(row.pressure, row.rate);
    CHECK(both.intact == Approx(row.intact).epsilon(1e-11));
    CHECK(both.fractured == Approx(row.fractured).epsilon(1e-11));
    CHECK(both.at(0.25) == Approx(0.75 * row.intact + 0.25 * row.fractured).epsilon(1e-11));
    CHECK(law.fracture_strain(row.pressure) == Approx(row.fracture).epsilon(1e-11));
  }
}

TEST_CASE("JH2 alumina yields at its Hugoniot elastic limit", "[physics][jh2]") {
  // Phel + 2/3 Shel = 2.79 GPa: three parameters that only an elastic path to the strength brings together.
  core::MaterialInput input = carbide({{"Young", 220e9},
                                       {"Poisson", 0.22},
                                       {"A", 0.93},
                                       {"B", 0.31},
                                       {"C", 0.0},
                                       {"M", 0.6},
                                       {"N", 0.6},
                                       {"T", 0.2e9},
                                       {"SFMax", 1e20},
                                       {"Shel", 2e9},
                                       {"Phel", 1.46e9},
                                       {"D1", 0.005},
                                       {"D2", 1.0},
                                       {"K2", 0.0},
                                       {"K3", 0.0}});
  input.reference_density = 3700;
  const auto material = make(input);
  PointDriver point(*material, {});
  double limit = 0;
  for (int i = 0; i < 2000 && point.value(Column::effective_plastic_strain) == 0; ++i) {
    limit = -point.stress().xx;
    point.step({-1e-5, 0, 0, 0, 0, 0, 0, 0, 0}, 1);
  }
  CHECK(limit == Approx(1.46e9 + 2e9 / 1.5).epsilon(0.01));
}

TEST_CASE("JH2 damage in shear at constant pressure follows its closed form", "[physics][jh2]") {
  // Y = Yi - (Yi - Yf) D, epef = D ef: the strain Y/(3 G) + epef is linear in D.
  const auto material = make(carbide({{"C", 0.0}, {"beta", 0.0}}));
  const double mu = 0.02;
  const double pressure = mu * (k + mu * (361e9 + mu * 200e9)), p = pressure / 5.9e9;
  const double intact = 13e9 * 0.96 * std::pow(p + 0.37 / 5.9, 0.65), fractured = 13e9 * 0.35 * p;
  const double ef = 0.48 * std::pow(p + 0.37 / 5.9, 0.48);
  const double strain = intact / (3 * g) + 0.5 * (ef - (intact - fractured) / (3 * g));
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const int steps = 400 << level;
    PointDriver point(*material, {});
    compress_to(point, 1 / (1 + mu));
    for (int i = 0; i < steps; ++i) shear_by(point, strain / steps);
    CHECK(point.value(Column::pressure) == Approx(pressure).epsilon(1e-9));
    CHECK(point.value(Column::bulking_pressure) == 0);
    CHECK(mises(point.deviator()) == Approx(0.5 * (intact + fractured)).epsilon(2e-3));
    error[level] = std::abs(point.value(Column::damage) - 0.5);
  }
  CHECK(error[0] < 2e-3);
  CHECK(std::log2(error[0] / error[1]) == Approx(1).margin(0.1));
}

TEST_CASE("JH2 bulking pressure takes its part of the elastic energy lost", "[physics][jh2]") {
  // Strength that does not depend on the pressure (N = M = 0): the steps' energies add up to that between
  // A Shel and B Shel, whatever the steps.
  const double mu = 0.02, intact = 0.96 * 13e9, fractured = 0.35 * 13e9;
  const double lost = (intact * intact - fractured * fractured) / (6 * g);
  for (const double beta : {0.0, 0.4, 1.0}) {
    for (const int steps : {20, 300}) {
      INFO("beta " << beta << ", steps " << steps);
      const auto material =
          make(carbide({{"C", 0.0}, {"N", 0.0}, {"M", 0.0}, {"D1", 0.02}, {"D2", 0.0}, {"beta", beta}}));
      PointDriver point(*material, {});
      compress_to(point, 1 / (1 + mu));
      const double before = point.value(Column::pressure);
      for (int i = 0; i < steps; ++i) shear_by(point, 0.06 / steps);
      REQUIRE(point.value(Column::damage) == 1);
      const double bulking = std::sqrt(k * mu * k * mu + 2 * beta * k * lost) - k * mu;
      CHECK(point.value(Column::bulking_pressure) == Approx(bulking).epsilon(1e-9).margin(1e-3));
      CHECK(point.value(Column::pressure) == Approx(before + bulking).epsilon(1e-9));
      // It stays when the material expands, until its strength in tension, of which none is left, is reached.
      compress_to(point, 1 / (1 - 0.001));
      CHECK(point.value(Column::pressure) ==
            Approx(std::max(bulking - 0.001 * k, 0.0)).epsilon(1e-9).margin(1e-3));
    }
  }
}

TEST_CASE("JH2 pressure on both sides, its limit in tension and its energy", "[physics][jh2]") {
  const auto material = make(carbide({}));
  PointDriver point(*material, {});
  for (const double mu : {0.01, 0.05, 0.1}) {
    compress_to(point, 1 / (1 + mu));
    CHECK(point.value(Column::pressure) == Approx(mu * (k + mu * (361e9 + mu * 200e9))).epsilon(1e-9));
  }
  compress_to(point, 1 / (1 - 0.001));
  CHECK(point.value(Column::pressure) == Approx(-0.001 * k).epsilon(1e-9));
  compress_to(point, 1 / (1 - 0.01));
  CHECK(point.value(Column::pressure) == Approx(-0.37e9).epsilon(1e-12));
  CHECK(point.value(Column::damage) == 0);
  // Any flow at the largest tension breaks it altogether.
  shear_by(point, 1e-4);
  CHECK(point.value(Column::damage) == 1);
  CHECK(point.value(Column::pressure) == 0);

  // A body placed compressed has the energy that the way there takes: p d(mu)/(1 + mu)^2 by Simpson's rule.
  for (const double end : {0.08, -0.0005}) {
    double energy = 0;
    const int n = 1000;
    const auto p = [&](double mu) { return mu > 0 ? mu * (k + mu * (361e9 + mu * 200e9)) : k * mu; };
    const auto f = [&](double mu) { return p(mu) / ((1 + mu) * (1 + mu)); };
    for (int i = 0; i < n; ++i) {
      const double h = end / n, x = i * h;
      energy += h / 6 * (f(x) + 4 * f(x + 0.5 * h) + f(x + h));
    }
    PointDriver placed(*material, {.density = 3163 * (1 + end)});
    // Of terms of the size of mu, mu^2 remains.
    CHECK(placed.energy() == Approx(energy).epsilon(1e-8));
    CHECK(placed.value(Column::pressure) == Approx(p(end)).epsilon(1e-9));
  }
}

TEST_CASE("JH2 has its pressure and wants no other", "[physics][jh2]") {
  core::MaterialInput input = carbide({});
  input.eos = core::LawInput{"Gruneisen", {{"C0", 8000.0}, {"S1", 1.0}, {"gamma0", 1.0}}, {}};
  CHECK_THROWS_WITH(make(input), Catch::Contains("computes its pressure itself"));
}

}  // namespace mpm::tests
