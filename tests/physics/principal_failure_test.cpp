// Failure by principal stresses and strains and by geometric strain (manual 3.2.3.3 to 3.2.3.5) at strains
// known in closed form, the deformation gradient behind the strains, and ten criteria at once.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::Mat3;
using physics::Path;
using physics::PathKind;
using physics::PointDriver;

namespace {

constexpr double young = 124e9, poisson = 0.34;
constexpr double shear = young / (2 * (1 + poisson));
constexpr double constrained = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));

core::FailureInput stress_bounds(double largest, double smallest, double tau) {
  return {{"PriStress", {{"PriStressMax", largest}, {"PriStressMin", smallest}, {"ShearStressMax", tau}}, {}},
          false};
}
core::FailureInput strain_bounds(double largest, double smallest, double gamma) {
  return {
      {"PriStrain", {{"PriStrainMax", largest}, {"PriStrainMin", smallest}, {"ShearStrainMax", gamma}}, {}},
      false};
}
core::FailureInput geometric(double strain) {
  return {{"InstGeoStrain", {{"ErosionStrain", strain}}, {}}, true};
}

std::unique_ptr<physics::Material> elastic(std::vector<core::FailureInput> failures) {
  core::MaterialInput input = copper("IsoElastic");
  input.failures = std::move(failures);
  return make(input);
}

/// Path strain at which the particle is first seen failed; infinite where it never is.
double failing_strain(const core::FailureInput& failure, Path path) {
  const auto material = elastic({failure});
  PointDriver point(*material, {});
  double at = HUGE_VAL;
  CHECK(drive(point, path, [&](double strain) {
    if (point.value(Column::failed) > 0) at = std::min(at, std::abs(strain));
  }));
  return at;
}

/// The particle fails in the first step whose end is beyond `expected`.
void check_failing_strain(const core::FailureInput& failure, const Path& path, double expected) {
  const double step = std::abs(path.targets.front()) / path.steps;
  const double at = failing_strain(failure, path);
  CHECK(at > expected * (1 - 1e-9));
  CHECK(at < expected * (1 + 1e-9) + step);
}

}  // namespace

TEST_CASE("PriStress fails at the strain of its bound", "[physics][failure][principal]") {
  const double e = 0.001;
  const auto path = [](PathKind kind, double to) {
    return Path{.kind = kind, .targets = {to}, .steps = 2000};
  };
  SECTION("uniaxial stress: sigma = E e") {
    const auto pull = [](double to) {
      return Path{.kind = PathKind::gradient,
                  .targets = {to},
                  .steps = 2000,
                  .gradient = {1, 0, 0, 0, -poisson, 0, 0, 0, -poisson}};
    };
    check_failing_strain(stress_bounds(young * e, 0, 0), pull(0.002), e);
    check_failing_strain(stress_bounds(0, -young * e, 0), pull(-0.002), e);
    check_failing_strain(stress_bounds(0, 0, young * e / 2), pull(0.002), e);
    check_failing_strain(stress_bounds(0, 0, young * e / 2), pull(-0.002), e);
  }
  SECTION("uniaxial strain: sigma_1 = (K + 4/3 G) e, and tau = G e") {
    check_failing_strain(stress_bounds(constrained * e, 0, 0), path(PathKind::uniaxial_strain, 0.002), e);
    check_failing_strain(stress_bounds(0, -constrained * e, 0), path(PathKind::uniaxial_strain, -0.002), e);
    check_failing_strain(stress_bounds(0, 0, shear * e), path(PathKind::uniaxial_strain, 0.002), e);
  }
  SECTION("simple shear: sigma_1 = -sigma_3 = tau = 2 G sin(gamma/2)") {
    // s_xy = G sin(gamma), s_xx = -s_yy = G (1 - cos(gamma)) in the Jaumann rate (Dienes, Acta Mech. 32
    // (1979) 217).
    const double gamma = 2 * std::asin(0.05);
    const Path shearing = path(PathKind::simple_shear, 0.2);
    check_failing_strain(stress_bounds(0, 0, 0.1 * shear), shearing, gamma);
    check_failing_strain(stress_bounds(0.1 * shear, 0, 0), shearing, gamma);
    check_failing_strain(stress_bounds(0, -0.1 * shear, 0), shearing, gamma);
  }
  SECTION("pressure alone shears nothing") {
    CHECK(failing_strain(stress_bounds(1e12, 0, 1), path(PathKind::hydrostatic, 0.01)) == HUGE_VAL);
  }
  SECTION("a bound of zero is off") {
    CHECK(failing_strain(stress_bounds(0, 0, 0), path(PathKind::uniaxial_strain, 0.01)) == HUGE_VAL);
    CHECK(failing_strain(stress_bounds(0, -1, 0), path(PathKind::uniaxial_strain, 0.01)) == HUGE_VAL);
    CHECK(failing_strain(stress_bounds(1, 0, 0), path(PathKind::uniaxial_strain, -0.01)) == HUGE_VAL);
  }
}

TEST_CASE("PriStrain and InstGeoStrain fail at the strain of their bound", "[physics][failure][principal]") {
  const auto path = [](PathKind kind, double to) {
    return Path{.kind = kind, .targets = {to}, .steps = 2000};
  };
  SECTION("uniaxial strain: e_1 = ln(l/l0), gamma = e_1, e_eff = 2/3 e_1") {
    // A step of the mid-point rule stretches by exp(de + de^3/12): 1e-8 of the strain here.
    for (const double to : {0.4, -0.4}) {
      const double side = to > 0 ? 1 : 0;
      check_failing_strain(strain_bounds(0.3 * side, -0.3 * (1 - side), 0),
                           path(PathKind::uniaxial_strain, to), 0.3);
      check_failing_strain(strain_bounds(0, 0, 0.3), path(PathKind::uniaxial_strain, to), 0.3);
      check_failing_strain(geometric(0.2), path(PathKind::uniaxial_strain, to), 0.3);
    }
  }
  SECTION("simple shear: the principal strains are +-asinh(gamma/2), far beyond the first turn of the axes") {
    // V^2 has the eigenvalues exp(+-2 asinh(gamma/2)) and 1.
    const double gamma = 3, e = std::asinh(gamma / 2);
    check_failing_strain(strain_bounds(e, 0, 0), path(PathKind::simple_shear, 4), gamma);
    check_failing_strain(strain_bounds(0, -e, 0), path(PathKind::simple_shear, 4), gamma);
    check_failing_strain(strain_bounds(0, 0, 2 * e), path(PathKind::simple_shear, 4), gamma);
    check_failing_strain(geometric(2 / std::sqrt(3) * e), path(PathKind::simple_shear, 4), gamma);
  }
  SECTION("a change of volume alone: e_1 = e_V/3, no shear, no effective strain") {
    check_failing_strain(strain_bounds(0.05, 0, 0), path(PathKind::hydrostatic, 0.2), 0.15);
    CHECK(failing_strain(strain_bounds(0, 0, 1e-9), path(PathKind::hydrostatic, 0.2)) == HUGE_VAL);
    CHECK(failing_strain(geometric(1e-9), path(PathKind::hydrostatic, 0.2)) == HUGE_VAL);
  }
  SECTION("a bound of zero is off") {
    CHECK(failing_strain(strain_bounds(0, 0, 0), path(PathKind::simple_shear, 1)) == HUGE_VAL);
    CHECK(failing_strain(geometric(0), path(PathKind::simple_shear, 1)) == HUGE_VAL);
  }
}

TEST_CASE("strains of the deformation gradient follow a prescribed F(t)", "[physics][failure][principal]") {
  // F = R(w t) diag(exp(a t), exp(-a t/2), exp(-a t/2)): stretch and many turns at once.
  const double a = 0.5, w = 40, end = 1;
  const auto deformation = [&](int steps) {
    const auto material = elastic({geometric(10)});
    PointDriver point(*material, {});
    const double dt = end / steps;
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) * dt, c = std::cos(w * t), s = std::sin(w * t);
      // L = spin + R diag(a, -a/2, -a/2) R^T
      const double xx = a * (c * c - 0.5 * s * s), yy = a * (s * s - 0.5 * c * c), xy = 1.5 * a * c * s;
      point.step({xx, xy - w, 0, xy + w, yy, 0, 0, 0, -0.5 * a}, dt);
    }
    return Mat3<double>{point.value(Column::f_xx), point.value(Column::f_xy), point.value(Column::f_xz),
                        point.value(Column::f_yx), point.value(Column::f_yy), point.value(Column::f_yz),
                        point.value(Column::f_zx), point.value(Column::f_zy), point.value(Column::f_zz)};
  };
  const double l = std::exp(a * end), m = std::exp(-0.5 * a * end), c = std::cos(w * end),
               s = std::sin(w * end);
  const auto error = [&](int steps) {
    const Mat3<double> f = deformation(steps);
    return std::max({std::abs(f.xx - c * l), std::abs(f.yx - s * l), std::abs(f.xy + s * m),
                     std::abs(f.yy - c * m), std::abs(f.zz - m), std::abs(f.xz), std::abs(f.zy)});
  };
  const double coarse = error(2000), fine = error(8000);
  INFO("error " << coarse << " -> " << fine);
  CHECK(fine < 2e-4);  // the angle falls behind by w t (w dt)^2/12 = 8e-5
  CHECK(std::log2(coarse / fine) / 2 == Approx(2).margin(0.05));
}

TEST_CASE("turning makes no strain, and strain that is undone is gone", "[physics][failure][principal]") {
  const auto material = elastic({geometric(1e-9)});
  PointDriver point(*material, {});
  for (int i = 0; i < 20000; ++i) point.step({0, -300, 20, 300, 0, -50, -20, 50, 0}, 1e-4);
  CHECK(point.value(Column::failed) == 0);  // of 100 turns

  const auto stretched = elastic({geometric(0.3)});
  PointDriver other(*stretched, {});
  // Stretched by 0.2 four times, turned by a right angle and pushed back each time: a sum of increments in
  // fixed axes would end at 0.8.
  const double quarter = std::acos(-1.0) / 2;
  for (int k = 0; k < 4; ++k) {
    for (int i = 0; i < 200; ++i) other.step({1, 0, 0, 0, 0, 0, 0, 0, 0}, 1e-3);
    for (int i = 0; i < 2000; ++i) other.step({0, -1, 0, 1, 0, 0, 0, 0, 0}, quarter / 2000);
    for (int i = 0; i < 200; ++i) other.step({0, 0, 0, 0, -1, 0, 0, 0, 0}, 1e-3);
    for (int i = 0; i < 2000; ++i) other.step({0, 1, 0, -1, 0, 0, 0, 0, 0}, quarter / 2000);
  }
  CHECK(other.value(Column::failed) == 0);
  // The quarter turns fall short by 1e-7 of an angle.
  CHECK(other.value(Column::f_xx) == Approx(1).epsilon(1e-6));
  CHECK(other.value(Column::f_yy) == Approx(1).epsilon(1e-6));
}

TEST_CASE("det F is the volume ratio, and a step inside out changes neither",
          "[physics][failure][principal]") {
  const auto material = elastic({geometric(10)});
  PointDriver point(*material, {.update = {.volume_update = 2}});
  const auto ratio = [&] {
    return determinant(
        Mat3<double>{point.value(Column::f_xx), point.value(Column::f_xy), point.value(Column::f_xz),
                     point.value(Column::f_yx), point.value(Column::f_yy), point.value(Column::f_yz),
                     point.value(Column::f_zx), point.value(Column::f_zy), point.value(Column::f_zz)});
  };
  const RandomPath path(5, 0.3, 1.0);
  const int steps = 4000;
  for (int i = 0; i < steps; ++i) point.step(path.gradient((i + 0.5) / steps), 1.0 / steps);
  CHECK(ratio() == Approx(point.volume_ratio()).epsilon(1e-5));
  const double before = ratio();
  point.step({-3000, 0, 0, 0, 0, 0, 0, 0, 0}, 1e-3);
  CHECK(ratio() == before);
  point.step({std::nan(""), 0, 0, 0, 0, 0, 0, 0, 0}, 1e-3);
  CHECK(ratio() == before);
  // A fluid's stretch without end does not end in what is no number.
  for (int i = 0; i < 1000; ++i) point.step({1e3, 0, 0, 0, -1e3, 0, 0, 0, 0}, 1e-3);
  CHECK(std::isfinite(ratio()));
}

TEST_CASE("what has failed can still be eroded for its shape", "[physics][failure][principal]") {
  const auto material = elastic({{{"Pmin", {{"pmin", -500e6}}, {}}, false}, geometric(0.5)});
  PointDriver point(*material, {});
  drive(point, {.kind = PathKind::hydrostatic, .targets = {0.01}, .steps = 100}, [](double) {});
  CHECK(point.value(Column::failed) == 1);
  const double gamma = 2 * std::sinh(0.5 * std::sqrt(3) / 2);
  drive(point, {.kind = PathKind::simple_shear, .targets = {2.0}, .steps = 1000}, [&](double strain) {
    if (strain < gamma - 1e-5) CHECK(point.value(Column::failed) == 1);
    if (strain > gamma + 1e-5) CHECK(point.value(Column::failed) == 2);
  });
  CHECK(point.events().failed == 1);
}

TEST_CASE("ten criteria stand side by side, and the first that is met decides",
          "[physics][failure][principal]") {
  const auto plastic = core::FailureInput{{"PlaStrain", {{"epmax", 10.0}}, {}}, false};
  std::vector<core::FailureInput> far{plastic,
                                      {{"Pmin", {{"pmin", -1e15}}, {}}, false},
                                      stress_bounds(1e15, -1e15, 1e15),
                                      strain_bounds(10, -10, 10),
                                      geometric(10),
                                      plastic,
                                      stress_bounds(0, 0, 1e14),
                                      strain_bounds(0, -9, 0),
                                      geometric(9),
                                      strain_bounds(9, 0, 0)};
  const Path path{.kind = PathKind::uniaxial_strain, .targets = {0.02}, .steps = 400};
  const auto outcome = [&](const std::vector<core::FailureInput>& failures) {
    core::MaterialInput input = copper("IsoHarden");
    input.failures = failures;
    const auto material = make(input);
    PointDriver point(*material, {});
    double at = HUGE_VAL;
    drive(point, path, [&](double strain) {
      if (point.value(Column::failed) > 0) at = std::min(at, strain);
    });
    return std::pair{at, point.value(Column::failed)};
  };
  CHECK(outcome(far).first == HUGE_VAL);
  const std::pair<core::FailureInput, double> near[] = {
      {{{"PlaStrain", {{"epmax", 0.004}}, {}}, false}, 1},
      {{{"Pmin", {{"pmin", -500e6}}, {}}, false}, 1},
      {stress_bounds(700e6, 0, 0), 1},
      {strain_bounds(0, 0, 0.01), 1},
      {geometric(0.005), 2},
  };
  for (std::size_t i = 0; i < std::size(near); ++i) {
    std::vector<core::FailureInput> ten = far;
    ten[i] = near[i].first;
    const auto [at, mark] = outcome(ten);
    CHECK(at < 0.02);
    CHECK(at == outcome({near[i].first}).first);
    CHECK(mark == near[i].second);
  }
}

}  // namespace mpm::tests
