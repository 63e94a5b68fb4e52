#include "physics/point/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace mpm::physics {

using core::Mat3;
using core::Sym3;

double weighted(const Sym3<double>& w, const Sym3<double>& t) {
  return w.xx * t.xx + w.yy * t.yy + w.zz * t.zz + w.xy * t.xy + w.yz * t.yz + w.xz * t.xz;
}

namespace {

constexpr std::size_t most_controls = 6;
using Vector = std::array<double, most_controls>;
using Matrix = std::array<Vector, most_controls>;

Mat3<double> scaled(double k, const Mat3<double>& a) {
  return {k * a.xx, k * a.xy, k * a.xz, k * a.yx, k * a.yy, k * a.yz, k * a.zx, k * a.zy, k * a.zz};
}

Mat3<double> sum(const Mat3<double>& a, const Mat3<double>& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yx + b.yx, a.yy + b.yy,
          a.yz + b.yz, a.zx + b.zx, a.zy + b.zy, a.zz + b.zz};
}

Sym3<double> symmetric(const Mat3<double>& a) {
  return {a.xx, a.yy, a.zz, 0.5 * (a.xy + a.yx), 0.5 * (a.yz + a.zy), 0.5 * (a.xz + a.zx)};
}

double largest(const Sym3<double>& a) {
  return std::max(
      {std::abs(a.xx), std::abs(a.yy), std::abs(a.zz), std::abs(a.xy), std::abs(a.yz), std::abs(a.xz)});
}

Mat3<double> inverse(const Mat3<double>& a) {
  return scaled(1 / determinant(a),
                {a.yy * a.zz - a.yz * a.zy, a.xz * a.zy - a.xy * a.zz, a.xy * a.yz - a.xz * a.yy,
                 a.yz * a.zx - a.yx * a.zz, a.xx * a.zz - a.xz * a.zx, a.xz * a.yx - a.xx * a.yz,
                 a.yx * a.zy - a.yy * a.zx, a.xy * a.zx - a.xx * a.zy, a.xx * a.yy - a.xy * a.yx});
}

/// a x = b by elimination with pivots; false where a is singular to working accuracy.
bool solve(Matrix a, Vector b, std::size_t n, Vector& x) {
  double size = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) size = std::max(size, std::abs(a[i][j]));
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    if (!(std::abs(a[pivot][k]) > 1e-10 * size)) return false;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double f = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
      b[i] -= f * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    double sum = b[k];
    for (std::size_t j = k + 1; j < n; ++j) sum -= a[k][j] * x[j];
    x[k] = sum / a[k][k];
  }
  return true;
}

/// One step whose controlled stresses are to be `targets` at its end.
class StressStep {
 public:
  StressStep(PointDriver& point, const std::vector<StressControl>& controls, const Mat3<double>& known)
      : point_(point), controls_(controls), n_(controls.size()), known_(known) {}

  /// `rates` are the first guess, and the answer. Where false the point is as before the step.
  bool run(double dt, const Vector& targets, Vector& rates) {
    before_ = point_.save();
    dt_ = dt;
    targets_ = targets;
    stiffness_ = point_.density() * point_.sound_speed() * point_.sound_speed();
    stress_scale_ = largest(point_.stress());
    for (std::size_t k = 0; k < n_; ++k) stress_scale_ = std::max(stress_scale_, std::abs(targets[k]));
    Vector guess = rates;
    if (newton(guess) || (n_ == 1 && bracket(guess = rates)) || newton(guess = Vector{})) {
      rates = guess;
      return true;
    }
    point_.restore(before_);
    return false;
  }

  /// Stress of the control that was furthest from its target in the last trial, and that target.
  std::pair<double, double> worst() const { return worst_; }
  Mat3<double> gradient(const Vector& rates) const {
    Mat3<double> l = known_;
    for (std::size_t k = 0; k < n_; ++k) l = sum(l, scaled(rates[k], controls_[k].mode));
    return l;
  }

 private:
  /// A trial step; the state is left at its end.
  Vector residual(const Vector& rates) {
    point_.restore(before_);
    const Mat3<double> l = gradient(rates);
    point_.step(l, dt_);
    const Sym3<double> stress = point_.stress();
    stress_scale_ = std::max(stress_scale_, largest(stress));
    strain_scale_ = std::max(strain_scale_, dt_ * largest(symmetric(l)));
    Vector r{};
    double largest_miss = -1;
    for (std::size_t k = 0; k < n_; ++k) {
      const double found = weighted(controls_[k].weight, stress);
      r[k] = found - targets_[k];
      if (std::abs(r[k]) > largest_miss) {
        largest_miss = std::abs(r[k]);
        worst_ = {found, targets_[k]};
      }
    }
    return r;
  }

  double norm(const Vector& r) const {
    double result = 0;
    for (std::size_t k = 0; k < n_; ++k) {
      if (!std::isfinite(r[k])) return std::numeric_limits<double>::infinity();
      result = std::max(result, std::abs(r[k]));
    }
    return result;
  }

  /// Round-off of the laws, 1e-12 of a stress, times a thousand; of an unloaded body, of its elastic stress.
  double tolerance() const { return 1e-9 * std::max(stress_scale_, stiffness_ * strain_scale_); }

  bool newton(Vector& x) {
    Vector r = residual(x);
    for (int iteration = 0; iteration < 40; ++iteration) {
      if (norm(r) <= tolerance()) return true;
      if (!std::isfinite(norm(r))) return false;
      // The difference is small beside the step and far above the laws' own round-off.
      const double missing = stiffness_ > 0 ? norm(r) / stiffness_ : 0;
      const double h = 1e-4 * std::max({strain_scale_, missing, 1e-12}) / dt_;
      Matrix jacobian{};
      for (std::size_t j = 0; j < n_; ++j) {
        Vector moved = x;
        moved[j] += h;
        const Vector there = residual(moved);
        for (std::size_t i = 0; i < n_; ++i) jacobian[i][j] = (there[i] - r[i]) / h;
      }
      Vector minus_r{}, step{};
      for (std::size_t k = 0; k < n_; ++k) minus_r[k] = -r[k];
      if (!solve(jacobian, minus_r, n_, step)) return false;
      // No trial strains by more than a tenth beyond the last.
      const double longest = dt_ * norm(step);
      double part = std::min(1.0, 0.1 / std::max(longest, 1e-300));
      const double old_norm = norm(r);
      bool better = false;
      for (int halving = 0; halving < 12 && !better; ++halving, part *= 0.5) {
        Vector tried = x;
        for (std::size_t k = 0; k < n_; ++k) tried[k] += part * step[k];
        const Vector there = residual(tried);
        better = norm(there) < (1 - 1e-4 * part) * old_norm || norm(there) <= tolerance();
        if (!better) continue;
        x = tried;
        r = there;
      }
      if (!better) return false;
    }
    return false;
  }

  /// One unknown whose stress grows with it: bracket, then the secant with bisection as the safeguard. For
  /// the kinks at which Newton's method swings.
  bool bracket(Vector& x) {
    const auto f = [&](double rate) { return residual(Vector{rate})[0]; };
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

  PointDriver& point_;
  const std::vector<StressControl>& controls_;
  std::size_t n_;
  Mat3<double> known_;
  PointDriver::State before_;
  double dt_ = 0;
  Vector targets_{};
  double stiffness_ = 0, stress_scale_ = 0, strain_scale_ = 0;
  std::pair<double, double> worst_{};
};

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
    Vector start{};
    double first_ramp = 0;
    for (std::size_t k = 0; k < leg.controls.size(); ++k) {
      start[k] = weighted(leg.controls[k].weight, point_.stress());
      if (first_ramp == 0 && leg.controls[k].ramp) first_ramp = leg.controls[k].target - start[k];
    }
    const double duration = leg.time ? *leg.time : std::abs(leg.strain ? amount : first_ramp) / leg.rate;
    if (!(duration > 0)) return;
    const Mat3<double> known = scaled(amount / duration, leg.direction);
    Vector rates{};
    for (int i = 1; i <= leg.steps; ++i) {
      const double from = static_cast<double>(i - 1) / leg.steps, to = static_cast<double>(i) / leg.steps;
      if (!part(leg, known, start, duration, from, to, rates, 0)) return;
      arrive(leg);
    }
  }

  /// From one fraction of the leg to another; in halves where the whole does not converge.
  bool part(const Leg& leg, const Mat3<double>& known, const Vector& start, double duration, double from,
            double to, Vector& rates, int depth) {
    const double dt = (to - from) * duration;
    if (leg.controls.empty()) {
      point_.step(known, dt);
      count(known, dt);
      return true;
    }
    Vector targets{};
    for (std::size_t k = 0; k < leg.controls.size(); ++k) {
      const StressControl& c = leg.controls[k];
      targets[k] = c.ramp ? start[k] + to * (c.target - start[k]) : c.target;
    }
    StressStep step(point_, leg.controls, known);
    Vector found = rates;
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
      // What drives is what cannot be reached; what must stay at a value only follows.
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
      const auto at = [&](double w) { return sum(scaled(1 - w, a.gradient), scaled(w, b.gradient)); };
      for (int i = 0; i < leg.steps; ++i) {
        const double w0 = static_cast<double>(i) / leg.steps, w1 = static_cast<double>(i + 1) / leg.steps;
        const Mat3<double> change = sum(at(w1), scaled(-1, at(w0)));
        const Mat3<double> l = scaled(1 / dt, change * inverse(at(0.5 * (w0 + w1))));
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

namespace legs {

namespace {

Leg leg(std::string kind, const Mat3<double>& direction, const Sym3<double>& measure, double strain) {
  Leg made;
  made.kind = std::move(kind);
  made.direction = direction;
  made.measure = measure;
  made.strain = strain;
  return made;
}

constexpr Mat3<double> axial{1, 0, 0, 0, 0, 0, 0, 0, 0};
constexpr Sym3<double> along_x{1, 0, 0, 0, 0, 0};
// Two equal lateral directions are one unknown, measured by their mean.
constexpr StressControl lateral{{0, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0.5, 0.5, 0, 0, 0}, 0, false};

}  // namespace

Leg uniaxial_strain(double strain) { return leg("uniaxial_strain", axial, along_x, strain); }

Leg uniaxial_stress(double strain) {
  Leg made = leg("uniaxial_stress", axial, along_x, strain);
  made.controls = {lateral};
  return made;
}

Leg triaxial(double strain, double confining_pressure) {
  Leg made = leg("triaxial", axial, along_x, strain);
  made.controls = {lateral};
  made.controls[0].target = -confining_pressure;
  return made;
}

Leg biaxial(double strain, double confining_pressure) {
  Leg made = leg("biaxial", axial, along_x, strain);
  made.controls = {{{0, 0, 0, 0, 1, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0}, -confining_pressure, false}};
  return made;
}

Leg equibiaxial(double strain) {
  Leg made = leg("equibiaxial", {1, 0, 0, 0, 1, 0, 0, 0, 0}, along_x, strain);
  made.controls = {{{0, 0, 0, 0, 0, 0, 0, 0, 1}, {0, 0, 1, 0, 0, 0}, 0, false}};
  return made;
}

Leg simple_shear(double gamma) {
  return leg("simple_shear", {0, 1, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 2, 0, 0}, gamma);
}

Leg hydrostatic(double strain) {
  constexpr double third = 1.0 / 3.0;
  return leg("hydrostatic", {third, 0, 0, 0, third, 0, 0, 0, third}, {1, 1, 1, 0, 0, 0}, strain);
}

Leg pressure(double pressure, double time) {
  constexpr double third = 1.0 / 3.0;
  Leg made = hydrostatic(0);
  made.kind = "pressure";
  made.strain.reset();
  made.time = time;
  made.controls = {{made.direction, {third, third, third, 0, 0, 0}, -pressure, true}};
  return made;
}

Leg hold(double time) {
  Leg made;
  made.kind = "hold";
  made.time = time;
  return made;
}

}  // namespace legs

bool drive(PointDriver& point, const Path& path, const std::function<void(double)>& visit) {
  const auto leg_to = [&](double target) {
    switch (path.kind) {
      case PathKind::uniaxial_strain: return legs::uniaxial_strain(target);
      case PathKind::simple_shear: return legs::simple_shear(target);
      case PathKind::hydrostatic: return legs::hydrostatic(target);
      case PathKind::uniaxial_stress: return legs::uniaxial_stress(target);
      case PathKind::gradient: break;
    }
    return Leg{};
  };
  double strain = 0;
  bool reached = true;
  visit(strain);
  for (const double target : path.targets) {
    const double start = strain, length = target - start;
    if (length == 0) continue;
    Leg leg = leg_to(length);
    leg.from_zero = true;
    leg.steps = path.steps;
    leg.time = std::abs(length) / path.rate;
    int done = -1;  // the state before the first step was shown
    // A gradient need not strain at all (a rotation), so it drives by the number itself.
    if (path.kind == PathKind::gradient) {
      for (int i = 1; i <= path.steps; ++i) {
        point.step(scaled(length > 0 ? path.rate : -path.rate, path.gradient), *leg.time / path.steps);
        visit(strain = start + length * i / path.steps);
      }
      continue;
    }
    reached = walk(point, {leg},
                   [&](const PathPoint&) {
                     if (++done > 0) visit(strain = start + length * done / path.steps);
                   })
                  .reached &&
              reached;
    strain = target;
  }
  return reached;
}

}  // namespace mpm::physics
