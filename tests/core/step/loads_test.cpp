// Loads particle by particle, against hand formulas. What they do to bodies: tests/system/physics_loads.py.
#include "core/step/loads.hpp"

#include <catch2/catch.hpp>

#include "tests/core/step/case.hpp"

using namespace mpm::core;
using namespace mpm::tests;

namespace {

BodyInput accelerated() {
  BodyInput body;
  body.prescribed_acceleration.emplace();
  body.prescribed_acceleration->linear_amplitude = {2, -3, 5};
  body.prescribed_acceleration->points = {{1, {1, 0, 0}, {}}, {2, {3, 1, 0}, {}}, {4, {-1, 1, 0.5}, {}}};
  return body;
}

}  // namespace

TEST_CASE("Accelerations are linear between the points of their table and zero outside it") {
  const BodyInput body = accelerated();
  CHECK(acceleration_of(body, 0.99) == Vec3<double>{0, 0, 0});
  CHECK(acceleration_of(body, 1) == Vec3<double>{2, 0, 0});
  CHECK(acceleration_of(body, 1.5) == Vec3<double>{4, -1.5, 0});
  CHECK(acceleration_of(body, 3) == Vec3<double>{2, -3, 1.25});
  CHECK(acceleration_of(body, 4) == Vec3<double>{-2, -3, 2.5});
  CHECK(acceleration_of(body, 4.01) == Vec3<double>{0, 0, 0});
}

TEST_CASE("What accelerations add up to is their integral") {
  for (const bool harmonic : {false, true}) {
    BodyInput body = accelerated();
    if (harmonic) {
      body.prescribed_acceleration.reset();
      body.harmonic_excitation = HarmonicExcitation{{1, 2, 3}, {4, 0, 7}, {0.3, 0.5, -1}, {1.5, 3, 9}};
    }
    Vec3<double> sum{};
    constexpr int steps = 100000;
    constexpr double dt = 5.0 / steps;
    double worst = 0;
    for (int i = 0; i < steps; ++i) {
      sum = sum + dt * acceleration_of(body, (i + 0.5) * dt);
      if (i % 1000 != 999) continue;
      const Vec3<double> exact = velocity_gained(body, (i + 1) * dt);
      for (int a = 0; a < 3; ++a) worst = std::max(worst, std::abs(sum[a] - exact[a]));
    }
    CHECK(worst < 2e-4);  // jumps at the table's ends, half a step each
  }
}

TEST_CASE(
    "A non-reflecting face slows a particle by 2 c/h at it, normal and tangential each by its own speed") {
  for (const ReferenceShape shape : {ReferenceShape::linear, ReferenceShape::sgmp, ReferenceShape::ddmp,
                                     ReferenceShape::cubic_bspline, ReferenceShape::cpdi}) {
    if (!has_passes(shape)) continue;
    ReferenceCase c = tumbling_block();
    c.shape = shape;
    c.particles.resize(1);
    c.dt_factor = 0.1;
    ReferenceParticle& p = c.particles[0];
    for (const int axis : {0, 1, 2}) {
      for (const int side : {0, 1}) {
        const auto a = static_cast<std::size_t>(axis);
        c.boundary = {};
        c.boundary[2 * a + static_cast<std::size_t>(side)] = 3;
        for (const double fraction : {0.3, 0.7}) {
          const double cell = side == 0 ? 0 : c.cells[a] - 1.0;
          p.x = {c.origin[0] + 5.4 * c.cell[0], c.origin[1] + 5.4 * c.cell[1], c.origin[2] + 5.4 * c.cell[2]};
          p.x[a] = c.origin[a] + (cell + fraction) * c.cell[a];
          p.v = {0.3, -0.2, 0.1};
          p.s = {};
          SmallRun run(c);
          run.step();
          const ReferenceParticle after = run.particles().at(0);
          const double weight = side == 0 ? 1 - fraction : fraction, dt = run.model.clock.dt;
          for (std::size_t i = 0; i < 3; ++i) {
            const double speed =
                i == a ? wave_speed(c.material, p) : run.model.materials[0]->initial_shear_speed();
            const double slowed = p.v[i] * (1 - 2 * speed / c.cell[a] * dt * weight);
            CHECK(after.v[i] == Approx(slowed).epsilon(1e-12));
          }
        }
      }
    }
  }
}
