// The stress turns with the material. That ten turns superposed on a path change nothing else stands in
// laws_test.cpp, for every law.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

namespace {

using core::Sym3;
using physics::PointDriver;

constexpr double pi = 3.14159265358979323846;

double norm(const Sym3<double>& a) { return std::sqrt(contract(a, a)); }

}  // namespace

TEST_CASE("a quarter turn carries s_xx over to s_yy", "[physics][objectivity]") {
  const auto material = make(copper("IsoElastic"));
  PointDriver point(*material, {});
  point.step({1e3, 0, 0, 0, 0, 0, 0, 0, 0}, 1e-6);
  const Sym3<double> before = point.stress();
  const int steps = 1000;
  for (int i = 0; i < steps; ++i) point.step({0, -1e3, 0, 1e3, 0, 0, 0, 0, 0}, 0.5 * pi * 1e-3 / steps);
  const Sym3<double> after = point.stress();
  // The mid-point rule falls behind by angle^3/12 a step: (pi/2)^3/12/steps^2 = 3.2e-7 in angle.
  const double allowed = 1e-6 * norm(before);
  CHECK(std::abs(after.yy - before.xx) < allowed);
  CHECK(std::abs(after.xx - before.yy) < allowed);
  CHECK(std::abs(after.zz - before.zz) < allowed);
  CHECK(std::abs(after.xy) < allowed);
  // What it is of, it keeps: the invariants to round-off of a thousand rotations.
  CHECK(std::abs(norm(after) - norm(before)) < 1e-12 * norm(before));
}

}  // namespace mpm::tests
