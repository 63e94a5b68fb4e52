// The oracle on the copper Taylor bar of thesis 3.5.1, in its coarse version, against experiment and energy.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "tests/support/reference_stepper.hpp"

using mpm::tests::bar_shape;
using mpm::tests::BarShape;
using mpm::tests::ReferenceCase;
using mpm::tests::ReferenceScheme;
using mpm::tests::ReferenceStepper;
using mpm::tests::taylor_bar;

namespace {

constexpr double dp = 0.76;

ReferenceCase bar(ReferenceScheme scheme, double dt_factor = 0.5) {
  ReferenceCase setup = taylor_bar(dp);
  setup.scheme = scheme;
  setup.dt_factor = dt_factor;
  return setup;
}

/// Largest departure of the total energy from its start up to `end`, over the start.
double energy_drift(ReferenceStepper& stepper, double end) {
  const double start = stepper.energy().total();
  double largest = 0;
  while (stepper.time() < end) {
    stepper.step();
    largest = std::max(largest, std::abs(stepper.energy().total() / start - 1));
  }
  return largest;
}

}  // namespace

TEST_CASE("the bar is the one of the thesis", "[reference]") {
  const ReferenceCase setup = taylor_bar(0.38);
  CHECK(setup.particles.size() == 316u * 67u);
  const BarShape shape = bar_shape(setup, setup.particles);
  CHECK(shape.length == Approx(25.4).epsilon(1e-12));
  CHECK(shape.foot_diameter == Approx(7.6).epsilon(1e-12));
  CHECK(shape.diameter == Approx(7.6).epsilon(0.005));  // 316 squares for a circle
  ReferenceStepper stepper(setup);
  // c^2 = 4G/(3 rho) + c0^2
  const double c = std::sqrt(4 * 117e3 / 2.7 / 3 / 8.93e-3 + 3940.0 * 3940.0);
  CHECK(stepper.dt() == Approx(0.5 * 0.76 / (c + 190)).epsilon(1e-12));
}

TEST_CASE("the bar's energy stays, the better the shorter the step", "[reference]") {
  for (const auto scheme : {ReferenceScheme::musl, ReferenceScheme::usf}) {
    CAPTURE(static_cast<int>(scheme));
    ReferenceStepper coarse(bar(scheme, 0.5)), fine(bar(scheme, 0.125));
    const double coarse_drift = energy_drift(coarse, 0.02), fine_drift = energy_drift(fine, 0.02);
    CAPTURE(coarse_drift, fine_drift);
    CHECK(coarse_drift < 0.02);
    CHECK(fine_drift < coarse_drift);
  }
}

TEST_CASE("the bar comes to rest in the shape of the experiment", "[reference]") {
  for (const auto scheme : {ReferenceScheme::musl, ReferenceScheme::usf, ReferenceScheme::usl}) {
    CAPTURE(static_cast<int>(scheme));
    const ReferenceCase setup = bar(scheme);
    ReferenceStepper stepper(setup);
    const double start = stepper.energy().total();
    while (stepper.time() < 0.08) stepper.step();
    const auto energy = stepper.energy();
    CAPTURE(energy.total() / start, energy.kinetic / start);
    CHECK(energy.kinetic < 0.03 * start);
    // USL dissipates, MUSL does not (thesis 2.2.1), and USF does where particles cross the faces of cells
    // slowly (core/shape/face_traps.hpp): 0.8 % in this coarse bar.
    const double lost = scheme == ReferenceScheme::usl ? 0.08 : scheme == ReferenceScheme::usf ? 0.01 : 0.005;
    CHECK(std::abs(energy.total() / start - 1) < lost);
    // 16.2, 13.5 and 10.1 mm in the experiment (thesis table 5.1). Five particles across the radius
    // are 3.5, 6.5 and 2.5 % off; at half the spacing it is 1.2, 2.3 and 1.2 %.
    const BarShape shape = bar_shape(setup, stepper.particles());
    CHECK(shape.length == Approx(16.2).epsilon(0.05));
    CHECK(shape.foot_diameter == Approx(13.5).epsilon(0.08));
    CHECK(shape.diameter == Approx(10.1).epsilon(0.04));
  }
}

TEST_CASE("USL without its remedy diverges on the bar", "[reference]") {
  ReferenceCase setup = bar(ReferenceScheme::usl);
  setup.usl_mass_floor = 0;
  ReferenceStepper stepper(setup);
  const double start = stepper.energy().total();
  const auto grows = [&] {
    try {
      while (stepper.time() < 0.02)
        if (stepper.step(); stepper.energy().total() > 2 * start) return true;
    } catch (const std::runtime_error&) { return true; }
    return false;
  };
  CHECK(grows());
}

TEST_CASE("the naive baseline measures something", "[reference]") {
  CHECK(mpm::tests::run_reference(1000, 2) > 0);
}
