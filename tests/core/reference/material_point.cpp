// The oracle's stress update on a single point against closed forms.
#include <array>
#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "tests/support/reference_stepper.hpp"

using mpm::tests::Matrix;
using mpm::tests::ReferenceMaterial;
using mpm::tests::ReferenceParticle;
using mpm::tests::update_stress;
using mpm::tests::wave_speed;

namespace {

constexpr double grid_length = 0.76;

ReferenceMaterial copper() {
  ReferenceMaterial material = mpm::tests::taylor_bar(3.8).material;
  material.bq1 = material.bq2 = 0;
  return material;
}

ReferenceMaterial elastic() {
  ReferenceMaterial material;
  material.density = 8.93e-3;
  material.young = 117e3;
  material.poisson = 0.35;
  return material;
}

ReferenceParticle unit_particle(const ReferenceMaterial& material) {
  ReferenceParticle particle;
  particle.V = 1;
  particle.m = material.density;
  particle.c = wave_speed(material, particle);
  return particle;
}

Matrix diagonal(double x, double y, double z) { return {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}}; }

double equivalent(const Matrix& s) {
  double sum = 0;
  for (const auto& row : s)
    for (const double component : row) sum += component * component;
  return std::sqrt(1.5 * sum);
}

}  // namespace

TEST_CASE("a quarter turn exchanges the stresses of the axes", "[reference]") {
  const ReferenceMaterial material = elastic();
  // The mid-point rule turns by 2 atan(w/2) per step.
  const int steps = 9;
  const double w = 2 * std::tan(std::numbers::pi / 4 / steps);
  ReferenceParticle particle = unit_particle(material);
  particle.s = {{{60, 0, 20}, {0, -10, 0}, {20, 0, -50}}};
  particle.p = 7;
  for (int n = 0; n < steps; ++n)
    update_stress(material, grid_length, 1, {{{0, -w, 0}, {w, 0, 0}, {0, 0, 0}}}, particle);
  const Matrix expected = {{{-10, 0, 0}, {0, 60, 20}, {0, 20, -50}}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      // round-off of nine products with numbers up to 60
      CHECK(particle.s[i][j] == Approx(expected[i][j]).margin(1e-12));
  CHECK(particle.p == 7);
  CHECK(particle.V == 1);
  CHECK(particle.E == 0);
}

TEST_CASE("the mid-point rotation satisfies its definition about any axis", "[reference]") {
  // (I - W/2) R = I + W/2, seen through s' = R s R^T: (I - W/2) s' (I - W/2)^T = (I + W/2) s (I + W/2)^T.
  const ReferenceMaterial material = elastic();
  const double a = 0.3, b = -0.7, c = 1.1;
  const Matrix W = {{{0, -c, b}, {c, 0, -a}, {-b, a, 0}}};
  const Matrix s = {{{3, 1, -2}, {1, -5, 4}, {-2, 4, 2}}};
  ReferenceParticle particle = unit_particle(material);
  particle.s = s;
  update_stress(
      material, grid_length, 0.5,
      [&] {
        Matrix L = W;
        for (auto& row : L)
          for (double& component : row) component /= 0.5;
        return L;
      }(),
      particle);
  const auto congruent = [&](double sign, const Matrix& t) {
    Matrix result{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t k = 0; k < 3; ++k)
          for (std::size_t l = 0; l < 3; ++l)
            result[i][j] += ((i == k) + sign * 0.5 * W[i][k]) * t[k][l] * ((j == l) + sign * 0.5 * W[j][l]);
    return result;
  };
  const Matrix left = congruent(-1, particle.s), right = congruent(1, s);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) CHECK(left[i][j] == Approx(right[i][j]).margin(1e-13));
}

TEST_CASE("uniaxial strain of an elastic point", "[reference]") {
  const ReferenceMaterial material = elastic();
  const double strain = 1e-6;
  ReferenceParticle particle = unit_particle(material);
  for (int n = 0; n < 10; ++n) update_stress(material, grid_length, 0.1, diagonal(strain, 0, 0), particle);
  const double modulus = material.bulk() + 4 * material.shear() / 3;
  CHECK(particle.s[0][0] - particle.p == Approx(modulus * strain).epsilon(1e-12));
  // Small strain: V varies by 1e-6.
  CHECK(particle.E == Approx(0.5 * modulus * strain * strain).epsilon(2e-6));
  CHECK(particle.V == Approx(1 + strain).epsilon(1e-11));
  CHECK(wave_speed(material, particle) == Approx(std::sqrt(modulus / material.density)).epsilon(1e-6));
}

TEST_CASE("radial return keeps a shear path on the hardening curve", "[reference]") {
  const ReferenceMaterial material = copper();
  const double shear_strain = 0.02;  // tensor component
  for (const int steps : {1, 100}) {
    ReferenceParticle particle = unit_particle(material);
    const double rate = shear_strain / steps;
    for (int n = 0; n < steps; ++n)
      update_stress(material, grid_length, 1, {{{0, rate, 0}, {rate, 0, 0}, {0, 0, 0}}}, particle);
    // A proportional path is integrated exactly: 2-112 with the trial stress of the whole strain.
    const double trial = 2 * material.shear() * std::sqrt(3.0) * shear_strain;
    const double epef = (trial - material.yield) / (3 * material.shear() + material.plastic_modulus);
    CHECK(particle.epef == Approx(epef).epsilon(1e-11));
    CHECK(equivalent(particle.s) ==
          Approx(material.yield + material.plastic_modulus * particle.epef).epsilon(1e-11));
  }
  CHECK(mpm::tests::plastic_modulus(200, 100) == Approx(200));
}

TEST_CASE("one strong compression lands on the Hugoniot", "[reference]") {
  // From rest, 2-89 without viscosity and shear is the Rankine-Hugoniot energy jump 2-65, so the pressure
  // must be that of the Hugoniot, 2-68.
  const ReferenceMaterial material = copper();
  for (const double eta : {0.01, 0.1, 0.3}) {
    ReferenceParticle particle = unit_particle(material);
    update_stress(material, grid_length, 1, diagonal(-eta / 3, -eta / 3, -eta / 3), particle);
    const double denominator = 1 - material.s * eta;
    const double hugoniot = material.density * material.c0 * material.c0 * eta / (denominator * denominator);
    CHECK(particle.p == Approx(hugoniot).epsilon(1e-12));
    CHECK(particle.E == Approx(0.5 * hugoniot * eta).epsilon(1e-12));
  }
}

TEST_CASE("the wave speed is the slope of the isentrope", "[reference]") {
  ReferenceMaterial material = copper();
  for (const double compression : {0.2, 0.02, -0.02}) {
    ReferenceParticle particle = unit_particle(material);
    const double third = -compression / 3;
    update_stress(material, grid_length, 1, diagonal(third, third, third), particle);
    const auto change = [&](double de) {
      ReferenceParticle moved = particle;
      update_stress(material, grid_length, 1, diagonal(de / 3, de / 3, de / 3), moved);
      return std::array{moved.p, moved.m / moved.V};
    };
    const auto [p1, rho1] = change(-1e-4);
    const auto [p2, rho2] = change(1e-4);
    const double bulk_part = (p1 - p2) / (rho1 - rho2);
    const double c = std::sqrt(bulk_part + 4 * material.shear() * particle.V / (3 * particle.m));
    // central difference over 1e-4 of volume
    CHECK(particle.c == Approx(c).epsilon(1e-6));
  }
}

TEST_CASE("viscous pressure acts in compression and heats", "[reference]") {
  ReferenceMaterial material = copper();
  material.bq1 = 1.5;
  material.bq2 = 0.06;
  const double dt = 1e-5, D = -500;
  ReferenceParticle particle = unit_particle(material);
  const double c = particle.c;
  update_stress(material, grid_length, dt, diagonal(D / 3, D / 3, D / 3), particle);
  const double rho = material.density / (1 + D * dt);
  const double q = rho * grid_length * (1.5 * grid_length * D * D - 0.06 * c * D);
  CHECK(particle.q == Approx(q).epsilon(1e-12));
  CHECK(particle.E == Approx(-0.5 * (particle.p + q) * D * dt).epsilon(1e-12));

  // The next step expands: no viscosity, but half of the old one still works, 2-86.
  const ReferenceParticle before = particle;
  update_stress(material, grid_length, dt, diagonal(-D / 3, -D / 3, -D / 3), particle);
  CHECK(particle.q == 0);
  const double dV = particle.V - before.V;
  CHECK(particle.E - before.E == Approx(-0.5 * (before.p + particle.p + before.q) * dV).epsilon(1e-9));
}
