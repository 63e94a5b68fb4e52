// One step with some stresses prescribed, which finds the strain rates that produce them, using the
// material's own update as a black box. Newton's method on trial steps, each from the saved state, with
// derivatives from differences of trial steps and, for one unknown, bracketing where Newton's method fails.
// Tested by tests/physics/path_test.cpp.
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "physics/point/leg.hpp"
#include "physics/point/point_driver.hpp"

namespace mpm::physics {

/// At most one control per stress component.
inline constexpr int most_controls = 6;
/// One value per control of a leg.
using ControlVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most_controls, 1>;

/// The rate of deformation.
core::Sym3<double> symmetric(const core::Mat3<double>& a);

/// One step whose controlled stresses equal `targets` at its end.
class StressStep {
 public:
  /// `known`: the part of the velocity gradient that does not depend on the unknown rates. Point and controls
  /// must outlive the step.
  StressStep(PointDriver& point, const std::vector<StressControl>& controls, const core::Mat3<double>& known);

  /// `rates` holds the first guess, and on return the solution. On false the point is unchanged.
  bool run(double dt, const ControlVector& targets, ControlVector& rates);

  /// Stress of the control farthest from its target in the last trial, and that target.
  std::pair<double, double> worst() const { return worst_; }
  /// The velocity gradient with these rates.
  core::Mat3<double> gradient(const ControlVector& rates) const;

 private:
  /// A trial step; the state remains at its end.
  ControlVector residual(const ControlVector& rates);
  /// Round-off of the laws, 1e-12 of a stress, times a thousand; of an unloaded body, of its elastic stress.
  double tolerance() const;
  bool newton(ControlVector& x);
  /// The step of Newton's method from x, where the residual is r; false where the stresses do not distinguish
  /// the rates.
  bool newton_step(const ControlVector& x, const ControlVector& r, ControlVector& step);
  /// One unknown whose stress increases with it: bracket, then the secant method safeguarded by bisection.
  /// For kinks at which Newton's method oscillates.
  bool bracket(ControlVector& x);

  PointDriver& point_;
  const std::vector<StressControl>& controls_;
  core::Mat3<double> known_;
  PointDriver::State before_;
  double dt_ = 0;
  ControlVector targets_;
  double stiffness_ = 0, stress_scale_ = 0, strain_scale_ = 0;
  std::pair<double, double> worst_{};
};

}  // namespace mpm::physics
