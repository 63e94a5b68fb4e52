// Failure: criteria (manual 3.2.3), what is left of the stress (FailedType, TensileCutoff, FailViscosity
// in 3.2.1), and erosion.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::PathKind;
using physics::PointDriver;

namespace {

core::FailureInput plastic_strain(double epmax, bool erosion = false) {
  return {{"PlaStrain", {{"epmax", epmax}}, {}}, erosion};
}
core::FailureInput pmin(double value, bool erosion = false) {
  return {{"Pmin", {{"pmin", value}}, {}}, erosion};
}

core::MaterialInput brittle(const core::FailureInput& failure, const core::ParameterValues& values = {},
                            bool gruneisen = true) {
  core::MaterialInput input = copper("IsoHarden", gruneisen);
  input.failures.push_back(failure);
  for (const auto& [name, value] : values) input.strength.values[name] = value;
  return input;
}

/// Stretches equally in all directions to the logarithmic volume strain.
void stretch(PointDriver& point, double strain, int steps = 100) {
  drive(point, {.kind = PathKind::hydrostatic, .rate = 1e3, .targets = {strain}, .steps = steps},
        [](double) {});
}

}  // namespace

TEST_CASE("PlaStrain fails at epmax and takes the deviatoric stress away", "[physics][failure]") {
  const auto material = make(brittle(plastic_strain(0.01)));
  PointDriver point(*material, {});
  const double gamma = 0.04;
  drive(point, {.kind = PathKind::simple_shear, .targets = {gamma}, .steps = 1000}, [&](double) {
    const double epef = point.value(Column::effective_plastic_strain);
    if (point.value(Column::failed) == 0) {
      CHECK(epef <= 0.01);
    } else {
      CHECK(epef > 0.01);
      CHECK(epef < 0.01 + 2 * gamma / 1000);  // the state of a failed particle rests
      CHECK(mises(point.deviator()) == 0);
    }
  });
  CHECK(point.value(Column::failed) == 1);
  CHECK(point.events().failed == 1);
}

TEST_CASE("Pmin fails in tension beyond its limit only", "[physics][failure]") {
  const auto material = make(brittle(pmin(-500e6)));
  PointDriver point(*material, {});
  drive(point, {.kind = PathKind::hydrostatic, .rate = 1e3, .targets = {-0.01, 0.02}, .steps = 500},
        [&](double) {
          const double p = point.value(Column::pressure);
          CHECK(p >= -500e6);
          if (p < 0) CHECK(point.value(Column::failed) == 0);
        });
  CHECK(point.value(Column::failed) == 1);
  CHECK(point.value(Column::pressure) == 0);
}

TEST_CASE("FailedType decides on the pressure of failed particles", "[physics][failure]") {
  struct Expectation {
    int type;
    double cutoff;
    double slight_tension, strong_tension;  // the pressure then, over the intact one's
    double compression;
  };
  for (const auto& [type, cutoff, slight, strong, compression] :
       {Expectation{0, 0, 0, 0, 1}, Expectation{1, 0, 0, 0, 0}, Expectation{2, -300e6, 1, 0, 1},
        Expectation{2, 0, 0, 0, 1}}) {
    INFO("FailedType " << type << ", TensileCutoff " << cutoff);
    const auto material = make(
        brittle(plastic_strain(0.5), {{"FailedType", static_cast<double>(type)}, {"TensileCutoff", cutoff}}));
    const auto intact_material = make(copper("IsoHarden", true));
    PointDriver point(*material, {}), intact(*intact_material, {});
    point.set(Column::failed, 1);
    for (const auto& [strain, factor] : {std::pair{0.001, slight}, {0.01, strong}, {-0.02, compression}}) {
      stretch(point, strain);
      stretch(intact, strain);
      // The energy of the two differs a little: what the intact one stored in tension the other did not.
      CHECK(point.value(Column::pressure) ==
            Approx(factor * intact.value(Column::pressure)).epsilon(1e-3).margin(1e-9));
    }
    CHECK(point.events().not_finite == 0);
  }
}

TEST_CASE("a failed particle without an equation of state presses only when its gap has closed",
          "[physics][failure]") {
  const auto material = make(brittle(pmin(-500e6), {}, false));
  PointDriver point(*material, {.update = {.volume_update = 2}});
  const double bulk = 124e9 / (3 * (1 - 2 * 0.34));
  stretch(point, 0.1);
  REQUIRE(point.value(Column::failed) == 1);
  stretch(point, -0.09);
  CHECK(point.value(Column::pressure) == 0);
  stretch(point, -0.02);
  CHECK(point.value(Column::pressure) == Approx(bulk * 0.01).epsilon(1e-9));
}

TEST_CASE("the fragments of a failed particle part instead of stretching", "[physics][failure]") {
  const auto material = make(brittle(pmin(-500e6), {{"FailViscosity", 30.0}}));
  PointDriver point(*material, {.update = {.volume_update = 2}});
  stretch(point, 0.05);
  REQUIRE(point.value(Column::failed) == 1);
  const double fragments = point.value(Column::volume), energy = point.energy();
  const double whole = fragments + point.value(Column::void_volume);
  for (int i = 0; i < 40; ++i) stretch(point, 0.1);
  CHECK(point.value(Column::volume) == fragments);
  CHECK(point.value(Column::void_volume) == Approx(whole * std::exp(4.0) - fragments).epsilon(1e-11));
  CHECK(point.value(Column::pressure) == 0);
  CHECK(point.energy() == energy);

  SECTION("and the void closes before they bear load") {
    for (int i = 0; i < 40; ++i) stretch(point, -0.1);
    CHECK(point.value(Column::volume) == Approx(fragments).epsilon(1e-12));
    CHECK(point.energy() == Approx(energy).epsilon(1e-9));
    stretch(point, -0.08);
    CHECK(point.value(Column::void_volume) == 0);
    PointDriver never_parted(*material, {.update = {.volume_update = 2}});
    stretch(never_parted, 0.05);
    stretch(never_parted, -0.08);
    CHECK(point.value(Column::pressure) == Approx(never_parted.value(Column::pressure)).epsilon(1e-9));
  }
  SECTION("and heat that comes in between is not multiplied by the compression") {
    point.step({0, 1e6, 0, 0, 0, 0, 0, 0, 0}, 1e-6);
    const double heated = point.energy();
    CHECK(heated > energy);
    for (int i = 0; i < 40; ++i) stretch(point, -0.1);
    CHECK(point.energy() == Approx(heated).epsilon(1e-9));
  }
}

TEST_CASE("a failed particle has no artificial viscosity", "[physics][failure]") {
  const auto material = make(brittle(plastic_strain(0.5)));
  PointDriver point(*material, {.cell_size = 1e-3});
  point.set(Column::failed, 1);
  point.step({-1e5, 0, 0, 0, 0, 0, 0, 0, 0}, 1e-8);
  CHECK(point.value(Column::viscous_pressure) == 0);
  CHECK(point.critical_speed() == Approx(point.sound_speed()).epsilon(1e-15));
}

TEST_CASE("FailViscosity gives failed particles tau = mu times the shear rate", "[physics][failure]") {
  const auto material = make(brittle(plastic_strain(0.5), {{"FailViscosity", 30.0}}));
  PointDriver point(*material, {.cell_size = 1e-3});
  point.set(Column::failed, 1);
  point.step({0, 1e3, 0, 0, 0, 0, 0, 0, 0}, 1e-9);
  CHECK(point.stress().xy == Approx(30.0 * 1e3).epsilon(1e-9));
  CHECK(point.critical_speed() > point.sound_speed());
  PointDriver intact(*material, {.cell_size = 1e-3});
  intact.step({0, 1e3, 0, 0, 0, 0, 0, 0, 0}, 1e-9);
  CHECK(intact.critical_speed() == Approx(intact.sound_speed()).epsilon(1e-15));
}

TEST_CASE("erosion marks the particle, whichever of several criteria has it", "[physics][failure]") {
  const auto mark = [](bool first_erodes, bool second_erodes) {
    core::MaterialInput input = brittle(plastic_strain(0.01, first_erodes));
    input.failures.push_back(plastic_strain(0.015, second_erodes));
    const auto material = make(input);
    PointDriver point(*material, {});
    drive(point, {.kind = PathKind::simple_shear, .targets = {0.1}, .steps = 1}, [](double) {});
    CHECK(point.events().failed == 1);
    return point.value(Column::failed);
  };
  CHECK(mark(false, false) == 1);
  CHECK(mark(true, false) == 2);
  CHECK(mark(false, true) == 2);
}

TEST_CASE("the energy of a failing particle stays in it", "[physics][failure]") {
  const auto material = make(brittle(plastic_strain(0.01)));
  PointDriver point(*material, {});
  double before = 0;
  bool failed = false;
  drive(point, {.kind = PathKind::simple_shear, .targets = {0.04}, .steps = 1000}, [&](double) {
    // Once without stress, no work is done and the energy no longer changes.
    if (failed) CHECK(point.energy() == Approx(before).epsilon(1e-6));
    failed = point.value(Column::failed) > 0;
    CHECK(point.energy() >= before * (1 - 1e-12));
    before = point.energy();
  });
}

}  // namespace mpm::tests
