#include "physics/point/stress_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace mpm::physics {

using core::Mat3;
using core::Sym3;

namespace {

using ControlMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_controls, most_controls>;

double largest(const Sym3<double>& a) {
  return std::max(
      {std::abs(a.xx), std::abs(a.yy), std::abs(a.zz), std::abs(a.xy), std::abs(a.yz), std::abs(a.xz)});
}

/// The largest magnitude; infinity where a component is infinite or NaN.
double norm(const ControlVector& r) {
  return r.allFinite() ? r.lpNorm<Eigen::Infinity>() : std::numeric_limits<double>::infinity();
}

}  // namespace

Sym3<double> symmetric(const Mat3<double>& a) {
  return {a.xx, a.yy, a.zz, 0.5 * (a.xy + a.yx), 0.5 * (a.yz + a.zy), 0.5 * (a.xz + a.zx)};
}

StressStep::StressStep(PointDriver& point, const std::vector<StressControl>& controls,
                       const Mat3<double>& known)
    : point_(point), controls_(controls), known_(known) {}

bool StressStep::run(double dt, const ControlVector& targets, ControlVector& rates) {
  before_ = point_.save();
  dt_ = dt;
  targets_ = targets;
  stiffness_ = point_.density() * point_.sound_speed() * point_.sound_speed();
  stress_scale_ = largest(point_.stress());
  for (const double target : targets) stress_scale_ = std::max(stress_scale_, std::abs(target));
  ControlVector guess = rates;
  if (newton(guess) || (targets.size() == 1 && bracket(guess = rates)) || newton(guess.setZero())) {
    rates = guess;
    return true;
  }
  point_.restore(before_);
  return false;
}

Mat3<double> StressStep::gradient(const ControlVector& rates) const {
  Mat3<double> l = known_;
  for (std::size_t k = 0; k < controls_.size(); ++k)
    l = l + rates[static_cast<Eigen::Index>(k)] * controls_[k].mode;
  return l;
}

ControlVector StressStep::residual(const ControlVector& rates) {
  point_.restore(before_);
  const Mat3<double> l = gradient(rates);
  point_.step(l, dt_);
  const Sym3<double> stress = point_.stress();
  stress_scale_ = std::max(stress_scale_, largest(stress));
  strain_scale_ = std::max(strain_scale_, dt_ * largest(symmetric(l)));
  ControlVector r(targets_.size());
  double largest_miss = -1;
  for (Eigen::Index k = 0; k < r.size(); ++k) {
    const double found = weighted(controls_[static_cast<std::size_t>(k)].weight, stress);
    r[k] = found - targets_[k];
    if (std::abs(r[k]) > largest_miss) {
      largest_miss = std::abs(r[k]);
      worst_ = {found, targets_[k]};
    }
  }
  return r;
}

double StressStep::tolerance() const { return 1e-9 * std::max(stress_scale_, stiffness_ * strain_scale_); }

bool StressStep::newton_step(const ControlVector& x, const ControlVector& r, ControlVector& step) {
  // The difference is small relative to the step and far above the laws' round-off.
  const double missing = stiffness_ > 0 ? norm(r) / stiffness_ : 0;
  const double h = 1e-4 * std::max({strain_scale_, missing, 1e-12}) / dt_;
  ControlMatrix jacobian(x.size(), x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    ControlVector moved = x;
    moved[j] += h;
    jacobian.col(j) = (residual(moved) - r) / h;
  }
  if (!jacobian.allFinite()) return false;
  Eigen::FullPivLU<ControlMatrix> factors(jacobian);
  factors.setThreshold(1e-10);  // of the largest pivot
  if (!factors.isInvertible()) return false;
  step = factors.solve(-r);
  return true;
}

bool StressStep::newton(ControlVector& x) {
  ControlVector r = residual(x);
  for (int iteration = 0; iteration < 40; ++iteration) {
    if (norm(r) <= tolerance()) return true;
    if (!std::isfinite(norm(r))) return false;
    ControlVector step;
    if (!newton_step(x, r, step)) return false;
    // Trial strains exceed the last by at most a tenth.
    const double longest = dt_ * norm(step);
    double part = std::min(1.0, 0.1 / std::max(longest, 1e-300));
    const double old_norm = norm(r);
    bool better = false;
    for (int halving = 0; halving < 12 && !better; ++halving, part *= 0.5) {
      const ControlVector tried = x + part * step;
      const ControlVector there = residual(tried);
      better = norm(there) < (1 - 1e-4 * part) * old_norm || norm(there) <= tolerance();
      if (!better) continue;
      x = tried;
      r = there;
    }
    if (!better) return false;
  }
  return false;
}

bool StressStep::bracket(ControlVector& x) {
  const auto f = [&](double rate) { return residual(ControlVector::Constant(1, rate))[0]; };
  const double width0 = std::max({strain_scale_, tolerance() / std::max(stiffness_, 1e-300), 1e-12}) / dt_;
  double low = x[0] - width0, high = x[0] + width0, f_low = f(low), f_high = f(high);
  for (double width = width0; f_low > 0 && width * dt_ < 0.5; width *= 2) f_low = f(low -= width);
  for (double width = width0; f_high < 0 && width * dt_ < 0.5; width *= 2) f_high = f(high += width);
  if (!(f_low <= 0 && f_high >= 0)) return false;
  for (int i = 0; i < 200; ++i) {
    double next = low - f_low * (high - low) / (f_high - f_low);
    if (i % 3 == 2 || !(next > low && next < high)) next = 0.5 * (low + high);
    const double value = f(x[0] = next);
    if (std::abs(value) <= tolerance()) return true;
    if (!(next > low && next < high)) return false;  // a jump: no rate gives the target
    (value > 0 ? high : low) = next;
    (value > 0 ? f_high : f_low) = value;
  }
  return false;
}

}  // namespace mpm::physics
