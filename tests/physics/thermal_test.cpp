// Thermal expansion (TemperatureCoefficient) and adiabatic heat.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::Mat3;
using physics::PathKind;
using physics::PointDriver;

namespace {

constexpr double young = 124e9, poisson = 0.34, alpha = 17e-6, room = 293, heat_capacity = 383;
constexpr double bulk = young / (3 * (1 - 2 * poisson));

std::unique_ptr<physics::Material> expanding(const char* strength = "IsoElastic") {
  core::MaterialInput input = copper(strength);
  input.strength.values["SpecHeat"] = heat_capacity;
  input.strength.values["TemperatureCoefficient"] = alpha;
  return make(input);
}

/// `steps` steps of `rate` and of heating by `rise` in all, done by somebody else.
void heat(PointDriver& point, double rise, const Mat3<double>& rate, int steps) {
  for (int i = 0; i < steps; ++i) {
    point.set(Column::temperature, point.value(Column::temperature) + rise / steps);
    point.step(rate, 1.0 / steps);
  }
}

}  // namespace

TEST_CASE("free expansion brings no stress", "[physics][thermal]") {
  for (const char* strength : {"IsoElastic", "CauchyElastic", "IsoHarden"}) {
    INFO(strength);
    const auto material = expanding(strength);
    for (const double rise : {400.0, -200.0}) {
      PointDriver point(*material, {.update = {.volume_update = 2}});
      const double e = alpha * rise;
      heat(point, rise, {e, 0, 0, 0, e, 0, 0, 0, e}, 50);
      // Round-off of 50 increments.
      CHECK(std::abs(point.stress().xx) < 1e-12 * bulk * std::abs(e));
      CHECK(std::abs(point.stress().yy) < 1e-12 * bulk * std::abs(e));
      CHECK(point.volume_ratio() == Approx(std::exp(3 * e)).epsilon(1e-13));
      CHECK(std::abs(point.energy()) < 1e-12 * bulk * e * e);
    }
  }
}

TEST_CASE("held expansion presses with 3 K alpha dT", "[physics][thermal]") {
  const auto material = expanding();
  for (const int steps : {1, 7, 100}) {
    PointDriver point(*material, {.cell_size = 1e-3});
    heat(point, 250, {}, steps);
    CHECK(point.value(Column::pressure) == Approx(3 * bulk * alpha * 250).epsilon(1e-12));
    CHECK(point.value(Column::viscous_pressure) == 0);  // nothing moves
    CHECK(mises(point.deviator()) == 0);
    heat(point, -250, {}, steps);
    CHECK(std::abs(point.value(Column::pressure)) < 1e-12 * bulk);
  }
}

TEST_CASE("a body that starts hot is one that was heated in place", "[physics][thermal]") {
  // Expansion by coefficient, and by the energy in the equation of state.
  core::MaterialInput shocked = copper("IsoHarden heated");
  shocked.eos =
      core::LawInput{"Gruneisen", {{"C0", 3940}, {"S1", 1.49}, {"gamma0", 2}, {"simplified", 0}}, {}};
  const std::unique_ptr<physics::Material> materials[] = {expanding(), expanding("IsoHarden"), make(shocked)};
  for (const auto& material : materials) {
    for (const double rise : {250.0, -100.0}) {
      PointDriver heated(*material, {}), hot(*material, {.temperature = room + rise});
      const double heat_per_volume = material->reference_density() * material->specific_heat() * rise;
      heated.set(Column::temperature, room + rise);
      heated.set(Column::internal_energy, heat_per_volume);
      CHECK(hot.value(Column::temperature) == room + rise);
      const double before = hot.value(Column::pressure);
      heated.step({}, 1.0);
      hot.step({}, 1.0);
      CHECK(std::abs(before) > 1e6);
      CHECK(hot.value(Column::pressure) == Approx(before).epsilon(1e-12));  // nothing has happened to it
      CHECK(hot.value(Column::pressure) == Approx(heated.value(Column::pressure)).epsilon(1e-12));
      // The elastic bulk also has the work that a free body would do; the shocked one has the heat alone.
      const double e = 3 * alpha * rise, v = std::exp(-e);
      const double stored = material == materials[2] ? 0 : bulk * (1 - v - v * e);
      CHECK(hot.energy() == Approx(heat_per_volume + stored).epsilon(1e-10));
    }
  }
}

TEST_CASE("a bar held at its ends, free at its sides, has -E alpha dT", "[physics][thermal]") {
  const auto material = expanding();
  PointDriver point(*material, {});
  const double rise = 150, side = (1 + poisson) * alpha * rise;
  heat(point, rise, {0, 0, 0, 0, side, 0, 0, 0, side}, 40);
  CHECK(point.stress().xx == Approx(-young * alpha * rise).epsilon(1e-11));
  CHECK(std::abs(point.stress().yy) < 1e-11 * young * alpha * rise);
  CHECK(std::abs(point.stress().zz) < 1e-11 * young * alpha * rise);
}

TEST_CASE("the wave speed of an expanded body is that of its modulus", "[physics][thermal]") {
  const auto material = expanding();
  PointDriver point(*material, {.update = {.volume_update = 2}});
  const double e = alpha * 500;
  heat(point, 500, {e, 0, 0, 0, e, 0, 0, 0, e}, 50);
  const double modulus = bulk + 4.0 / 3 * young / (2 * (1 + poisson));
  CHECK(point.sound_speed() == Approx(std::sqrt(modulus / point.density())).epsilon(1e-12));
}

TEST_CASE("a broken body presses when its gap is closed, which heat does as well", "[physics][thermal]") {
  core::MaterialInput input = copper("IsoElastic");
  input.strength.values["SpecHeat"] = heat_capacity;
  input.strength.values["TemperatureCoefficient"] = alpha;
  input.failures.push_back({{"Pmin", {{"pmin", -500e6}}, {}}, false});
  const auto material = make(input);
  PointDriver point(*material, {.update = {.volume_update = 2}});
  for (int i = 0; i < 10; ++i) point.step({1, 0, 0, 0, 0, 0, 0, 0, 0}, 0.001);
  REQUIRE(point.value(Column::failed) == 1);
  heat(point, 100, {}, 10);
  CHECK(point.value(Column::pressure) == 0);  // 3 alpha dT = 0.0051 of the gap of 0.01
  heat(point, 200, {}, 10);
  CHECK(point.value(Column::pressure) == Approx(bulk * (3 * alpha * 300 - 0.01)).epsilon(1e-10));
}

TEST_CASE("plastic work heats and the heat presses", "[physics][thermal]") {
  const auto material = make(copper("IsoHarden expanding")), cold_material = make(copper("IsoHarden heated"));
  PointDriver point(*material, {}), cold(*cold_material, {});
  const physics::Path path{.kind = PathKind::simple_shear, .targets = {0.6}, .steps = 600};
  drive(point, path, [](double) {});
  drive(cold, path, [](double) {});
  const double rise = point.value(Column::temperature) - room;
  CHECK(rise > 10);
  CHECK(rise == cold.value(Column::temperature) - room);
  CHECK(point.value(Column::pressure) == Approx(3 * bulk * alpha * rise).epsilon(1e-12));
  CHECK(std::abs(cold.value(Column::pressure)) < 1e-9 * bulk);
}

TEST_CASE("all of the heat of every plastic law is its share of the plastic work", "[physics][thermal]") {
  // In steady shear the plastic work is the work of the stress less what is stored elastically.
  for (const Sample& s : samples()) {
    const bool plastic = s.input.strength.values.count("Yield0") > 0;
    if (!plastic || s.input.strength.values.count("SpecHeat") == 0 || !s.input.failures.empty()) continue;
    INFO(s.label);
    for (const double share : {0.9, 0.5, 0.0}) {
      core::MaterialInput input = s.input;
      input.strength.values["PlasticWorkCoefficient"] = share;
      for (const char* d : {"D1", "D2", "D3", "D4", "D5"}) input.strength.values.erase(d);
      const auto material = make(input);
      PointDriver point(*material, {});
      const int steps = 4000;
      const double gamma = 0.4;
      double work = 0, before = 0;
      drive(point, {.kind = PathKind::simple_shear, .targets = {gamma}, .steps = steps}, [&](double) {
        work += 0.5 * (before + point.stress().xy) * gamma / steps;
        before = point.stress().xy;
      });
      const double g = input.strength.values.at("Young") / (2 * (1 + input.strength.values.at("Poisson")));
      const double stored = contract(point.deviator(), point.deviator()) / (4 * g);
      const double expected = share * (work - stored) / (8960 * input.strength.values.at("SpecHeat"));
      // The elastic energy is that of a hypoelastic law, right to the strain: stress/G = 0.005.
      CHECK(point.value(Column::temperature) - room == Approx(expected).epsilon(2e-3).margin(1e-9));
      if (share > 0) CHECK(point.value(Column::temperature) > room + 5);
    }
  }
}

}  // namespace mpm::tests
