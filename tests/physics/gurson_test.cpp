// The porous metal of Gurson, Tvergaard and Needleman (manual 3.2.1.18): void growth against an integration
// of its own, nucleation against its integral, coalescence and failure, the matrices, and the scatter of f0.

#include <cmath>

#include <catch2/catch.hpp>

#include "core/scene/errors.hpp"
#include "physics/material/scatter.hpp"
#include "physics/point/point_driver.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

namespace {

using core::Column;
using core::Sym3;
using physics::PathKind;
using physics::PointDriver;

// Tvergaard and Needleman, Acta Metallurgica 32 (1984) 157.
constexpr double q1 = 1.5, q2 = 1, fc = 0.15, ff = 0.25;
constexpr double young = 124e9, yield0 = 200e6;

core::MaterialInput porous(const core::ParameterValues& more) {
  core::MaterialInput input;
  input.name = "porous";
  input.reference_density = 8960;
  input.strength.type = "Gurson";
  input.strength.values = {{"Young", young}, {"Poisson", 0.34}, {"Yield0", yield0}, {"q1", q1},
                           {"q2", q2},       {"f0", 0.02},      {"fc", fc},         {"ff", ff}};
  for (const auto& [name, value] : more) input.strength.values[name] = value;
  return input;
}

double effective(double f) {  // (3.38)
  return f <= fc ? f : f > ff ? 1 / q1 : fc + (1 / q1 - fc) / (ff - fc) * (f - fc);
}

/// Phi (3.37) of the state, with the matrix stress that the law reports.
double surface(const PointDriver& point) {
  const double m = point.value(Column::yield_stress), q = mises(point.deviator()) / m;
  const double mean = -point.value(Column::pressure), f = effective(point.value(Column::porosity));
  return q * q + 2 * q1 * f * std::cosh(1.5 * q2 * mean / m) - 1 - q1 * q1 * f * f;
}

PointDriver::Options with_yield() { return {.extra_columns = {Column::yield_stress}}; }

/// One step of axisymmetric stretch at the triaxiality sigma_m/q; `lateral` is the lateral over the axial
/// rate, found by the secant and kept for the next step.
void step_at_triaxiality(PointDriver& point, double triaxiality, double strain, double& lateral) {
  const PointDriver::State before = point.save();
  const double dt = 1e-3, rate = strain / dt;
  const auto excess = [&](double r) {
    point.restore(before);
    point.step({rate, 0, 0, 0, r * rate, 0, 0, 0, r * rate}, dt);
    return (-point.value(Column::pressure) - triaxiality * mises(point.deviator())) / yield0;
  };
  double a = lateral - 1e-3, b = lateral, fa = excess(a), fb = excess(b);
  for (int i = 0; i < 80 && std::abs(fb) > 1e-11; ++i) {
    const double c = fb == fa ? b : b - fb * (b - a) / (fb - fa);
    a = b, fa = fb, b = std::min(std::max(c, -0.6), 1.0), fb = excess(b);
  }
  REQUIRE(std::abs(fb) < 1e-8);
  lateral = b;
}

/// df/d eps_q at constant triaxiality T without nucleation: only the surface's shape counts, whatever the
/// matrix. q/M from Phi = 0 by bisection; df = (1 - f) d eps_v, d eps_v/d eps_q = Phi,m/Phi,q.
double growth(double f, double triaxiality) {
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double r = 0.5 * (low + high);
    const double phi = r * r + 2 * q1 * effective(f) * std::cosh(1.5 * q2 * triaxiality * r) - 1 -
                       q1 * q1 * effective(f) * effective(f);
    (phi > 0 ? high : low) = r;
  }
  return (1 - f) * 1.5 * q1 * q2 * effective(f) * std::sinh(1.5 * q2 * triaxiality * low) / low;
}

/// f after the deviatoric plastic strain, by the classical Runge-Kutta rule.
double grown(double f, double strain, double triaxiality) {
  const int steps = 4000;
  const double h = strain / steps;
  for (int i = 0; i < steps; ++i) {
    const double k1 = growth(f, triaxiality), k2 = growth(f + h / 2 * k1, triaxiality);
    const double k3 = growth(f + h / 2 * k2, triaxiality), k4 = growth(f + h * k3, triaxiality);
    f += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return f;
}

std::string fault(const core::ParameterValues& values) {
  try {
    make(porous(values));
  } catch (const core::InputErrors& errors) { return errors.what(); }
  return "";
}

}  // namespace

TEST_CASE("voids grow at constant triaxiality as the rate equations say, with first order",
          "[physics][gurson]") {
  for (const double triaxiality : {0.5, 1.0, 2.0}) {
    const double strain = triaxiality < 2 ? 0.2 : 0.05;
    const auto material = make(porous({{"TangMod", 1e9}}));
    double last = 0;
    for (const int steps : {100, 200, 400}) {
      PointDriver point(*material, with_yield());
      double lateral = -0.3, worst = 0;
      for (int i = 0; i < steps; ++i) {
        step_at_triaxiality(point, triaxiality, strain / steps, lateral);
        if (point.value(Column::effective_plastic_strain) > 0)
          worst = std::max(worst, std::abs(surface(point)));
      }
      CHECK(worst < 1e-12);
      const double f = point.value(Column::porosity);
      const double exact = grown(0.02, point.value(Column::effective_plastic_strain), triaxiality);
      INFO("triaxiality " << triaxiality << " steps " << steps << " f " << f << " exact " << exact);
      CHECK(f > 1.1 * 0.02);
      const double error = std::abs(f - exact) / (exact - 0.02);
      CHECK(error < 4.0 / steps);
      if (last > 0) CHECK(std::log2(last / error) == Approx(1).margin(0.25));
      last = error;
    }
  }
}

TEST_CASE("a step that ends inside the surface is counted, and no other", "[physics][gurson]") {
  int lost = 0;
  for (const double f0 : {0.001, 0.0}) {
    const auto material =
        make(porous({{"f0", f0}, {"TangMod", 1e9}, {"fN", 0.04}, {"sN", 0.01}, {"eN", 0.02}}));
    for (const double strain : {1e-3, 3e-3, 1e-2, 0.03, 0.1, 0.2, 0.4}) {
      if (f0 == 0 && strain > 0.03) continue;  // cosh would overflow
      for (const double lateral : {-0.45, -0.3, 0.0, 0.5, 0.9}) {
        for (const double sign : {1.0, -1.0}) {
          PointDriver point(*material, with_yield());
          for (int step = 0; step < 5; ++step) {
            const double before = point.value(Column::history_0), l = sign * strain,
                         q = mises(point.deviator());
            point.step({l, 0, 0, 0, l * lateral, 0, 0, 0, l * lateral}, 1);
            INFO("strain " << l << " lateral " << lateral << " step " << step << " Phi " << surface(point));
            const bool flowed = point.value(Column::history_0) > before;
            // Without voids the inside is elastic; no deviator is lost where the last of them close.
            const bool closed =
                point.value(Column::porosity) == 0 && surface(point) < 0 && point.value(Column::pressure) > 0;
            if (flowed && closed) CHECK(mises(point.deviator()) >= q);
            const bool off = flowed && !closed && std::abs(surface(point)) > 1e-7;
            CHECK((point.events().unresolved > 0) == off);
            if (strain <= 3e-3 && f0 > 0) CHECK_FALSE(off);
            lost += off ? 1 : 0;
            if (off) break;
          }
        }
      }
    }
  }
  CHECK(lost > 0);
}

TEST_CASE("voids nucleate by the normal distribution of the matrix strain", "[physics][gurson]") {
  // In shear no void grows: f is the integral of A (3.42).
  const double fn = 0.04, sn = 0.05, en = 0.1;
  const auto material = make(porous({{"f0", 0.0}, {"TangMod", 1e9}, {"fN", fn}, {"sN", sn}, {"eN", en}}));
  for (const double target : {0.1, 0.2, 0.5}) {
    PointDriver point(*material, with_yield());
    const double rate = 0.5 * target * std::sqrt(3.0);  // pure shear: eps_q = target after a unit of time
    for (int i = 0; i < 500; ++i) point.step({0, rate, 0, rate, 0, 0, 0, 0, 0}, 1.0 / 500);
    const double e = point.value(Column::history_0), root = sn * std::sqrt(2.0);
    const double exact = 0.5 * fn * (std::erf((e - en) / root) + std::erf(en / root));
    CHECK(e > 0.9 * target);
    CHECK(point.value(Column::porosity) == Approx(exact).epsilon(1e-3));
    CHECK(std::abs(point.value(Column::pressure)) < 1e-9 * yield0);
  }
}

TEST_CASE("under pressure no voids nucleate, and the deviator stays on the surface", "[physics][gurson]") {
  const auto material = make(porous({{"f0", 0.0}, {"TangMod", 1e9}, {"fN", 0.04}, {"sN", 0.1}, {"eN", 0.1}}));
  for (const int steps : {50, 400}) {
    PointDriver point(*material, with_yield());
    for (int i = 0; i < steps; ++i) {
      point.step({-0.06 / steps, 0, 0, 0, 0, 0, 0, 0, 0}, 1.0);
      if (i < steps / 2) continue;
      INFO("step " << i << " of " << steps);
      CHECK(mises(point.deviator()) == Approx(point.value(Column::yield_stress)).epsilon(1e-9));
    }
    CHECK(point.value(Column::pressure) > 10 * point.value(Column::yield_stress));
    CHECK(point.value(Column::porosity) == 0);
  }
}

TEST_CASE("coalescence empties the surface and the particle fails at ff", "[physics][gurson]") {
  const auto material = make(porous({{"f0", 0.12}, {"TangMod", 1e9}}));
  PointDriver point(*material, with_yield());
  double lateral = -0.3, before = 0, at_coalescence = 0, f = 0.12;
  int steps = 0;
  while (point.value(Column::failed) == 0 && ++steps < 4000) {
    step_at_triaxiality(point, 1.0, 2e-4, lateral);
    if (point.value(Column::failed) > 0) break;
    if (point.value(Column::effective_plastic_strain) > 0) CHECK(std::abs(surface(point)) < 1e-12);
    before = mises(point.deviator());
    f = point.value(Column::porosity);
    if (f < fc) at_coalescence = before;
    CHECK(point.value(Column::damage) == Approx(f * f / (ff * ff)).epsilon(1e-12));
  }
  // Just before ff hardly any of the strength at fc is left; then nothing.
  CHECK(f > 0.98 * ff);
  CHECK(before < 0.1 * at_coalescence);
  CHECK(point.value(Column::failed) == 1);
  CHECK(mises(point.deviator()) == 0);
  CHECK(point.value(Column::pressure) == 0);
}

TEST_CASE("a step of some per cent of strain ends on or within the surface", "[physics][gurson]") {
  for (const double size : {1e-4, 1e-2, 0.05}) {
    for (unsigned seed = 0; seed < 40; ++seed) {
      const auto material = make(porous({{"f0", seed % 2 ? 0.1 : 0.001}, {"TangMod", 1e9}}));
      PointDriver point(*material, with_yield());
      const RandomPath path(seed, size, 1);
      for (int i = 0; i < 3 && point.value(Column::failed) == 0; ++i) {
        point.step(path.gradient(0.1 + 0.3 * i), 0.3);
        INFO("size " << size << " seed " << seed << " step " << i);
        if (point.value(Column::failed) == 0) CHECK(surface(point) < 1e-8);
        CHECK(point.events().not_finite == 0);
      }
    }
  }
}

TEST_CASE("with epmax strain and voids fail together by TEPLA-F", "[physics][gurson]") {
  const double epmax = 0.15;
  const auto material = make(porous({{"TangMod", 1e9}, {"epmax", epmax}}));
  PointDriver point(*material, with_yield());
  double lateral = -0.3, f = 0, strain = 0;
  for (int i = 0; i < 2000 && point.value(Column::failed) == 0; ++i) {
    f = point.value(Column::porosity), strain = point.value(Column::effective_plastic_strain);
    step_at_triaxiality(point, 1.0, 2e-4, lateral);
  }
  CHECK(point.value(Column::failed) == 1);
  // (3.43) holds to within the last step.
  CHECK(std::pow(f / ff, 2) + std::pow(strain / epmax, 2) == Approx(1).epsilon(5e-3));
  CHECK(f / ff > 0.1);
  CHECK(strain / epmax > 0.9);
}

TEST_CASE("pressure closes voids and leaves none below zero", "[physics][gurson]") {
  const auto material = make(porous({{"f0", 0.005}, {"TangMod", 1e9}}));
  PointDriver point(*material, with_yield());
  for (int i = 0; i < 400; ++i) point.step({-0.4, 0, 0, 0, 0.1, 0, 0, 0, 0.1}, 1e-3);
  CHECK(point.value(Column::porosity) == 0);
  // What is left is the matrix: von Mises with the matrix stress.
  CHECK(mises(point.deviator()) == Approx(point.value(Column::yield_stress)).epsilon(1e-10));
}

TEST_CASE("without voids the matrices are the dense metals", "[physics][gurson]") {
  const RandomPath path(6, 0.02, 2e-5);
  const auto compare = [&](const core::MaterialInput& dense, const core::ParameterValues& matrix, int steps) {
    core::ParameterValues values = matrix;
    values["f0"] = 0.0;
    const auto a = make(dense), b = make(porous(values));
    PointDriver metal(*a, {}), gurson(*b, {});
    for (int i = 0; i < steps; ++i) {
      metal.step(path.gradient((i + 0.5) * 2e-5 / steps), 2e-5 / steps);
      gurson.step(path.gradient((i + 0.5) * 2e-5 / steps), 2e-5 / steps);
    }
    CHECK(gurson.value(Column::effective_plastic_strain) > 0.005);
    CHECK(gurson.value(Column::history_0) ==
          Approx(gurson.value(Column::effective_plastic_strain)).epsilon(1e-4));
    const Sym3<double> difference = metal.stress() - gurson.stress();
    return std::sqrt(contract(difference, difference)) /
           mises(metal.stress() - gurson.stress() + metal.deviator());
  };
  core::MaterialInput linear = copper("IsoHarden");
  linear.strength.values["TangMod"] = 3e9;
  CHECK(compare(linear, {{"TangMod", 3e9}}, 400) < 1e-4);
  CHECK(compare(copper("SimJohnsonCook"),
                {{"Yield0", 90e6}, {"B", 292e6}, {"n", 0.31}, {"C", 0.025}, {"epso", 1.0}}, 400) < 1e-4);
  // N_hard: M = Yield0 (1 + E e/Yield0)^(1/N), in uniaxial stress.
  const auto power = make(porous({{"f0", 0.0}, {"N_hard", 5.0}}));
  PointDriver bar(*power, {});
  REQUIRE(drive(bar, {.kind = PathKind::uniaxial_stress, .targets = {0.1}, .steps = 500}, [](double) {}));
  const double e = bar.value(Column::effective_plastic_strain);
  CHECK(bar.stress().xx == Approx(yield0 * std::pow(1 + young / yield0 * e, 0.2)).epsilon(1e-4));
}

TEST_CASE("initial voids scatter by the particle's identity", "[physics][gurson]") {
  double sum = 0, squares = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double x = physics::normal_deviate(static_cast<double>(i));
    sum += x, squares += x * x;
  }
  // Standard errors: 1/sqrt(n) of the mean, sqrt(2/n) of the variance; four of each.
  CHECK(std::abs(sum / n) < 4 / std::sqrt(n));
  CHECK(squares / n == Approx(1).margin(4 * std::sqrt(2.0 / n)));

  const auto material = make(porous({{"TangMod", 1e9}, {"Gauss_f0", 0.03}, {"Gauss_sn", 0.02}}));
  core::ColumnSet set = core::ColumnSet::mechanics();
  set.add(material->columns({}));
  const core::ColumnLayout layout(set);
  std::vector<double> memory(static_cast<std::size_t>(8 * layout.block_doubles()), 0.0);
  core::Batch batch{};
  batch.layout = &layout, batch.blocks = 8, batch.particles = 64, batch.cell_size = 1;
  for (int b = 0; b < 8; ++b) {
    batch.block[b] = memory.data() + b * layout.block_doubles();
    for (int i = 0; i < 8; ++i) {
      batch.column(Column::mass, b)[i] = 8960, batch.column(Column::volume, b)[i] = 1;
      batch.column(Column::identity, b)[i] = 8 * b + i;
    }
  }
  material->initialise(batch, {});
  int cut = 0;
  for (int i = 0; i < 64; ++i) {
    const double drawn = 0.03 + 0.02 * physics::normal_deviate(i);
    CHECK(batch.column(Column::porosity, i / 8)[i % 8] ==
          Approx(std::min(std::max(drawn, 0.0), 0.999 * ff)).epsilon(1e-14));
    cut += drawn < 0;
  }
  CHECK(cut > 0);
}

TEST_CASE("what a porous metal may not be is refused by name", "[physics][gurson]") {
  using Catch::Matchers::Contains;
  CHECK_THAT(fault({}), Contains("one matrix"));
  CHECK_THAT(fault({{"TangMod", 1e9}, {"N_hard", 5.0}}), Contains("one matrix"));
  CHECK_THAT(fault({{"TangMod", young}}), Contains("TangMod must be smaller than Young"));
  CHECK_THAT(fault({{"TangMod", 1e9}, {"fc", 0.3}}), Contains("fc must be smaller than ff"));
  CHECK_THAT(fault({{"TangMod", 1e9}, {"fc", 0.7}, {"ff", 0.9}}), Contains("fc must be smaller than 1/q1"));
  CHECK_THAT(fault({{"TangMod", 1e9}, {"f0", 0.26}}), Contains("f0 must be smaller than ff"));
}

}  // namespace mpm::tests
