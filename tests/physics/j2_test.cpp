// Von Mises plasticity in uniaxial stress and shear against the closed forms of thesis 2.4.3 and of the
// definition of TangMod (manual 3.2.1.4).

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::PathKind;
using physics::PointDriver;

namespace {
constexpr double young = 124e9, poisson = 0.34, yield = 200e6, tangent = 3e9;
constexpr double shear = young / (2 * (1 + poisson));

/// Pure shear by D_xy alone, without spin; `gamma`: engineering strain.
void shear_by(double gamma, int steps, PointDriver& point) {
  drive(point,
        {.kind = PathKind::gradient,
         .targets = {gamma},
         .steps = steps,
         .gradient = {0, 0.5, 0, 0.5, 0, 0, 0, 0, 0}},
        [](double) {});
}
}  // namespace

TEST_CASE("a bar beyond yield follows the tangent modulus, and unloads elastically", "[physics][j2]") {
  const auto material = make(copper("IsoHarden"));
  PointDriver point(*material, {});
  const double yield_strain = yield / young;
  double worst = 0, strain_before = 0, peak = 0;
  bool unloading = false;
  const bool converged = drive(
      point, {.kind = PathKind::uniaxial_stress, .targets = {0.02, 0.019}, .steps = 200}, [&](double strain) {
        if (strain < strain_before) unloading = true;
        const double expected = unloading               ? peak - young * (0.02 - strain)
                                : strain < yield_strain ? young * strain
                                                        : yield + tangent * (strain - yield_strain);
        if (!unloading) peak = expected;
        worst = std::max(worst, std::abs(point.stress().xx - expected));
        strain_before = strain;
      });
  CHECK(converged);
  // The step that crosses yield mixes elastic and plastic lateral strain: first order in its length.
  CHECK(worst < 2e-4 * peak);
  const double hardening = young * tangent / (young - tangent);
  CHECK(point.value(Column::effective_plastic_strain) == Approx((peak - yield) / hardening).epsilon(2e-3));
}

TEST_CASE("simple shear of a hardening material in one step and in many", "[physics][j2]") {
  // Without spin the direction is fixed and the return is exact: pure shear by D_xy alone.
  const auto material = make(copper("IsoHarden"));
  const double hardening = young * tangent / (young - tangent);
  const double gamma = 0.05;  // engineering
  for (const int steps : {1, 7, 100}) {
    PointDriver point(*material, {});
    shear_by(gamma, steps, point);
    const double plastic = (std::sqrt(3.0) * shear * gamma - yield) / (3 * shear + hardening);
    CHECK(point.value(Column::effective_plastic_strain) == Approx(plastic).epsilon(1e-12));
    CHECK(point.stress().xy == Approx((yield + hardening * plastic) / std::sqrt(3.0)).epsilon(1e-12));
  }
}

TEST_CASE("hardening that saturates, in simple shear in one step and in many, and in a bar",
          "[physics][j2]") {
  constexpr double saturation = 120e6, rate = 60, linear = 1e9;
  const auto yields = [](double plastic) {
    return yield + linear * plastic + saturation * (1 - std::exp(-rate * plastic));
  };
  core::MaterialInput input = copper("IsoHarden");
  input.strength.type = "Voce";
  input.strength.values.erase("TangMod");
  for (const auto& [name, value] : core::ParameterValues{{"Q", saturation}, {"b", rate}, {"H", linear}})
    input.strength.values[name] = value;
  const auto material = make(input);
  const double gamma = 0.05;  // engineering
  for (const int steps : {1, 7, 100}) {
    PointDriver point(*material, {});
    shear_by(gamma, steps, point);
    // Consistency: the elastic rest of the strain carries the yield stress.
    const double plastic = point.value(Column::effective_plastic_strain);
    CHECK(plastic > 0.02);
    CHECK(std::sqrt(3.0) * shear * gamma - 3 * shear * plastic == Approx(yields(plastic)).epsilon(1e-11));
    CHECK(std::sqrt(3.0) * point.stress().xy == Approx(yields(plastic)).epsilon(1e-11));
  }
  PointDriver bar(*material, {});
  REQUIRE(drive(bar, {.kind = PathKind::uniaxial_stress, .targets = {0.1}, .steps = 200}, [](double) {}));
  const double plastic = bar.value(Column::effective_plastic_strain);
  CHECK(bar.stress().xx == Approx(yields(plastic)).epsilon(1e-9));
  // The step that crosses yield mixes elastic and plastic lateral strain.
  CHECK(plastic == Approx(0.1 - bar.stress().xx / young).epsilon(1e-3));

  // Without the saturating part it is linear hardening, H = E Et/(E - Et).
  core::MaterialInput straight = input;
  straight.strength.values["Q"] = 0;
  straight.strength.values["H"] = young * tangent / (young - tangent);
  const auto a = make(straight), b = make(copper("IsoHarden"));
  PointDriver first(*a, {}), second(*b, {});
  for (PointDriver* point : {&first, &second})
    REQUIRE(drive(*point, {.kind = PathKind::uniaxial_stress, .targets = {0.02, -0.02}, .steps = 200},
                  [](double) {}));
  CHECK(first.stress().xx == Approx(second.stress().xx).epsilon(1e-9));
}

TEST_CASE("a perfectly plastic bar stays at its yield stress", "[physics][j2]") {
  const auto material = make(copper("ElaPlastic"));
  PointDriver point(*material, {.extra_columns = {Column::yield_stress}});
  REQUIRE(drive(point, {.kind = PathKind::uniaxial_stress, .targets = {-0.01, 0.01}, .steps = 200},
                [](double) {}));
  CHECK(point.stress().xx == Approx(yield).epsilon(1e-8));
  CHECK(point.value(Column::yield_stress) == yield);
}

TEST_CASE("uniaxial strain beyond yield follows the bulk modulus", "[physics][j2]") {
  const auto material = make(copper("ElaPlastic"));
  PointDriver point(*material, {});
  const double bulk = young / (3 * (1 - 2 * poisson)), strain = -0.01;
  drive(point, {.kind = PathKind::uniaxial_strain, .targets = {strain}, .steps = 100}, [](double) {});
  CHECK(point.stress().xx == Approx(bulk * strain - 2 * yield / 3).epsilon(1e-12));
}

TEST_CASE("plastic work heats where the specific heat is given", "[physics][j2]") {
  const auto material = make(copper("IsoHarden heated"));
  PointDriver point(*material, {});
  const double gamma = 0.1;
  drive(point,
        {.kind = PathKind::gradient,
         .targets = {gamma},
         .steps = 500,
         .gradient = {0, 0.5, 0, 0.5, 0, 0, 0, 0, 0}},
        [](double) {});
  // Mean yield stress times plastic strain, exact for linear hardening; the volume does not change.
  const double hardening = young * tangent / (young - tangent);
  const double plastic = point.value(Column::effective_plastic_strain);
  const double work = (yield + 0.5 * hardening * plastic) * plastic;
  CHECK(point.value(Column::temperature) == Approx(293 + 0.9 * work / (8960 * 383.0)).epsilon(1e-10));
}

}  // namespace mpm::tests
