// Expressions of loads particle by particle, against the same formulas in C++. What they do to bodies:
// tests/system/physics_expressions.py.
#include "core/step/load_functions.hpp"

#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "core/step/loads.hpp"
#include "tests/core/step/case.hpp"

using namespace mpm::core;
using namespace mpm::tests;

namespace {

Expression expression(int component, std::string text, std::string element, std::string attribute) {
  return {component, std::move(text), std::move(element), std::move(attribute), {"case.xmp", 7}};
}

/// The tumbling block without its motion, its body with these loads.
struct LoadedRun : SmallRun {
  static ReferenceCase still(std::size_t particles) {
    ReferenceCase c = tumbling_block();
    c.particles.resize(particles);
    for (ReferenceParticle& p : c.particles) p.v = {};
    c.dt_factor = 0.1;
    return c;
  }
  explicit LoadedRun(BodyInput input, std::size_t particles = 1) : SmallRun(still(particles)) {
    ComponentInput& component = scene->components.emplace_back();
    component.bodies.push_back(std::move(input));
    model.bodies[0].prescribed_velocity = component.bodies[0].prescribed_velocity;
  }
  const BodyInput& input() const { return scene->components[0].bodies[0]; }
};

}  // namespace

TEST_CASE("A body force accelerates a particle by its value there at the middle of the step") {
  BodyInput body;
  body.body_force = {
      {0, 3, 0}, {expression(0, "x*y + t", "BodyForce", "bx"), expression(2, "2 - 9*t", "BodyForce", "bz")}};
  LoadedRun run(body);
  const Vector x = run.particles().at(0).x;
  run.step();
  const ReferenceParticle p = run.particles().at(0);
  const double dt = run.model.clock.dt;
  CHECK(p.v[0] == Approx(dt * (x[0] * x[1] + 0.5 * dt)).epsilon(1e-13));
  CHECK(p.v[1] == Approx(dt * 3).epsilon(1e-13));
  CHECK(p.v[2] == Approx(dt * (2 - 4.5 * dt)).epsilon(1e-13));
  // The work is the kinetic energy, to the rounding of places: that of uniform forces follows from
  // displacements.
  CHECK(run.model.ledger.external_work.value() ==
        Approx(0.5 * p.m * (p.v[0] * p.v[0] + p.v[1] * p.v[1] + p.v[2] * p.v[2])).epsilon(1e-9));
}

TEST_CASE("A prescribed velocity is that of the particle's place at the end of the step") {
  BodyInput body;
  body.prescribed_velocity = Vec3<double>{0, 0.5, 0};
  body.prescribed_velocity_expressions = {expression(0, "x*t", "PrescribedVelocity", "vx"),
                                          expression(2, "sin(t)", "PrescribedVelocity", "vz")};
  LoadedRun run(body, 20);
  const auto before = run.particles();
  run.step();
  const double t = run.model.clock.time;
  for (const auto& [identity, p] : run.particles()) {
    CHECK(p.v[0] == before.at(identity).x[0] * t);
    CHECK(p.v[1] == 0.5);
    CHECK(p.v[2] == std::sin(t));
    CHECK(p.x[0] == before.at(identity).x[0] + run.model.clock.dt * p.v[0]);
  }
}

TEST_CASE("The stress of a surface load has the divergence that its expressions imply") {
  BodyInput body;
  SurfaceLoad& load = body.surface_loads.emplace_back();
  load.pressure = 0;
  load.traction = {0, 4, 0};
  load.normal = 1;
  load.points = {{0, 2}, {100, 2}};
  load.expressions = {expression(0, "x*y^2", "Traction", "tx"), expression(2, "x + t", "Traction", "tz"),
                      expression(SurfaceLoad::pressure_component, "sin(x) + z^2*t", "Traction", "pressure")};
  LoadedRun run(body);
  Loads loads(run.model);
  loads.begin_step(0.5, 0.25);
  const double t = 0.625;
  const ConstParticleBlock block = *blocks_of(std::as_const(run.model)).begin();
  const Loads::Stress found = loads.varying_stress(loads.of(0).surfaces[0], run.model.bodies[0], block.data);
  const Vector at = run.particles().at(0).x;
  const double x = at[0], y = at[1], z = at[2], p = std::sin(x) + z * z * t;
  // T = -p I + (tx, ty, tz) in column y, twice.
  const double exact[3][3] = {{-p, 0, 0}, {x * y * y, 4 - p, x + t}, {0, 0, -p}};
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) CHECK(found.column[j][i] == Approx(2 * exact[j][i]).margin(1e-12));
  // Central differences over 2/1024 of a cell: exact for quadratics but for round-off, second order for sin.
  CHECK(found.divergence.x == Approx(2 * (2 * x * y - std::cos(x))).epsilon(1e-6));
  CHECK(found.divergence.y == Approx(0).margin(1e-12));
  CHECK(found.divergence.z == Approx(-2 * 2 * z * t).epsilon(1e-9));
}

TEST_CASE("A load that is not finite ends the step with the first of its particles") {
  BodyInput body;
  body.body_force = {{}, {expression(1, "1/(t - t)*x", "BodyForce", "by")}};
  LoadedRun of_place(body, 20);
  CHECK_THROWS_WITH(of_place.step(), Catch::Contains("step 1, time ") &&
                                         Catch::Contains("case.xmp:7: <BodyForce by=\"1/(t - t)*x\"> is ") &&
                                         Catch::Contains(" for particle 0 of body \"body\" at (") &&
                                         Catch::Contains(", t = "));
  body.body_force = {{}, {expression(1, "1/(t - t)", "BodyForce", "by")}};
  LoadedRun of_time(body, 20);
  CHECK_THROWS_WITH(of_time.step(),
                    Catch::Contains(" is infinite for every particle of body \"body\", t = "));
}

TEST_CASE("Without expressions there is no parser and nothing varies") {
  BodyInput body;
  body.body_force = {{1, 2, 3}, {}};
  LoadedRun run(body);
  Loads loads(run.model);
  loads.begin_step(0, 0.1);
  CHECK(loads.of(0).acceleration == Vec3<double>{1, 2, 3});
  CHECK(loads.of(0).force.of_place.empty());
  CHECK(loads.of(0).force.of_time.empty());
  CHECK(loads.take_fault().empty());
}
