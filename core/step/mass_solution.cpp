#include "core/step/mass_solution.hpp"

#include <algorithm>

namespace mpm::core {

namespace {

using Half = Lanes<4>;

/// Bits of the components held at a node are in its direction's omitted share.
void hold(const Motion& direction, int axis) {
  double& held = direction.omitted_share();
  held = static_cast<double>(static_cast<int>(held) | 1 << axis);
}
bool holds(const double* direction, int axis) {
  const MotionRecord<const double> d{direction};
  return (static_cast<int>(d.omitted_share()) >> axis & 1) != 0;
}

}  // namespace

void begin_mass_solution(const BoundaryFaces& faces, int nodes, double mass_cutoff, const double* motion,
                         MotionVector from, MotionVector stopped, MotionVector u, double* direction,
                         double* solution) {
  for (int n = 0; n < nodes; ++n) {
    const double* lumped = motion + node_doubles * n;
    const Motion d{direction + node_doubles * n}, s{solution + node_doubles * n};
    const double m = MotionRecord<const double>{lumped}.mass();
    for (int a = 0; a < 3; ++a) {
      d.velocity()[a] = 0;
      d.increment()[a] = s.at[u + a] = lumped[from + a];
    }
    d.mass() = s.mass() = m > mass_cutoff ? m : 0;
    d.omitted_share() = s.omitted_share() = 0;
  }
  faces.for_each_node(direction, [&](int axis, int, Boundary boundary, double* at) {
    const Motion d{at};
    const double* lumped = motion + (at - direction);
    if (boundary == Boundary::fixed) {
      for (int a = 0; a < 3; ++a) hold(d, a);
    } else if (boundary == Boundary::symmetry ||
               (boundary == Boundary::rigid_wall && lumped[stopped + axis] == 0)) {
      hold(d, axis);
    }
  });
  faces.fill(direction);
}

void advance_mass_solution(const BoundaryFaces& faces, int nodes, const double* products, bool first,
                           const MassIteration::Step& step, MotionVector u, double* direction,
                           double* solution) {
  // D^-1 M_b d = b d + (1 - b) q/m with the products q. At first d is u_0, and so is D^-1 of the right-hand
  // side: r = (1 - b)(u_0 - q/m).
  const double own = first ? -(1 - mass_blend) : mass_blend;
  for (int n = 0; n < nodes; ++n) {
    const Motion d{direction + node_doubles * n};
    const double m = d.mass();
    if (!(m > 0)) continue;
    const double share = (1 - mass_blend) / m;
    double* result = solution + node_doubles * n + u;
    for (int a = 0; a < 3; ++a) {
      double &residual = d.velocity()[a], &along = d.increment()[a];
      if (holds(d.at, a)) {
        along = 0;
        continue;
      }
      residual -= own * along + share * products[node_doubles * n + a];
      along = (first ? 0 : step.last * along) + step.residual * residual;
      result[a] += along;
    }
  }
  faces.fill(direction);
}

void add_increment(const BoundaryFaces& faces, int nodes, const double* direction, double* solution) {
  add_vector(nodes, solution, Motion::increment_at, 1, Motion::velocity_at, solution);
  faces.for_each_node(solution, [&](int axis, int, Boundary boundary, double* at) {
    if (boundary == Boundary::rigid_wall && holds(direction + (at - solution), axis))
      Motion{at}.velocity()[axis] = 0;
  });
}

void end_mass_solution(const BoundaryFaces& faces, double* solution) {
  faces.for_each_node(solution, [](int axis, int sign, Boundary boundary, double* at) {
    double& v = Motion{at}.velocity()[axis];
    if (boundary == Boundary::rigid_wall && sign * v > 0) v = 0;
  });
  faces.fill(solution);
}

}  // namespace mpm::core
