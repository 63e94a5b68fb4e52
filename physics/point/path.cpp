#include "physics/point/path.hpp"

#include <algorithm>
#include <cmath>

#include "physics/point/stress_step.hpp"

namespace mpm::physics {

using core::Mat3;
using core::Sym3;

namespace {

class Walker {
 public:
  Walker(PointDriver& point, const std::function<void(const PathPoint&)>& visit)
      : point_(point), visit_(visit) {}

  PathEnd run(const std::vector<Leg>& legs) {
    if (!legs.empty()) here_.strain = 0;
    visit_(here_);
    for (std::size_t i = 0; i < legs.size() && end_.reached; ++i) {
      here_.leg = end_.leg = static_cast<int>(i);
      walk(legs[i]);
    }
    return end_;
  }

 private:
  double measured(const Leg& leg) const { return weighted(leg.measure, here_.total_strain - zero_); }

  void arrive(const Leg& leg) {
    here_.strain = measured(leg);
    visit_(here_);
  }

  void count(const Mat3<double>& l, double dt) {
    here_.total_strain = here_.total_strain + dt * symmetric(l);
  }

  void walk(const Leg& leg) {
    if (leg.from_zero) zero_ = here_.total_strain;
    if (!leg.table.empty()) return walk_table(leg);
    const double amount = leg.whole ? 1 : leg.strain ? *leg.strain - measured(leg) : 0;
    const auto controls = static_cast<Eigen::Index>(leg.controls.size());
    ControlVector start(controls);
    double first_ramp = 0;
    for (Eigen::Index k = 0; k < controls; ++k) {
      const StressControl& c = leg.controls[static_cast<std::size_t>(k)];
      start[k] = weighted(c.weight, point_.stress());
      if (first_ramp == 0 && c.ramp) first_ramp = c.target - start[k];
    }
    const double duration = leg.time ? *leg.time : std::abs(leg.strain ? amount : first_ramp) / leg.rate;
    if (!(duration > 0)) return;
    const Mat3<double> known = (amount / duration) * leg.direction;
    ControlVector rates = ControlVector::Zero(controls);
    for (int i = 1; i <= leg.steps; ++i) {
      const double from = static_cast<double>(i - 1) / leg.steps, to = static_cast<double>(i) / leg.steps;
      if (!part(leg, known, start, duration, from, to, rates, 0)) return;
      arrive(leg);
    }
  }

  /// From one fraction of the leg to another; halved where the whole does not converge.
  bool part(const Leg& leg, const Mat3<double>& known, const ControlVector& start, double duration,
            double from, double to, ControlVector& rates, int depth) {
    const double dt = (to - from) * duration;
    if (leg.controls.empty()) {
      point_.step(known, dt);
      count(known, dt);
      return true;
    }
    ControlVector targets(start.size());
    for (Eigen::Index k = 0; k < targets.size(); ++k) {
      const StressControl& c = leg.controls[static_cast<std::size_t>(k)];
      targets[k] = c.ramp ? start[k] + to * (c.target - start[k]) : c.target;
    }
    StressStep step(point_, leg.controls, known);
    ControlVector found = rates;
    if (step.run(dt, targets, found)) {
      rates = found;
      count(step.gradient(found), dt);
      return true;
    }
    constexpr int deepest = 6;
    const double middle = 0.5 * (from + to);
    if (depth < deepest && part(leg, known, start, duration, from, middle, rates, depth + 1) &&
        part(leg, known, start, duration, middle, to, rates, depth + 1))
      return true;
    if (end_.reached) {
      // Reports the driving stress as unreachable; stresses held constant only follow.
      const auto ramp = std::ranges::find(leg.controls, true, &StressControl::ramp);
      end_.reached = false;
      end_.wanted = ramp != leg.controls.end() ? ramp->target : step.worst().second;
      end_.found = ramp != leg.controls.end() ? weighted(ramp->weight, point_.stress()) : step.worst().first;
    }
    return false;
  }

  /// F linear between the rows: L = (dF/dt) F^-1 at the middle of each step.
  void walk_table(const Leg& leg) {
    for (std::size_t row = 1; row < leg.table.size(); ++row) {
      const DeformationRow &a = leg.table[row - 1], &b = leg.table[row];
      const double dt = (b.time - a.time) / leg.steps;
      const auto at = [&](double w) { return (1 - w) * a.gradient + w * b.gradient; };
      for (int i = 0; i < leg.steps; ++i) {
        const double w0 = static_cast<double>(i) / leg.steps, w1 = static_cast<double>(i + 1) / leg.steps;
        const Mat3<double> change = at(w1) - at(w0), middle = at(0.5 * (w0 + w1));
        const Mat3<double> inverse = (1 / determinant(middle)) * adjugate(middle);
        const Mat3<double> l = (1 / dt) * (change * inverse);
        point_.step(l, dt);
        count(l, dt);
        arrive(leg);
      }
    }
  }

  PointDriver& point_;
  const std::function<void(const PathPoint&)>& visit_;
  PathPoint here_{};
  PathEnd end_;
  Sym3<double> zero_{};
};

}  // namespace

PathEnd walk(PointDriver& point, const std::vector<Leg>& legs,
             const std::function<void(const PathPoint&)>& visit) {
  return Walker(point, visit).run(legs);
}

}  // namespace mpm::physics
