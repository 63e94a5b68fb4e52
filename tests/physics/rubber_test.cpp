// Mooney-Rivlin rubber (manual 3.2.1.12): uniaxial and equibiaxial tension against the closed forms of the
// incompressible solid and against the energy function itself, shear, stored energy, and round trips.

#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/scene/errors.hpp"
#include "physics/point/point_driver.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

namespace {

using core::Column;
using core::Mat3;
using core::Sym3;
using physics::PathKind;
using physics::PointDriver;

constexpr double a = 0.4e6, b = 0.1e6;

core::MaterialInput rubber(double poisson) {
  core::MaterialInput input;
  input.name = "rubber";
  input.reference_density = 1100;
  input.strength.type = "MooneyRivlin";
  input.strength.values = {{"Mr_A2", a}, {"Mr_B2", b}, {"Poisson", poisson}};
  return input;
}

/// (3.18) to (3.20) of the principal stretches.
double energy(const std::array<double, 3>& stretch, double nu) {
  const double x = stretch[0] * stretch[0], y = stretch[1] * stretch[1], z = stretch[2] * stretch[2];
  const double c = a / 2 + b, d = (a * (5 * nu - 2) + b * (11 * nu - 5)) / (2 * (1 - 2 * nu));
  const double i3 = x * y * z;
  return a * (x + y + z - 3) + b * (x * y + y * z + z * x - 3) + c * (1 / (i3 * i3) - 1) +
         d * (i3 - 1) * (i3 - 1);
}

/// Cauchy stress along a principal stretch, stretch/J dW/d(stretch), by differences of the energy.
double principal_stress(std::array<double, 3> stretch, std::size_t i, double nu) {
  const double j = stretch[0] * stretch[1] * stretch[2], h = 1e-5 * stretch[i], at = stretch[i];
  const auto w = [&](double s) {
    stretch[i] = at + s;
    return energy(stretch, nu);
  };
  const double slope = (8 * (w(h) - w(-h)) - (w(2 * h) - w(-2 * h))) / (12 * h);
  return at / j * slope;
}

std::array<double, 3> stretches(const PointDriver& point) {  // of paths without shear
  return {point.value(Column::f_xx), point.value(Column::f_yy), point.value(Column::f_zz)};
}

/// Largest relative difference from the incompressible uniaxial law sigma = 2 (l^2 - 1/l)(A + B/l)
/// (Mooney, J. Appl. Phys. 11 (1940) 582).
double uniaxial_error(double nu) {
  const auto material = make(rubber(nu));
  PointDriver point(*material, {});
  double worst = 0;
  REQUIRE(drive(point, {.kind = PathKind::uniaxial_stress, .targets = {std::log(2.0)}, .steps = 100},
                [&](double strain) {
                  if (strain < 0.1) return;
                  const double l = stretches(point)[0];
                  const double exact = 2 * (l * l - 1 / l) * (a + b / l);
                  worst = std::max(worst, std::abs(point.stress().xx / exact - 1));
                }));
  CHECK(stretches(point)[0] == Approx(2).epsilon(1e-5));
  return worst;
}

/// The same for equibiaxial tension, sigma = 2 (l^2 - l^-4)(A + B l^2), the thickness free.
double biaxial_error(double nu) {
  const auto material = make(rubber(nu));
  PointDriver point(*material, {});
  const int steps = 100;
  const double dt = 1e-3, rate = std::log(1.5) / steps / dt;
  double worst = 0, ratio = -2;
  for (int i = 0; i < steps; ++i) {
    const PointDriver::State before = point.save();
    const auto through = [&](double r) {
      point.restore(before);
      point.step({rate, 0, 0, 0, rate, 0, 0, 0, r * rate}, dt);
      return point.stress().zz;
    };
    double x = ratio, y = ratio + 0.01, fx = through(x), fy = through(y);
    for (int k = 0; k < 50 && std::abs(fy) > 1e-9 * a; ++k) {
      const double z = y - fy * (y - x) / (fy - fx);
      x = y, fx = fy, y = z, fy = through(y);
    }
    ratio = y;
    const double l = stretches(point)[0];
    if (l > 1.1) {
      const double exact = 2 * (l * l - std::pow(l, -4)) * (a + b * l * l);
      worst = std::max(worst, std::abs(point.stress().xx / exact - 1));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("nearly incompressible rubber approaches the closed forms of the incompressible",
          "[physics][rubber]") {
  for (double (*error)(double) : {&uniaxial_error, &biaxial_error}) {
    const double loose = error(0.499), tight = error(0.4999);
    INFO("error " << loose << " -> " << tight);
    CHECK(tight < 1e-3);
    // What differs is the compressibility, proportional to 1 - 2 nu.
    CHECK(loose / tight == Approx(10).epsilon(0.1));
  }
}

TEST_CASE("the stress is the derivative of the energy", "[physics][rubber]") {
  for (const double nu : {0.2, 0.45, 0.495}) {
    const auto material = make(rubber(nu));
    PointDriver point(*material, {});
    const double rates[3] = {0.3, -0.1, -0.15};
    for (int i = 0; i < 200; ++i) point.step({rates[0], 0, 0, 0, rates[1], 0, 0, 0, rates[2]}, 0.005);
    const auto l = stretches(point);
    const double scale = std::abs(principal_stress(l, 0, nu));
    CHECK(point.stress().xx == Approx(principal_stress(l, 0, nu)).margin(1e-7 * scale));
    CHECK(point.stress().yy == Approx(principal_stress(l, 1, nu)).margin(1e-7 * scale));
    CHECK(point.stress().zz == Approx(principal_stress(l, 2, nu)).margin(1e-7 * scale));
  }
}

TEST_CASE("simple shear has the modulus 2 (A + B) and Rivlin's normal stress", "[physics][rubber]") {
  const auto material = make(rubber(0.49));
  PointDriver point(*material, {});
  const double gamma = 1.5;
  drive(point, {.kind = PathKind::simple_shear, .targets = {gamma}, .steps = 50}, [](double) {});
  // L^2 = 0 in simple shear: F is exact for any step.
  CHECK(point.value(Column::f_xy) == Approx(gamma).epsilon(1e-12));
  CHECK(point.stress().xy == Approx(2 * (a + b) * gamma).epsilon(1e-10));
  // sigma_xx - sigma_yy = gamma sigma_xy for every isotropic elastic solid (Rivlin 1948).
  CHECK(point.stress().xx - point.stress().yy == Approx(gamma * point.stress().xy).epsilon(1e-10));
}

TEST_CASE("rubber stores its energy and gives it back", "[physics][rubber]") {
  const double nu = 0.45;
  const auto material = make(rubber(nu));
  const auto error = [&](int steps) {
    // The volume of update type 2 is exp of the strain, as F's.
    PointDriver point(*material, {.update = {.volume_update = 2}});
    const double dt = 1.0 / steps;
    for (int i = 0; i < steps; ++i) point.step({0.4, 0, 0, 0, -0.2, 0, 0, 0, 0.1}, dt);
    const double full = energy({std::exp(0.4), std::exp(-0.2), std::exp(0.1)}, nu);
    const double stretched = std::abs(point.energy() / full - 1);
    for (int i = 0; i < steps; ++i) point.step({-0.4, 0, 0, 0, 0.2, 0, 0, 0, -0.1}, dt);
    CHECK(std::sqrt(contract(point.stress(), point.stress())) < 1e-9 * a);
    return stretched + std::abs(point.energy()) / full;
  };
  const double coarse = error(100), fine = error(400);
  INFO("error " << coarse << " -> " << fine);
  CHECK(fine < 1e-5);
  CHECK(std::log2(coarse / fine) / 2 == Approx(2).margin(0.1));
}

TEST_CASE("rubber at rest has the moduli of A, B and Poisson", "[physics][rubber]") {
  for (const double nu : {0.0, 0.3, 0.49}) {
    const auto material = make(rubber(nu));
    const double shear = 2 * (a + b), bulk = 2 * shear * (1 + nu) / (3 * (1 - 2 * nu));
    CHECK(material->initial_sound_speed() == Approx(std::sqrt((bulk + 4 * shear / 3) / 1100)).epsilon(1e-12));
    PointDriver point(*material, {});
    point.step({0.5e-6, 0, 0, 0, -0.5e-6, 0, 0, 0, 0}, 1);
    CHECK(point.stress().xx == Approx(2 * shear * 0.5e-6).epsilon(1e-4));
    PointDriver squeezed(*material, {});
    squeezed.step({-1e-6 / 3, 0, 0, 0, -1e-6 / 3, 0, 0, 0, -1e-6 / 3}, 1);
    CHECK(squeezed.value(Column::pressure) == Approx(bulk * 1e-6).epsilon(1e-4));
  }
}

TEST_CASE("rubber placed at another density has that density's pressure and energy", "[physics][rubber]") {
  const double nu = 0.49, ratio = 1.02;
  const auto material = make(rubber(nu));
  PointDriver placed(*material, {.density = ratio * 1100});
  const double l = std::pow(ratio, -1.0 / 3);
  CHECK(placed.value(Column::pressure) == Approx(-principal_stress({l, l, l}, 0, nu)).epsilon(1e-6));
  CHECK(placed.energy() == Approx(energy({l, l, l}, nu)).epsilon(1e-9));
}

TEST_CASE("the wave speed of stretched rubber is that of its stiffest direction", "[physics][rubber]") {
  const auto material = make(rubber(0.45));
  PointDriver point(*material, {});
  drive(point, {.kind = PathKind::uniaxial_stress, .targets = {std::log(2.5)}, .steps = 100}, [](double) {});
  double stiffest = 0;
  for (int axis = 0; axis < 2; ++axis) {
    const PointDriver::State before = point.save();
    const double rate = 1e-6, along_x = axis == 0 ? rate : 0, along_y = axis == 1 ? rate : 0;
    const double old = axis == 0 ? point.stress().xx : point.stress().yy;
    point.step({along_x, 0, 0, 0, along_y, 0, 0, 0, 0}, 1);
    stiffest = std::max(stiffest, ((axis == 0 ? point.stress().xx : point.stress().yy) - old) / rate);
    point.restore(before);
  }
  const double modulus = point.density() * std::pow(point.sound_speed(), 2);
  CHECK(modulus == Approx(stiffest).epsilon(1e-4));
}

TEST_CASE("rubber that is turned inside out keeps its shape and stays finite", "[physics][rubber]") {
  const auto material = make(rubber(0.49));
  PointDriver point(*material, {});
  point.step({-3, 0, 0, 0, 0, 0, 0, 0, 0}, 1);
  CHECK(point.value(Column::f_xx) == 1);
  CHECK(point.events().negative_volume == 1);
  CHECK(std::isfinite(point.stress().xx));
  CHECK_THROWS_AS(
      [] {
        core::MaterialInput input = rubber(0.49);
        input.strength.values["Mr_B2"] = -a;
        return make(input);
      }(),
      core::InputErrors);
}

}  // namespace mpm::tests
