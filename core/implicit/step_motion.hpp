// What a solution of an implicit step does to the particles, and whether it can be accepted.
//
// How far a node moves does not matter: the grid is the configuration at the start of the step, and a
// particle may travel over any number of bricks (core/step/migration.hpp). What matters:
// - The strain, for laws that add up increments. They receive the displacement gradient at midstep, whose
//   symmetric part h is the logarithmic strain less h^3/12: its largest norm over their particles is limited.
//   Laws that keep the deformation gradient take their stress from it, whatever the step; there a step is
//   limited by inversion alone, where Newton's method fails.
// - Walls hold nodes. Between a node on a wall and the next one a particle cannot pass the wall while nothing
//   inverts where it is, but nothing is evaluated in between: no particle may end beyond a wall.
// - Bodies that meet within the step: contact comes through the nodes that bodies share at its start. Two
//   bodies whose boxes are more than a cell apart at the start may not move by more than a cell against each
//   other if their paths cross. Bodies within each other's boxes, and a body's own folds, are not looked at.
// Shown by tests/core/implicit/step_motion_test.cpp and tests/system/physics_implicit.py.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/tensor/tensor.hpp"

namespace mpm::core {

class StepMotion {
 public:
  /// Of the norm of h: lengths change to no less than 0.6 and no more than 1.67 of them, and the strain is
  /// that of its logarithm within 2 %.
  static constexpr double largest_strain = 0.5;
  /// Part of a cell by which a particle may end beyond a wall: rounding.
  static constexpr double rounding = 1e-9;

  StepMotion() = default;
  explicit StepMotion(std::size_t bodies) : bodies_(bodies) {}

  /// The norm of h of a particle.
  void add_strain(double strain) { strain_ = strain > strain_ ? strain : strain_; }
  /// A particle's place and displacement, in cells from the grid's origin.
  void add_particle(int body, const Vec3<double>& at, const Vec3<double>& moved);
  /// By how many cells it ends beyond a wall.
  void add_beyond_wall(double cells) { beyond_wall_ = cells > beyond_wall_ ? cells : beyond_wall_; }

  void merge(const StepMotion& other);
  /// Collective.
  void combine(Reductions& ranks);

  bool overstrains() const { return strain_ > largest_strain; }
  /// Why the step cannot be accepted; empty if it can. `names`: of the bodies.
  std::string objection(const std::vector<std::string>& names) const;

 private:
  /// Of a body: the box of its particles' places at the start and of those at both ends of the step, and
  /// their smallest and largest displacements.
  struct Travel {
    static constexpr double none = std::numeric_limits<double>::infinity();
    /// Lower bounds, and upper ones with the sign reversed.
    double start[6] = {none, none, none, none, none, none};
    double path[6] = {none, none, none, none, none, none};
    double moved[6] = {none, none, none, none, none, none};
    bool empty() const { return start[0] == none; }
  };
  /// By how many cells two bodies that meet within the step move against each other; 0 where they do not.
  static double approach(const Travel& a, const Travel& b);

  double strain_ = 0, beyond_wall_ = 0;
  std::vector<Travel> bodies_;
};

}  // namespace mpm::core
