// The wave speed must not be below that of the tangent: rho c^2 against the slope of the stress for a small,
// fast uniaxial strain in many directions, found by differences, at states along a random path. Elastic
// unloading is the stiffest answer, so both signs are tried.

#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::Sym3;
using core::Vec3;
using physics::PointDriver;

namespace {

double along(const Sym3<double>& a, const Vec3<double>& n) {
  return n.x * n.x * a.xx + n.y * n.y * a.yy + n.z * n.z * a.zz +
         2 * (n.x * n.y * a.xy + n.y * n.z * a.yz + n.x * n.z * a.xz);
}

/// Stress along n after one small step of strain along n; the point is left as it was.
double stress_after(PointDriver& point, const Vec3<double>& n, double strain, double dt) {
  const PointDriver::State state = point.save();
  const double rate = strain / dt;
  point.step({rate * n.x * n.x, rate * n.x * n.y, rate * n.x * n.z, rate * n.y * n.x, rate * n.y * n.y,
              rate * n.y * n.z, rate * n.z * n.x, rate * n.z * n.y, rate * n.z * n.z},
             dt);
  const double stress = along(point.stress(), n);
  point.restore(state);
  return stress;
}

/// d(stress along n)/d(strain along n), against a step without strain: what relaxes by itself is no
/// stiffness.
double tangent(PointDriver& point, const Vec3<double>& n, double strain, double dt) {
  return (stress_after(point, n, strain, dt) - stress_after(point, n, 0, dt)) / strain;
}

}  // namespace

TEST_CASE("the wave speed of every law is not below its tangent's", "[physics][wave]") {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const Sample& s : samples()) {
    if (!s.solid) continue;
    if (s.input.strength.has("mu") || s.input.strength.has("ck"))
      continue;  // viscous stress is not a modulus
    INFO(s.label);
    const auto material = make(s.input);
    PointDriver point(*material, {});
    const double duration = 2e-5;
    const RandomPath path(13, s.strain, duration);
    const int steps = 200;
    double largest = 0, stiffest = 0;
    // Where strength follows the rate of the whole strain, a fast strain lifts it at once, which is no
    // stiffness: in tension RHT's pressure with it. A slow one leaves it at rest.
    const double dt = s.input.strength.has("delta") ? 1 : 1e-12;
    for (int i = 0; i < steps; ++i) {
      point.step(path.gradient((i + 0.5) * duration / steps), duration / steps);
      if (i % 20 != 0) continue;
      // Strength that damage takes goes on sinking for some steps.
      for (int rest = 0; rest < 30; ++rest) point.step({}, dt);
      const double modulus = point.density() * point.sound_speed() * point.sound_speed();
      // (2-57) holds for dE = -p dV. The work of the deviatoric stress heats as well; with dp/dE < 2 here
      // that adds at most twice the largest principal deviator, 2/3 of the von Mises stress.
      const double bound = modulus + (s.input.eos ? 4.0 / 3.0 * mises(point.deviator()) : 0);
      for (int k = 0; k < 6; ++k) {
        Vec3<double> n{normal(random), normal(random), normal(random)};
        n = (1 / std::sqrt(dot(n, n))) * n;
        for (const double strain : {1e-7, -1e-7}) {
          const double slope = tangent(point, n, strain, dt);
          largest = std::max(largest, slope / bound);
          // An explosive has the speed of its products before it has burnt.
          const bool burns = point.has(Column::burn_fraction) && point.value(Column::burn_fraction) < 1;
          stiffest = std::max(stiffest, burns ? 1 : slope / modulus);
        }
      }
    }
    // The difference quotient is of first order in 1e-7, with round-off 1e-16 of the modulus over 1e-7
    // besides.
    CHECK(largest < 1 + 1e-5);
    // And it is no idle bound: in some direction the material is as stiff as it says.
    CHECK(stiffest > 0.98);
  }
}

}  // namespace mpm::tests
