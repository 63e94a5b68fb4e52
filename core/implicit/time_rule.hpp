// Time integration rules of an implicit step of length dt, from the nodes' displacement u in the step, their
// velocity v and the force f at its start, and the force f' at its end:
//   equation of motion      m (inertia u - start v) - carry f = f'
//   velocity at the end     v' = gain u + keep v + push f/m
// Newmark (1959): u = dt v + dt^2 ((1/2 - beta) a + beta a'), v' = v + dt ((1 - gamma) a + gamma a'). The
// material point method maps stresses to a new grid in every step, so a = f/m follows from the state at the
// start and particles need not store it. With beta = 1/4 and gamma = 1/2 (trapezoidal rule) it drops out of
// v' = 2 u/dt - v, and no nodal mass is divided by; energy is conserved where forces are linear in u.
// Backward Euler: v' = u/dt, m (v' - v)/dt = f'; first order, damps what the step does not resolve.
// Quasi-static: 0 = f'.
#pragma once

#include "core/scene/solution.hpp"

namespace mpm::core {

struct TimeRule {
  double inertia = 0, start = 0, carry = 0;
  double gain = 0, keep = 0, push = 0;

  static TimeRule newmark(double beta, double gamma, double dt) {
    return {1 / (beta * dt * dt), 1 / (beta * dt),  1 / (2 * beta) - 1,
            gamma / (beta * dt),  1 - gamma / beta, dt * (1 - gamma / (2 * beta))};
  }
  static TimeRule backward_euler(double dt) { return {1 / (dt * dt), 1 / dt, 0, 1 / dt, 0, 0}; }
  static TimeRule quasistatic() { return {}; }

  static TimeRule of(const ImplicitInput& input, double dt) {
    if (input.quasistatic) return quasistatic();
    if (input.backward_euler) return backward_euler(dt);
    return newmark(input.newmark_beta, input.newmark_gamma, dt);
  }
  bool dynamic() const { return inertia > 0; }
};

}  // namespace mpm::core
