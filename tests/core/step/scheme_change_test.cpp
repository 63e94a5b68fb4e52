// The change from MUSL to USAVG where the input leaves the scheme to the program.
#include "core/step/scheme_change.hpp"

#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "core/has_shape.hpp"
#include "core/step/passes.hpp"
#include "core/step/totals.hpp"
#include "core/step/wave_limit.hpp"
#include "tests/core/step/case.hpp"

using namespace mpm;
using namespace mpm::tests;

namespace {

constexpr auto musl = core::Scheme::musl, usavg = core::Scheme::usavg;

/// The tumbling block, whose energy at the start is said to have been `share` of what it is.
struct Block : SmallRun {
  Block(double share, bool automatic, double end = 1e30) : SmallRun(tumbling_block()) {
    scene->solution.automatic_scheme = automatic;
    scene->solution.end_time = end;
    model.initial_energy = share * energy();
  }
  double energy() {
    const core::Energies e = core::compute_energies(model, solo.reductions);
    return e.kinetic + e.internal;
  }
};

std::vector<std::string> names(const core::Stepper& stepper) {
  std::vector<std::string> all;
  for (const core::Phase& phase : stepper.phases())
    if (phase.run) all.push_back(phase.name);
  return all;
}

}  // namespace

TEST_CASE("The scheme may change where the input leaves it to the program and USAVG keeps energy better") {
  core::Scene scene;
  CHECK(core::may_change_scheme(scene));
  const auto with = [&](auto change) {
    core::Scene other = scene;
    change(other);
    return core::may_change_scheme(other);
  };
  CHECK_FALSE(with([](core::Scene& s) { s.solution.automatic_scheme = false; }));
  CHECK_FALSE(with([](core::Scene& s) { s.solution.integration = core::Integration::implicit; }));
  CHECK_FALSE(with([](core::Scene& s) { s.solution.transfer = core::Transfer::apic; }));
  CHECK_FALSE(with([](core::Scene& s) { s.solution.flip_fraction = 0.95; }));
  CHECK_FALSE(with([](core::Scene& s) { s.solution.mass = core::MassMatrix::consistent; }));
  CHECK(with([](core::Scene& s) { s.contact.enable = true; }));
  CHECK_FALSE(with([](core::Scene& s) { s.grid.axes[1].upper = core::Boundary::nonreflecting; }));
  CHECK_FALSE(with([](core::Scene& s) { s.solution.volume.max = 2; }));
  // A rigid body in contact: free, or moved as the input says.
  const auto with_rigid = [](bool driven) {
    return [driven](core::Scene& s) {
      s.contact.enable = true;
      s.materials.emplace_back().strength.type = "Rigid";
      core::BodyInput& body = s.components.emplace_back().bodies.emplace_back();
      body.material = s.materials.size() - 1;
      if (driven) body.prescribed_velocity = core::Vec3<double>{1, 0, 0};
    };
  };
  CHECK(with(with_rigid(true)));
  CHECK_FALSE(with(with_rigid(false)));
  CHECK_FALSE(with([](core::Scene& s) {
    s.contact.enable = true;
    s.contact.method = core::ContactInput::Method::bardenhagen;
  }));
}

TEST_CASE("A run whose energy is off changes to USAVG at the first look, others never") {
  for (const double share : {1.0, 0.99, 1.01}) {
    Block run(share, true);
    int changed = 0;
    for (int n = 1; n <= 3 * core::balance_interval; ++n) {
      run.step();
      if (run.stepper->words_of_change().empty()) continue;
      changed = n;
    }
    CHECK(changed == (share == 1 ? 0 : core::first_look + 1));
    CHECK(run.model.clock.scheme_since == changed);
    CHECK(run.model.scheme == (share == 1 ? musl : usavg));
    CHECK(run.model.grid->arrays().has(core::NodeArray::sixth) == (share != 1));
  }
}

TEST_CASE("A named scheme stays, whatever the energy") {
  Block run(0.5, false);
  run.step(20);
  CHECK(run.model.scheme == musl);
  CHECK(run.stepper->words_of_change().empty());
}

namespace {

/// Looks at the balance of a block after `step`, with external work that makes the error what it is said to
/// be, relative to the energy of the block.
struct Looks {
  SmallRun run{tumbling_block()};
  double energy = 0;
  explicit Looks(double initial_share) {
    run.scene->solution.automatic_scheme = true;
    const core::Energies e = core::compute_energies(run.model, run.solo.reductions);
    energy = e.kinetic + e.internal;
    run.model.initial_energy = initial_share * energy;
  }
  bool change(std::int64_t step, double error) {
    run.model.clock.step = step;
    core::ExactSum& work = run.model.ledger.external_work;
    work = {};
    work.add((1 - error) * energy - run.model.initial_energy);
    return core::drift_beyond_tolerance(run.model, run.solo.reductions).has_value();
  }
};

}  // namespace

TEST_CASE("A run that begins without energy is not judged in its very first steps") {
  Looks at(0);
  CHECK_FALSE(at.change(core::first_look_of_fall - 2, 0.3));
  CHECK_FALSE(at.change(core::first_look_of_fall - 1, 0.3));
  CHECK_FALSE(at.change(core::first_look_of_fall, 0.004));
  CHECK_FALSE(at.change(80, 0.004));
  CHECK(at.change(80, 0.006));
  CHECK_FALSE(at.change(800, 0.004));
  CHECK(at.change(800, 0.006));
  CHECK(at.change(800, -0.006));
  CHECK_FALSE(at.change(801, 0.006));  // between two looks
}

TEST_CASE("In the first steps two looks have to say the same") {
  Looks at(1);
  CHECK_FALSE(at.change(core::first_look - 1, 0.1));
  CHECK_FALSE(at.change(core::first_look, 0.1));
  CHECK_FALSE(at.change(core::first_look + 1, 0.004));
  CHECK_FALSE(at.change(core::first_look + 2, 0.1));
  CHECK_FALSE(at.change(core::first_look + 3, -0.1));
  CHECK(at.change(core::first_look + 4, -0.006));
  CHECK_FALSE(at.change(100, 0.001));
  CHECK(at.change(120, 0.006));  // later one is enough
}

TEST_CASE("In a long run less may be added to the error of its beginning") {
  const std::int64_t look = core::balance_interval;
  Looks at(1);
  CHECK_FALSE(at.change(core::long_run - look, 0.001));
  CHECK_FALSE(at.change(core::long_run, 0.003));
  CHECK_FALSE(at.change(core::long_run + look, 0.0039));
  CHECK_FALSE(at.change(core::long_run + 2 * look, 0.0021));
  CHECK(at.change(core::long_run + 3 * look, 0.0041));
  CHECK(at.change(core::long_run + 3 * look, 0.0019));
}

TEST_CASE("An error counts relative to the largest energy that there has been") {
  Looks at(0);
  CHECK_FALSE(at.change(1000, 0.004));
  at.run.model.clock.looks.scale = 10 * at.energy;
  CHECK_FALSE(at.change(1000, 0.04));
  CHECK(at.change(1000, 0.06));
}

TEST_CASE("The step before the change is stable after it") {
  using enum core::ShapeFunction;
  core::Scene scene;
  const auto check = [&](core::ShapeFunction shape, bool single) {
    scene.grid.shape = shape;
    scene.has_single_particles = single;
    CHECK(core::wave_limit(scene, usavg) >= core::wave_limit(scene, musl));
    CHECK(core::tension_weight(scene, usavg) <= core::tension_weight(scene, musl));
  };
  for (int shape = 0; shape <= static_cast<int>(sgmp); ++shape)
    check(static_cast<core::ShapeFunction>(shape), false);
  check(linear, true);
  check(ddmp, true);
}

TEST_CASE(
    "After the change the phases are those of the new scheme, and the timing keeps those that are past") {
  Block run(0.99, true);
  run.step(static_cast<int>(core::first_look) + 2);
  Block named(1, false);
  named.scene->solution.scheme = named.model.scheme = usavg;
  named.model.grid->set_arrays(core::node_arrays_of(*named.scene, usavg, false));
  named.step();
  std::vector<std::string> expected = names(*named.stepper);
  expected.push_back("energy balance");
  CHECK(names(*run.stepper) == expected);
  std::vector<std::string> past;
  for (const core::Phase& phase : run.stepper->phases()) {
    if (phase.run) continue;
    past.push_back(phase.name);
    CHECK(phase.seconds > 0);
  }
  CHECK(past == std::vector<std::string>{"stress and motion"});
}

TEST_CASE("A run goes on as if USAVG had been asked for at the step of the change") {
  // One changes by itself; the other is stopped, changed and continued.
  Block by_itself(1, true), by_hand(1, false);
  const int until = 17;
  by_itself.step(until - 2);
  by_itself.model.initial_energy *= 0.99;
  by_itself.step(7);
  CHECK(by_itself.model.clock.scheme_since == until);
  by_hand.step(until);
  by_hand.stepper.reset();
  core::change_scheme(by_hand.model, usavg);
  by_hand.step(5);
  CHECK(by_itself.columns() == by_hand.columns());
  CHECK(by_itself.model.clock.critical_dt == by_hand.model.clock.critical_dt);
}

TEST_CASE("A continued run has the scheme that its file says, unless the input names another one") {
  for (const bool automatic : {true, false}) {
    Block run(1, automatic);
    run.model.clock.scheme_since = 80;
    core::continue_scheme(run.model);
    CHECK(run.model.scheme == (automatic ? usavg : musl));
    CHECK(run.model.clock.scheme_since == (automatic ? 80 : 0));
    run.model.clock.scheme_since = 0;
  }
}

TEST_CASE("A fluid's weight of tension is that of the new scheme") {
  Block run(1, true);
  run.model.options.tension_weight = core::tension_weight(*run.scene, musl);
  core::change_scheme(run.model, usavg);
  CHECK(run.model.options.tension_weight == core::tension_weight(*run.scene, usavg));
  CHECK(run.model.options.tension_weight != core::tension_weight(*run.scene, musl));
}

TEST_CASE("The change itself neither makes nor loses energy") {
  // Without viscosity, whose work both schemes count differently by half of one step.
  ReferenceCase c = tumbling_block();
  c.material.bq1 = c.material.bq2 = 0;
  SmallRun run(c);
  run.model.initial_energy = 1;
  run.step(30);
  const auto balance = [&] {
    return core::energy_balance(core::compute_energy_totals(run.model, run.solo.reductions),
                                run.model.initial_energy)
        .relative_drift;
  };
  const double before = balance();
  run.stepper.reset();
  core::change_scheme(run.model, usavg);
  CHECK(balance() == before);
  double largest = 0;
  for (int n = 0; n < 3; ++n) {
    run.step();
    largest = std::max(largest, std::abs(balance() - before));
  }
  CHECK(largest < 1e-4);
}
