#include "core/discretise/profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mpm::core {

namespace {

class Cone final : public Profile {
 public:
  explicit Cone(const CylinderGeometry& cylinder) : c_(cylinder) {}
  double height() const override { return c_.height; }
  double inner(double z) const override { return between(c_.bottom_inner_radius, c_.top_inner_radius, z); }
  double outer(double z) const override { return between(c_.bottom_outer_radius, c_.top_outer_radius, z); }
  double volume(double lower, double upper, double from, double to) const override {
    const double third = std::numbers::pi / 3 * (upper - lower);
    const auto frustum = [&](double fraction) {
      const double a = wall(lower, fraction);
      const double b = wall(upper, fraction);
      return third * (a * a + a * b + b * b);
    };
    return frustum(to) - frustum(from);
  }

 private:
  double between(double bottom, double top, double z) const {
    return bottom + (top - bottom) * std::clamp(z / c_.height, 0.0, 1.0);
  }
  double wall(double z, double fraction) const { return inner(z) + fraction * (outer(z) - inner(z)); }

  CylinderGeometry c_;
};

class Ogive final : public Profile {
 public:
  explicit Ogive(const OgiveGeometry& ogive)
      : arc_(ogive.ogive_radius),
        offset_(ogive.ogive_radius - ogive.end_radius),
        height_(std::sqrt(ogive.end_radius * (ogive.ogive_radius + offset_))) {}
  double height() const override { return height_; }
  double inner(double) const override { return 0; }
  double outer(double z) const override {
    return std::max(0.0, std::sqrt(std::max(0.0, (arc_ - z) * (arc_ + z))) - offset_);
  }
  double volume(double lower, double upper, double from, double to) const override {
    return (to * to - from * from) * (below(upper) - below(lower));
  }

 private:
  /// Integral of pi r^2 from the base to z.
  double below(double z) const {
    z = std::clamp(z, 0.0, height_);
    const double root = std::sqrt(std::max(0.0, (arc_ - z) * (arc_ + z)));
    const double arc_part = z * root + arc_ * arc_ * std::asin(std::min(1.0, z / arc_));
    return std::numbers::pi * (z * (arc_ * arc_ + offset_ * offset_ - z * z / 3) - offset_ * arc_part);
  }

  double arc_;
  double offset_;  ///< from the axis to the arc's centre
  double height_;
};

}  // namespace

Revolved revolved(const CylinderGeometry& c) {
  return {c.base_centre, c.bottom_spacing, c.top_spacing, c.angle, std::make_shared<Cone>(c)};
}

Revolved revolved(const OgiveGeometry& o) {
  return {o.base_centre, o.bottom_spacing, o.top_spacing, o.angle, std::make_shared<Ogive>(o)};
}

}  // namespace mpm::core
