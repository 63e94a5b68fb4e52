// The laws of bars (manual 3.2.1.2, 3.2.1.5) against curves by hand: stress along the bar alone.

#include <cmath>

#include <catch2/catch.hpp>

#include "core/scene/errors.hpp"
#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::Sym3;
using physics::PathKind;
using physics::PointDriver;

namespace {

constexpr double young = 124e9, yield0 = 200e6, tangent = 3e9;
constexpr double hardening = young * tangent / (young - tangent);

void check_uniaxial(const PointDriver& point, double stress) {
  const Sym3<double> s = point.stress();
  CHECK(s.xx == Approx(stress).epsilon(1e-11).margin(1e-12 * young));
  for (const double other : {s.yy, s.zz, s.xy, s.yz, s.xz}) CHECK(std::abs(other) < 1e-15 * young);
}

}  // namespace

TEST_CASE("an elastic bar has Young's modulus, its wave speed and its energy", "[physics][bar]") {
  const Sample& s = sample("Elastic_1D");
  const auto material = make(s.input);
  const double speed = std::sqrt(young / s.input.reference_density);
  CHECK(material->initial_sound_speed() == Approx(speed).epsilon(1e-14));
  PointDriver point(*material, {});
  drive(point, {.kind = PathKind::uniaxial_strain, .targets = {2e-3, -1e-3}, .steps = 20},
        [&](double strain) { check_uniaxial(point, young * strain); });
  CHECK(point.energy() == Approx(0.5 * young * 1e-6).epsilon(5e-3));
  CHECK(point.sound_speed() == Approx(std::sqrt(young / point.density())).epsilon(1e-12));
  // Strain across the bar is none of its business.
  point.step({0, 0, 0, 0, 0.3, 0, 0, 0, -0.2}, 1e-3);
  check_uniaxial(point, -young * 1e-3);
}

TEST_CASE("an elastic-plastic bar loads, unloads and yields the other way by hand's curve",
          "[physics][bar]") {
  const auto material = make(sample("LinHarElaPlastic_1D").input);
  PointDriver point(*material, {.extra_columns = {Column::yield_stress}});
  // To +2 %, then to -2 %: the hardening is isotropic.
  const double at_yield = yield0 / young, top = yield0 + tangent * (0.02 - at_yield);
  const double reversed = 0.02 - 2 * top / young;
  double plastic_work = 0;
  drive(point, {.kind = PathKind::uniaxial_strain, .targets = {0.02}, .steps = 200}, [&](double e) {
    check_uniaxial(point, e < at_yield ? young * e : yield0 + tangent * (e - at_yield));
  });
  const double first = point.value(Column::effective_plastic_strain);
  CHECK(first == Approx((top - yield0) / hardening).epsilon(1e-10));
  plastic_work = 0.5 * (yield0 + top) * first;
  // 0.5 top^2/E is stored, the rest is spent; the volume's change is of the order of the strain.
  CHECK(point.energy() == Approx(plastic_work + 0.5 * top * top / young).epsilon(0.02));
  PointDriver again(*material, {.extra_columns = {Column::yield_stress}});
  bool back = false;
  drive(again, {.kind = PathKind::uniaxial_strain, .targets = {0.02, -0.02}, .steps = 400}, [&](double e) {
    if (e >= 0.02 - 1e-12) back = true;
    if (!back) return;
    check_uniaxial(again, e > reversed ? top - young * (0.02 - e) : -top - tangent * (reversed - e));
    CHECK(std::abs(again.stress().xx) < (1 + 1e-10) * again.value(Column::yield_stress));
  });
  CHECK(again.value(Column::effective_plastic_strain) > 1.9 * first);
}

TEST_CASE("a bar heats by its plastic work", "[physics][bar]") {
  core::MaterialInput input = sample("LinHarElaPlastic_1D").input;
  input.strength.values["SpecHeat"] = 383.0;
  input.strength.values["TangMod"] = 0.0;
  const auto material = make(input);
  PointDriver point(*material, {.update = {.volume_update = 2}});
  drive(point, {.kind = PathKind::uniaxial_strain, .targets = {0.05}, .steps = 500}, [](double) {});
  // The work is done on the current volume, V0 exp(strain).
  const double work = yield0 * (std::exp(0.05) - std::exp(yield0 / young));
  CHECK(point.value(Column::temperature) - 293 == Approx(0.9 * work / (8960 * 383.0)).epsilon(1e-3));
  input.strength.values["TangMod"] = young;
  CHECK_THROWS_AS(make(input), core::InputErrors);
}

}  // namespace mpm::tests
