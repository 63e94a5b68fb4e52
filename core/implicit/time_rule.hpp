// Time integration rules of an implicit step of length dt, from the nodes' displacement u in the step, their
// velocity v, the force f and the lag q at its start, and the force f' at its end:
//   equation of motion      m (inertia u - start v) - carry f - recall q = f'
//   velocity at the end     v' = gain u + keep v + push (f + q)/m
//   lag at the end          q' = fresh (f' - f) - fade q
// Newmark (1959): u = dt v + dt^2 ((1/2 - beta) a + beta a'), v' = v + dt ((1 - gamma) a + gamma a'). The
// material point method maps stresses to a new grid in every step, so a = f/m follows from the state at the
// start and particles need not store it. With beta = 1/4 and gamma = 1/2 (trapezoidal rule) it drops out of
// v' = 2 u/dt - v, and no nodal mass is divided by; energy is conserved where forces are linear in u.
// Backward Euler: v' = u/dt, m (v' - v)/dt = f'; first order, damps what the step does not resolve.
// Generalised alpha (Chung and Hulbert, J. Appl. Mech. 60 (1993) 371): Newmark's formulas with an a that is
// not f/m at the same time but balances means over the step,
//   m ((1 - am) a' + am a) = (1 - af) f' + af f,
// with am, af, beta and gamma by the spectral radius rho: of an oscillation whose period is far shorter than
// the step, a step leaves the part rho. Second order. Forces are mapped anew here too; what is carried is
// the lag q = m a - f, first order in dt and zero with rho = 1, which is the trapezoidal rule. It obeys the
// last equation above. Loads from outside are taken at midstep and are the same in f and f': they act in
// full, without lag, which is of second order. Particles carry q/m over dt, so that steps of changing length
// keep the order, and take its increments from the nodes as they take those of the velocity: for motion that
// changes slowly q then tends to fresh/(1 + fade) (f' - f), whatever the maps to the grid and back smooth.
// Quasi-static: 0 = f'.
#pragma once

#include "core/scene/solution.hpp"

namespace mpm::core {

struct TimeRule {
  double inertia = 0, start = 0, carry = 0, recall = 0;
  double gain = 0, keep = 0, push = 0;
  double fresh = 0, fade = 0;

  static TimeRule newmark(double beta, double gamma, double dt) {
    TimeRule rule;
    rule.inertia = 1 / (beta * dt * dt);
    rule.start = 1 / (beta * dt);
    rule.carry = rule.recall = 1 / (2 * beta) - 1;
    rule.gain = gamma / (beta * dt);
    rule.keep = 1 - gamma / beta;
    rule.push = dt * (1 - gamma / (2 * beta));
    return rule;
  }
  static TimeRule backward_euler(double dt) {
    TimeRule rule;
    rule.inertia = 1 / (dt * dt);
    rule.start = rule.gain = 1 / dt;
    return rule;
  }
  static TimeRule generalised_alpha(double radius, double dt) {
    const double am = (2 * radius - 1) / (radius + 1), af = radius / (radius + 1), more = 1 - am + af;
    TimeRule rule = newmark(0.25 * more * more, more - 0.5, dt);
    const double weight = (1 - am) / (1 - af), old = rule.carry;
    rule.inertia *= weight;
    rule.start *= weight;
    rule.recall = weight * old - am / (1 - af);
    rule.carry = rule.recall + af / (1 - af);
    rule.fresh = (am - af) / (1 - am);
    rule.fade = am / (1 - am);
    return rule;
  }
  static TimeRule quasistatic() { return {}; }

  static TimeRule of(const ImplicitInput& input, double dt) {
    if (input.quasistatic()) return quasistatic();
    if (input.linearised() || input.rule == ImplicitRule::backward_euler) return backward_euler(dt);
    if (input.rule == ImplicitRule::generalised_alpha) return generalised_alpha(input.spectral_radius, dt);
    return newmark(input.newmark_beta, input.newmark_gamma, dt);
  }
  /// Whether particles carry a lag.
  static bool lags(const ImplicitInput& input) {
    return input.type == ImplicitType::dynamic && input.rule == ImplicitRule::generalised_alpha &&
           input.spectral_radius < 1;
  }
  bool dynamic() const { return inertia > 0; }
  /// f' over the mass: the equation of motion, with f and q over the mass.
  double force_at_end(double u, double v, double f, double q) const {
    return inertia * u - start * v - carry * f - recall * q;
  }
};

}  // namespace mpm::core
