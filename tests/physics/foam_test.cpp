// The foam of Deshpande and Fleck (manual 3.2.1.17): plateau and densification in uniaxial and hydrostatic
// compression, lateral strain, the limit of von Mises, and failure by expansion.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

namespace {

using core::Column;
using core::Sym3;
using physics::PathKind;
using physics::PointDriver;

constexpr double young = 1e9, poisson = 0.2, bulk = young / (3 * (1 - 2 * poisson));
constexpr double plateau = 5e6, alal = 4e6, gama = 1e6, beta = 2.5, locking = 1.5;

core::MaterialInput foam(double alfa, const core::ParameterValues& more = {}) {
  core::MaterialInput input;
  input.name = "foam";
  input.reference_density = 300;
  input.strength.type = "DFFoam";
  input.strength.values = {{"Young", young}, {"Poisson", poisson}, {"Yield0", plateau},
                           {"alfa", alfa},   {"epsud", locking},   {"alal", alal},
                           {"gama", gama},   {"bebe", beta},       {"vole", 0.0}};
  for (const auto& [name, value] : more) input.strength.values[name] = value;
  return input;
}

/// Y of the manual's second formula in 3.2.1.17.
double yield(double strain) {
  const double r = strain / locking;
  return plateau + gama * r + alal * std::log(1 / (1 - std::pow(r, beta)));
}

}  // namespace

TEST_CASE("in uniaxial stress a foam follows its hardening curve, plateau and densification",
          "[physics][foam]") {
  for (const double alfa : {0.0, 1.0, 1.6, 3 / std::sqrt(2.0)}) {
    const auto material = make(foam(alfa));
    PointDriver point(*material, {.extra_columns = material->columns({.keep_strain = true})});
    double lateral_before = 0, strain_before = 0, at_plateau = 0;
    // Both equivalents are the axial ones: sigma = -Y(e), e = strain - sigma/E; lateral plastic strain in the
    // ratio (1/2 - (alfa/3)^2)/(1 + (alfa/3)^2) (Deshpande and Fleck 2000).
    const double ratio = (0.5 - alfa * alfa / 9) / (1 + alfa * alfa / 9);
    REQUIRE(
        drive(point, {.kind = PathKind::uniaxial_stress, .targets = {-1.4}, .steps = 700}, [&](double axial) {
          const double e = point.value(Column::effective_plastic_strain), stress = point.stress().xx;
          if (e > 0) {
            CHECK(stress == Approx(-yield(e)).epsilon(1e-7));
            CHECK(e == Approx(-axial + stress / young).epsilon(1e-4));
          }
          const double lateral = point.value(Column::strain_yy) - poisson * -stress / young;
          if (e > 0.1) CHECK(lateral - lateral_before == Approx(ratio * (e - strain_before)).margin(1e-6));
          lateral_before = lateral, strain_before = e;
          if (at_plateau == 0 && e > 0.1 * locking) at_plateau = -stress;
        }));
    CHECK(at_plateau < 1.1 * plateau);
    CHECK(-point.stress().xx > 2.5 * plateau);
  }
}

TEST_CASE("under pressure a foam yields at sqrt(1 + (alfa/3)^2)/alfa of its strength", "[physics][foam]") {
  const double alfa = 1.6, factor = std::sqrt(1 + alfa * alfa / 9) / alfa;
  const auto material = make(foam(alfa));
  PointDriver point(*material, {});
  drive(point, {.kind = PathKind::hydrostatic, .targets = {-0.6}, .steps = 300}, [&](double volume) {
    const double e = point.value(Column::effective_plastic_strain), p = point.value(Column::pressure);
    if (e == 0) return;
    CHECK(p == Approx(factor * yield(e)).epsilon(1e-9));
    // p d(volume) = Y de, so that e is the plastic volume strain over the same factor.
    CHECK(factor * (-volume - p / bulk) == Approx(e).epsilon(1e-9));
  });
  CHECK(point.value(Column::effective_plastic_strain) > 0.3);
}

TEST_CASE("the stress is on the foam's surface after any path", "[physics][foam]") {
  for (const double alfa : {0.3, 1.6, 2.1}) {
    const auto material = make(foam(alfa));
    const RandomPath path(3, 0.3, 2e-5);
    PointDriver point(*material, {.extra_columns = {Column::yield_stress}});
    double strain = 0;
    int flowing = 0;
    for (int i = 0; i < 200; ++i) {
      point.step(path.gradient((i + 0.5) * 1e-7), 1e-7);
      const double e = mises(point.deviator()), m = point.value(Column::pressure);
      const double hat = std::sqrt((e * e + alfa * alfa * m * m) / (1 + alfa * alfa / 9));
      const double y = yield(point.value(Column::effective_plastic_strain));
      CHECK(point.value(Column::yield_stress) == Approx(y).epsilon(1e-12));
      CHECK(hat < (1 + 1e-10) * y);
      if (point.value(Column::effective_plastic_strain) > strain) {
        ++flowing;
        CHECK(hat == Approx(y).epsilon(1e-10));
      }
      strain = point.value(Column::effective_plastic_strain);
    }
    CHECK(flowing > 50);
  }
}

TEST_CASE("with alfa = 0 and no hardening a foam is von Mises' metal", "[physics][foam]") {
  core::MaterialInput metal = foam(0);
  metal.strength.type = "ElaPlastic";
  metal.strength.values = {{"Young", young}, {"Poisson", poisson}, {"Yield0", plateau}};
  const auto a = make(foam(0, {{"alal", 0.0}, {"gama", 0.0}})), b = make(metal);
  PointDriver first(*a, {}), second(*b, {});
  const RandomPath path(5, 0.05, 2e-5);
  for (int i = 0; i < 200; ++i) {
    first.step(path.gradient((i + 0.5) * 1e-7), 1e-7);
    second.step(path.gradient((i + 0.5) * 1e-7), 1e-7);
  }
  const Sym3<double> d = first.stress() - second.stress();
  CHECK(std::sqrt(contract(d, d)) < 1e-8 * plateau);
  CHECK(second.value(Column::effective_plastic_strain) > 0.005);
  CHECK(first.value(Column::effective_plastic_strain) ==
        Approx(second.value(Column::effective_plastic_strain)).epsilon(1e-8));
}

TEST_CASE("a foam squeezed beyond its densification strain stays finite", "[physics][foam]") {
  const auto material = make(foam(1.6, {{"epsud", 0.3}}));
  PointDriver point(*material, {});
  for (int i = 0; i < 100; ++i) point.step({-1, 0, 0, 0, 0, 0, 0, 0, 0}, 0.02);
  CHECK(std::isfinite(point.stress().xx));
  CHECK(point.stress().xx < -alal * 20);
  CHECK(point.events().not_finite == 0);
}

TEST_CASE("a foam fails where its volume strain reaches vole", "[physics][foam]") {
  const auto material = make(foam(1.0, {{"vole", 0.1}}));
  PointDriver point(*material, {});
  // First squeezed, then torn: the total volume counts.
  drive(point, {.kind = PathKind::hydrostatic, .targets = {-0.1, 0.15}, .steps = 250}, [&](double) {
    const double stretch = std::log(point.volume_ratio());
    CHECK((point.value(Column::failed) > 0) == (stretch >= 0.1));
    if (point.value(Column::failed) > 0) CHECK(point.value(Column::pressure) == 0);
  });
  CHECK(point.value(Column::failed) == 1);
  CHECK_FALSE(make(foam(1.0))->columns({}).has(Column::failed));
}

}  // namespace mpm::tests
