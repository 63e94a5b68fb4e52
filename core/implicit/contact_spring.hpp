// The force between two bodies that touch at a place, by their displacements in an implicit step.
//
// With d, the displacement of the second less that of the first, n, the normal from the first to the second,
// and mu, the coefficient of friction, the first exerts on the second
//   f = p n - t   p = max(0, p_0 - k d.n)   t = t_0 + k d_t where they stick, mu p d_t/|d_t| where they slide
// with d_t = d - (d.n) n: they may part and slide. Two that are tied neither part nor slide: f = f_0 - k d.
// p_0, t_0 and f_0 are zero unless a place is followed from step to step (body_faces.hpp).
//
// Which places stick, and the friction of those that slide, are those of the last solution: a step is solved
// again, from there, until they agree. One that sticks with more than mu p slides; one that slides against
// its friction sticks. Within a solution friction is thus linear or constant, and the matrix symmetric: with
// mu p inside, Newton's method goes to and fro between directions of sliding.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/exact_sum.hpp"
#include "core/tensor/tensor.hpp"

namespace mpm::core {

/// Without its component along n.
inline Vec3<double> across(const Vec3<double>& d, const Vec3<double>& n) { return d - dot(d, n) * n; }

struct ContactSpring {
  Vec3<double> normal;        ///< from the first to the second
  double k = 0;               ///< stiffness
  double cell_stiffness = 0;  ///< of a cell of each, in series
  double coefficient = 0;     ///< of friction
  bool sticks = false;
  bool tied = false;
  Vec3<double> friction{};  ///< t of a place that slides; of one that sticks t_0
  double first = 0;         ///< p_0
  Vec3<double> gap{};       ///< what d was at the start of the step, beside which it counts
  double pressure = 0;      ///< p of the last solutions
  int solutions = 0;        ///< of this step
  int turns = 0;            ///< changes between sticking and sliding in this step

  struct Response {
    Vec3<double> force{};      ///< on the second
    Mat3<double> stiffness{};  ///< minus its derivative by the second's displacement
    double pressure = 0;       ///< p, a force
  };
  Response response(const Vec3<double>& d) const;
  /// The part of d, with the gap, in the directions in which the spring holds.
  Vec3<double> held(const Vec3<double>& d) const;
  /// Takes its force at d for p_0 and t_0.
  void take_force(const Vec3<double>& d);
  /// f(direction) of each direction, of length 1, in which it answers with the stiffness k.
  template <class F>
  void for_each_direction(const Vec3<double>& d, F f) const {
    const Vec3<double>& n = normal;
    if (tied || first - k * dot(d + gap, n) >= 0) f(n);
    if (!tied && !sticks) return;
    int least = 0;
    for (int a = 1; a < 3; ++a)
      if (std::abs(n[a]) < std::abs(n[least])) least = a;
    Vec3<double> axis{};
    axis[least] = 1;
    const Vec3<double> in_plane = across(axis, n), t = (1 / std::sqrt(dot(in_plane, in_plane))) * in_plane;
    f(t);
    f(cross(n, t));
  }

  /// Over the places of a rank.
  struct Changes {
    ExactSum change;  ///< of the friction of places that slide
    ExactSum most;    ///< mu p of all
  };
  /// Whether it sticks after a solution, and its friction. `relaxation`: stiffness, over that of a cell, with
  /// which friction grows with the slip of a place that slides. Adds to `changes` where it `counts`.
  void find_friction(const Vec3<double>& d, double relaxation, bool counts, Changes& changes);
};

}  // namespace mpm::core
