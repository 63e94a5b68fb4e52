// The artificial bulk viscosity (manual 3.1, thesis 2-69) and what it does to the critical speed (2-72 to
// 2-74) and to the energy.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::PointDriver;

namespace {

constexpr double cell = 1e-3, bq1 = 1.5, bq2 = 0.06;

core::Mat3<double> uniaxial(double rate) { return {rate, 0, 0, 0, 0, 0, 0, 0, 0}; }

}  // namespace

TEST_CASE("q = rho l (bq1 l D^2 - bq2 c D) in compression, zero in expansion", "[physics][viscosity]") {
  // Every kind of material, also those without shear stiffness: the sound speed in q is the material's own.
  for (const char* label :
       {"IsoElastic", "IsoHarden + Gruneisen", "Null + Polynomial gas", "Null + Gruneisen"}) {
    INFO(label);
    const auto material = make(sample(label).input);
    for (const double rate : {-1e3, -1e6}) {
      PointDriver point(*material, {.cell_size = cell});
      point.step(uniaxial(rate), 1e-12 / std::abs(rate));  // the state hardly changes
      const double c = material->initial_sound_speed(), rho = point.density();
      const double q = rho * cell * (bq1 * cell * rate * rate - bq2 * c * rate);
      CHECK(point.value(Column::viscous_pressure) == Approx(q).epsilon(1e-9));
      const double damping = bq2 * c - bq1 * cell * rate;
      CHECK(point.critical_speed() == Approx(damping + std::sqrt(damping * damping + c * c)).epsilon(1e-9));
      point.step(uniaxial(-rate), 1e-12 / std::abs(rate));
      CHECK(point.value(Column::viscous_pressure) == 0);
      CHECK(point.critical_speed() == Approx(c).epsilon(1e-9));
    }
  }
}

TEST_CASE("coefficients of zero switch the viscosity off", "[physics][viscosity]") {
  core::MaterialInput input = copper("IsoElastic");
  input.strength.values["bq1"] = 0;
  input.strength.values["bq2"] = 0;
  const auto material = make(input);
  PointDriver point(*material, {.cell_size = cell});
  point.step(uniaxial(-1e5), 1e-8);
  CHECK(point.value(Column::viscous_pressure) == 0);
  CHECK(point.critical_speed() == Approx(point.sound_speed()).epsilon(1e-15));
}

TEST_CASE("the viscosity heats: its work is -q dV, once", "[physics][viscosity]") {
  const auto material = make(copper("IsoElastic"));
  PointDriver with(*material, {.cell_size = cell}), without(*material, {});
  const double rate = -1e5, dt = 1e-9;
  double work = 0, q_before = 0;
  for (int i = 0; i < 100; ++i) {
    const double v = with.volume_ratio();
    with.step(uniaxial(rate), dt);
    without.step(uniaxial(rate), dt);
    const double q = with.value(Column::viscous_pressure);
    work -= 0.5 * (q + q_before) * (with.volume_ratio() - v);
    q_before = q;
  }
  CHECK(work > 0);
  CHECK(with.energy() - without.energy() == Approx(work).epsilon(1e-9));
}

TEST_CASE("NotConsiderVisForCp leaves the viscosity out of the critical speed only", "[physics][viscosity]") {
  const auto material = make(copper("IsoElastic"));
  PointDriver point(*material, {.cell_size = cell, .update = {.viscosity_in_wave_speed = false}});
  point.step(uniaxial(-1e5), 1e-9);
  CHECK(point.value(Column::viscous_pressure) > 0);
  CHECK(point.critical_speed() == Approx(point.sound_speed()).epsilon(1e-15));
}

TEST_CASE("VarSoundspeed keeps the critical speed", "[physics][viscosity]") {
  core::MaterialInput input = copper("IsoHarden", true);
  input.strength.values["VarSoundspeed"] = 1;
  const auto material = make(input);
  PointDriver point(*material, {.cell_size = cell, .update = {.viscosity_in_wave_speed = false}});
  for (int i = 0; i < 100; ++i) point.step(uniaxial(-1e5), 1e-8);
  CHECK(point.sound_speed() > 1.05 * material->initial_sound_speed());
  CHECK(point.critical_speed() == material->initial_sound_speed());
}

}  // namespace mpm::tests
