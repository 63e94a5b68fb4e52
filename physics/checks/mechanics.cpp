// Checks of a law's stress, energy and wave speed.

#include <numbers>
#include <random>

#include "physics/checks/checker.hpp"

namespace mpm::physics::checks {

using core::Column;
using core::Mat3;
using core::Sym3;
using core::Vec3;

Failures ends_on_yield_surface(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  // Laws that set the pressure have surfaces in both invariants, and separate tests of the return.
  if (c.traits.sets_pressure) return {};
  PointDriver point(*c.material, {.extra_columns = {Column::yield_stress}});
  if (!point.has(Column::effective_plastic_strain)) return {};
  double strain = 0, worst = 0, worst_outside = 0;
  int plastic_steps = 0;
  walk(point, c.path(3), 100, [&] {
    const double yield = point.value(Column::yield_stress), equivalent = mises(point.deviator());
    const bool failed = point.has(Column::failed) && point.value(Column::failed) > 0;
    if (!failed && point.value(Column::effective_plastic_strain) > strain) {
      ++plastic_steps;
      worst = std::max(worst, std::abs(equivalent - yield) / yield);
    }
    worst_outside = std::max(worst_outside, (equivalent - yield) / yield);
    strain = point.value(Column::effective_plastic_strain);
  });
  c.require(plastic_steps > 10,
            "hardly any plastic flow on the path: use a larger strain; or the law has no yield");
  c.at_most(worst, 1e-8, "distance from the yield stress after a plastic step, relative");
  c.at_most(worst_outside, 1e-8, "stress beyond the yield stress, relative");
  return c.failures;
}

Failures dissipates(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  if (!c.solid() || !c.traits.linear_elasticity) return {};
  PointDriver point(*c.material, {});
  const RandomPath path = c.path(4);
  const int steps = 400;
  const double dt = sample.duration / steps;
  double shear = 0;
  const core::ParameterValues& values = sample.input.strength.values;
  if (values.contains("Young") && values.contains("Poisson"))
    shear = values.at("Young") / (2 * (1 + values.at("Poisson")));
  double dissipated = 0, scale = 0, least = 0;
  for (int i = 0; i < steps; ++i) {
    const Mat3<double> l = path.gradient((i + 0.5) * dt);
    const Sym3<double> before = point.deviator();
    const double energy = point.energy(), p = point.value(Column::pressure), v = point.value(Column::volume);
    point.step(l, dt);
    if (point.has(Column::failed) && point.value(Column::failed) > 0) break;
    // Stress work minus the energy stored by the elastic deviator: E* of the energy equation without -p dV.
    const double v0 = point.value(Column::mass) / sample.input.reference_density;
    const double dv = point.value(Column::volume) - v;
    const double work = (point.energy() - energy) + 0.5 * (p + point.value(Column::pressure)) * dv / v0;
    const double mean_volume = 0.5 * (point.value(Column::volume) + v) / v0;
    const double stored =
        shear > 0 ? (contract(point.deviator(), point.deviator()) - contract(before, before)) / (4 * shear)
                  : 0;
    const double step_dissipation = work - mean_volume * stored;
    const double volume_work = std::abs((p + point.value(Column::pressure)) * dv / v0);
    scale = std::max({scale, std::abs(work), std::abs(energy), volume_work, std::abs(mean_volume * stored)});
    least = std::min(least, step_dissipation + 1e-12 * scale);
    dissipated += step_dissipation;
  }
  c.at_most(-least, 0,
            "energy released by a step (a law whose elasticity is not linear with Young and Poisson must "
            "declare static constexpr bool linear_elasticity = false)");
  c.at_most(-dissipated, 1e-12 * scale, "energy released along the path");
  return c.failures;
}

Failures converges(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  if (!c.solid()) return {};
  const RandomPath path = c.path(5);
  const auto stress_after = [&](int steps) {
    PointDriver point(*c.material, {});
    const double scale = walk(point, path, steps);
    return std::pair{point.stress(), scale};
  };
  constexpr int coarse = 200, levels = 4;
  const auto [exact, scale] = stress_after(51200);
  double first = 0, last = 0;
  for (int level = 0; level < levels; ++level) {
    last = norm(stress_after(coarse << level).first - exact) / scale;
    if (level == 0) first = last;
  }
  // Errors of round-off size have no order; the time of failure is known only to one step, so errors scatter.
  const double order = std::log2(first / last) / (levels - 1),
               wanted = c.sample.input.failures.empty() ? 0.95 : 0.7;
  if (!(last < 1e-9)) c.at_most(wanted - order, 0, "required order of convergence minus the observed one");
  c.at_most(last, 5e-3, "error of the stress with 1600 steps, relative");
  return c.failures;
}

namespace {

Mat3<double> transpose(const Mat3<double>& a) {
  return {a.xx, a.yx, a.zx, a.xy, a.yy, a.zy, a.xz, a.yz, a.zz};
}

const Vec3<double> axis{2.0 / 7, 3.0 / 7, 6.0 / 7};
Mat3<double> skew(double w) {
  return {0, -w * axis.z, w * axis.y, w * axis.z, 0, -w * axis.x, -w * axis.y, w * axis.x, 0};
}

/// Rodrigues' formula.
Mat3<double> rotation(double angle) {
  const Mat3<double> k = skew(1), k2 = k * k;
  const double s = std::sin(angle), c = 1 - std::cos(angle);
  return Mat3<double>{1 + c * k2.xx, c * k2.xy, c * k2.xz, c * k2.yx,    1 + c * k2.yy,
                      c * k2.yz,     c * k2.zx, c * k2.zy, 1 + c * k2.zz} +
         skew(s);
}

/// Difference at the end of the path from the same path without ten superposed rotations, over the largest
/// stress.
double error_of_turns(const Checker& c, int steps) {
  const RandomPath path = c.path(7);
  PointDriver still(*c.material, {}), turned(*c.material, {});
  const double duration = c.sample.duration, dt = duration / steps,
               rate = 2 * std::numbers::pi * 10 / duration;
  double scale = 0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) * dt;
    const Mat3<double> l = path.gradient(t), q = rotation(rate * t);
    still.step(l, dt);
    turned.step(skew(rate) + q * l * transpose(q), dt);
    scale = std::max(scale, norm(still.stress()));
  }
  return norm(turned.stress() - rotate(rotation(rate * duration), still.stress())) / scale;
}

}  // namespace

Failures objective(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  if (!c.solid()) return {};
  const double coarse = error_of_turns(c, 4000), fine = error_of_turns(c, 8000);
  // 4000 steps turn by 0.9 degrees each; the angle error is 2 pi 10 (0.0157)^2/12 = 1.3e-3 in total.
  c.at_most(fine, 1e-3, "error of the stress with 8000 steps, relative");
  if (!(fine < 1e-12))
    c.at_most(1.8 - std::log2(coarse / fine), 0, "required order of convergence 1.8 minus the observed one");
  return c.failures;
}

Failures energy_balances(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  // A failing particle keeps its energy and loses its stress.
  if (!c.solid() || !sample.input.failures.empty()) return {};
  const RandomPath path = c.path(11);
  const auto imbalance = [&](int steps) {
    PointDriver point(*c.material, c.with_viscosity());
    const double start = point.energy(), dt = sample.duration / steps;
    const double v0 = point.value(Column::mass) / sample.input.reference_density;
    double work = 0;
    for (int i = 0; i < steps; ++i) {
      const Mat3<double> l = path.gradient((i + 0.5) * dt);
      const Sym3<double> strain{dt * l.xx,
                                dt * l.yy,
                                dt * l.zz,
                                0.5 * dt * (l.xy + l.yx),
                                0.5 * dt * (l.yz + l.zy),
                                0.5 * dt * (l.xz + l.zx)};
      const Sym3<double> before = point.stress();
      const double v = point.value(Column::volume);
      point.step(l, dt);
      work += 0.5 * (v + point.value(Column::volume)) / v0 * 0.5 * contract(before + point.stress(), strain);
    }
    return std::abs(point.energy() - start - work) / std::max(std::abs(work), 1e-3 * start);
  };
  const double coarse = imbalance(1000), fine = imbalance(4000);
  // The trapezoidal rule ignores the rotation of the stress within the step: second order nevertheless.
  c.at_most(fine, 1e-3, "energy minus work with 4000 steps, relative");
  if (!(fine < 1e-9))
    c.at_most(0.9 - std::log2(coarse / fine) / 2, 0,
              "required order of convergence 0.9 minus the observed one");
  return c.failures;
}

namespace {

double along(const Sym3<double>& a, const Vec3<double>& n) {
  return n.x * n.x * a.xx + n.y * n.y * a.yy + n.z * n.z * a.zz +
         2 * (n.x * n.y * a.xy + n.y * n.z * a.yz + n.x * n.z * a.xz);
}

/// Stress along n after one small step of strain along n; the point is restored.
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

/// d(stress along n)/d(strain along n), relative to a step without strain: relaxation is not stiffness.
double tangent(PointDriver& point, const Vec3<double>& n, double strain, double dt) {
  return (stress_after(point, n, strain, dt) - stress_after(point, n, 0, dt)) / strain;
}

}  // namespace

/// rho c^2 against the slope of the stress for a small, fast uniaxial strain in many directions, by
/// differences, at states along a path. Elastic unloading is stiffest, so both signs are tried.
Failures wave_speed_bounds_tangent(const LawSample& sample, const Registry& registry) {
  Checker c(sample, registry);
  if (!c.solid() || c.traits.viscous) return {};  // viscous stress is not a modulus
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  PointDriver point(*c.material, {});
  const RandomPath path = c.path(13);
  const int steps = 200;
  double largest = 0, stiffest = 0;
  // Where strength depends on the total strain rate, a fast strain raises it at once, which is not stiffness;
  // in tension this includes RHT's pressure. A slow strain leaves it constant.
  const double dt = sample.duration * (c.traits.follows_strain_rate ? 5e4 : 5e-8);
  for (int i = 0; i < steps; ++i) {
    point.step(path.gradient((i + 0.5) * sample.duration / steps), sample.duration / steps);
    if (i % 20 != 0) continue;
    // Strength lost to damage continues to decrease for some steps.
    for (int rest = 0; rest < 30; ++rest) point.step({}, dt);
    const double modulus = point.density() * point.sound_speed() * point.sound_speed();
    // (2-57) holds for dE = -p dV. The work of the deviatoric stress also heats; with dp/dE < 2 here that
    // adds at most twice the largest principal deviator, 2/3 of the von Mises stress.
    const double bound = modulus + (sample.input.eos ? 4.0 / 3.0 * mises(point.deviator()) : 0);
    for (int k = 0; k < 6; ++k) {
      Vec3<double> n{normal(random), normal(random), normal(random)};
      n = (1 / std::sqrt(dot(n, n))) * n;
      for (const double strain : {1e-7, -1e-7}) {
        const double slope = tangent(point, n, strain, dt);
        largest = std::max(largest, slope / bound);
        // An explosive has the wave speed of its products before it has burnt.
        const bool burns = point.has(Column::burn_fraction) && point.value(Column::burn_fraction) < 1;
        stiffest = std::max(stiffest, burns ? 1 : slope / modulus);
      }
    }
  }
  // The difference quotient has a first-order error of 1e-7, plus round-off 1e-16 of the modulus over 1e-7.
  c.at_most(largest, 1 + 1e-5, "stiffest tangent over rho c^2: the time step is not safe");
  // The bound is sharp: rho c^2 is the stiffness in some direction.
  c.at_most(0.98 - stiffest, 0,
            "rho c^2 is far above every tangent; 0.98 minus the stiffest tangent over rho c^2");
  return c.failures;
}

}  // namespace mpm::physics::checks
