// JWL against the Chapman-Jouguet states that come with its parameters (manual, table 6.5) and against its
// isentrope p = A exp(-R1 V) + B exp(-R2 V) + C V^-(1 + w) (Lee, Hornig and Kury 1968), both walked with the
// update of a material point. Units: cm, g, us, so Mbar.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::PathKind;
using physics::PointDriver;

namespace {

struct Explosive {
  std::string name;
  double density, pressure, velocity, gamma;  // at the CJ state, as measured
  double e0, a, b, r1, r2, w;

  std::unique_ptr<physics::Material> products() const {
    core::MaterialInput input;
    input.name = name;
    input.reference_density = density;
    input.strength.type = "Null";
    input.eos = core::LawInput{"JWL", {{"A", a}, {"B", b}, {"R1", r1}, {"R2", r2}, {"w", w}, {"E0", e0}}, {}};
    return make(input);
  }
};

// Manual, table 6.5, but for R1 of PBX9404: see the test that says so.
const Explosive tnt{"TNT", 1.63, 0.210, 0.6930, 2.727, 0.070, 3.712, 0.0323, 4.15, 0.95, 0.30};
const Explosive pbx9404{"PBX9404", 1.84, 0.37, 0.88, 2.851, 0.102, 8.524, 0.1802, 4.60, 1.30, 0.38};
const Explosive tetryl{"Tetryl", 1.73, 0.285, 0.7910, 2.798, 0.082, 5.868, 0.1067, 4.4, 1.20, 0.28};

/// Pressure of the products at V with the energy e, from the law: that of a body placed so.
double pressure(const Explosive& explosive, double v, double e) {
  Explosive placed = explosive;
  placed.e0 = e;
  return PointDriver(*placed.products(), {.density = explosive.density / v}).value(Column::pressure);
}

/// Detonation adiabat: p(V, E) with E = E0 + p (1 - V)/2, linear in the energy.
double adiabat(const Explosive& x, double v) {
  const double cold = pressure(x, v, 0), per_energy = (pressure(x, v, 1) - cold);
  return (cold + per_energy * x.e0) / (1 - 0.5 * per_energy * (1 - v));
}

/// Where the Rayleigh line touches the adiabat: the smallest speed of a front, by bisection of its slope.
double cj_volume(const Explosive& x) {
  const auto speed2 = [&](double v) { return adiabat(x, v) / (1 - v) / x.density; };
  double low = 0.6, high = 0.9;
  while (high - low > 1e-9) {
    const double v = 0.5 * (low + high), h = 1e-5;
    (speed2(v + h) > speed2(v - h) ? high : low) = v;
  }
  return 0.5 * (low + high);
}

/// A particle of the products in the CJ state.
struct CjState {
  explicit CjState(const Explosive& x)
      : explosive(x), volume(cj_volume(x)), p(adiabat(x, volume)), energy(x.e0 + 0.5 * p * (1 - volume)) {
    Explosive placed = x;
    placed.e0 = energy;
    material = placed.products();
    point = std::make_unique<PointDriver>(
        *material, PointDriver::Options{.density = x.density / volume, .update = {.volume_update = 2}});
  }
  Explosive explosive;
  double volume, p, energy;
  std::unique_ptr<physics::Material> material;
  std::unique_ptr<PointDriver> point;
};

}  // namespace

TEST_CASE("JWL gives the Chapman-Jouguet states of its explosives", "[physics][jwl]") {
  for (const Explosive& x : {tnt, pbx9404, tetryl}) {
    INFO(x.name);
    CjState cj(x);
    const double velocity = std::sqrt(cj.p / (1 - cj.volume) / x.density);
    CHECK(cj.p == Approx(x.pressure).epsilon(0.01));  // asked for
    CHECK(velocity == Approx(x.velocity).epsilon(0.01));

    // A small way along the isentrope, there and back: its slope is the exponent gamma, and touches the
    // Rayleigh line, -dp/dV = p/(1 - V).
    const double start = cj.point->value(Column::pressure);
    CHECK(start == Approx(cj.p).epsilon(1e-12));
    const double strain = 1e-4;
    PointDriver& point = *cj.point;
    const PointDriver::State state = point.save();
    drive(point, {.kind = PathKind::hydrostatic, .targets = {strain}, .steps = 100}, [](double) {});
    const double expanded = point.value(Column::pressure);
    point.restore(state);
    drive(point, {.kind = PathKind::hydrostatic, .targets = {-strain}, .steps = 100}, [](double) {});
    const double gamma = std::log(point.value(Column::pressure) / expanded) / (2 * strain);
    CHECK(gamma == Approx(x.gamma).epsilon(0.01));  // asked for
    // The difference is good to strain^2, the tangent's place to 1e-9.
    CHECK(gamma * cj.p / cj.volume == Approx(cj.p / (1 - cj.volume)).epsilon(1e-6));

    // The front runs at the speed of sound behind it: D = u + c with u = (1 - V) D.
    point.restore(state);
    point.step({}, 1e-6);
    CHECK((1 - cj.volume) * velocity + point.sound_speed() == Approx(velocity).epsilon(1e-6));
  }
}

TEST_CASE("the R1 that the manual prints for PBX9404 does not go with its CJ state", "[physics][jwl]") {
  // 4.55 puts the CJ pressure 2.9 % and the velocity 1.3 % too high, 4.60 has both to 2e-5.
  Explosive printed = pbx9404;
  printed.r1 = 4.55;
  CHECK(adiabat(printed, cj_volume(printed)) / printed.pressure == Approx(1.0295).margin(5e-4));
  CHECK(CjState(pbx9404).p / pbx9404.pressure == Approx(1).margin(1e-4));
}

TEST_CASE("the products expand along the JWL isentrope with second order", "[physics][jwl]") {
  for (const Explosive& x : {tnt, pbx9404, tetryl}) {
    INFO(x.name);
    const auto error = [&](int steps) {
      CjState cj(x);
      const auto cold = [&](double v) { return x.a * std::exp(-x.r1 * v) + x.b * std::exp(-x.r2 * v); };
      const double c = (cj.p - cold(cj.volume)) * std::pow(cj.volume, 1 + x.w);
      double worst = 0;
      // To about ten times the first volume: through the range of either exponential and of the gas.
      drive(*cj.point, {.kind = PathKind::hydrostatic, .targets = {std::log(10 / cj.volume)}, .steps = steps},
            [&](double strain) {
              const double v = cj.volume * std::exp(strain);
              const double exact = cold(v) + c * std::pow(v, -1 - x.w);
              worst = std::max(worst, std::abs(cj.point->value(Column::pressure) / exact - 1));
            });
      // E = A/R1 exp(-R1 V) + B/R2 exp(-R2 V) + C/w V^-w, in which the work done from the CJ state on is
      // left.
      const double v = cj.volume * cj.point->volume_ratio();
      const double left =
          x.a / x.r1 * std::exp(-x.r1 * v) + x.b / x.r2 * std::exp(-x.r2 * v) + c / x.w * std::pow(v, -x.w);
      CHECK(cj.point->energy() == Approx(left).epsilon(2 * worst));
      return worst;
    };
    const double coarse = error(250), fine = error(1000);
    CHECK(fine < 1e-4);
    CHECK(std::log2(coarse / fine) / 2 == Approx(2).margin(0.05));
  }
}

TEST_CASE("far expanded products are a gas with the exponent 1 + w", "[physics][jwl]") {
  CjState cj(tnt);
  drive(*cj.point, {.kind = PathKind::hydrostatic, .targets = {std::log(100 / cj.volume)}, .steps = 4000},
        [](double) {});
  const PointDriver& gas = *cj.point;
  CHECK(gas.value(Column::pressure) == Approx(tnt.w * gas.energy() / 100).epsilon(1e-4));
  CHECK(gas.sound_speed() ==
        Approx(std::sqrt((1 + tnt.w) * gas.value(Column::pressure) / gas.density())).epsilon(1e-4));
  CHECK(gas.events().undefined_root == 0);
}

}  // namespace mpm::tests
