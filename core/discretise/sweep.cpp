#include "core/discretise/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/discretise/line.hpp"

namespace mpm::core {

namespace {

constexpr double radian = std::numbers::pi / 180;

/// Exact at odd multiples of 45 and 90 degrees. Not called for half and whole turns.
double cotangent(double degrees) {
  const double quotient = degrees / 45;
  if (quotient != std::floor(quotient)) return std::cos(radian * degrees) / std::sin(radian * degrees);
  const int eighth = static_cast<int>(quotient) % 4;
  return eighth == 1 ? 1 : eighth == 2 ? 0 : -1;
}

/// Cosine and sine at the middle of step `index` of `count` in the first quadrant; indices mirrored about the
/// diagonal swap them exactly.
std::array<double, 2> quadrant_direction(std::uint64_t index, std::uint64_t count) {
  const std::uint64_t mirror = count - 1 - index;
  if (index == mirror) return {std::numbers::sqrt2 / 2, std::numbers::sqrt2 / 2};
  const auto step = static_cast<double>(std::min(index, mirror));
  const double angle = (step + 0.5) / static_cast<double>(count) * (std::numbers::pi / 2);
  std::array<double, 2> direction{std::cos(angle), std::sin(angle)};
  if (index > mirror) std::swap(direction[0], direction[1]);
  return direction;
}

}  // namespace

Sweep::Sweep(double degrees) : degrees_(degrees) {
  if (degrees != 180 && degrees != 360) cotangent_ = cotangent(degrees);
  const double quadrants = degrees / 90;
  if (quadrants == std::floor(quadrants)) quadrants_ = static_cast<int>(quadrants);
}

Span Sweep::columns(std::int64_t row) const {
  constexpr std::int64_t far = std::int64_t{1} << 50;
  if (degrees_ >= 360 || (row > 0 && degrees_ >= 180)) return {-far, far};
  if (row < 0 && degrees_ <= 180) return {};
  // The end of the sweep cuts the row at x = row * cotangent.
  const double cut = static_cast<double>(row) * cotangent_;
  const double slack = on_boundary * std::abs(static_cast<double>(row)) * (1 + std::abs(cotangent_));
  const auto whole = [](double x) { return static_cast<std::int64_t>(std::clamp<double>(x, -far, far)); };
  if (row > 0) return {whole(std::ceil((cut - slack - 1) / 2)), far};
  return {-far, whole(std::floor((cut + slack - 1) / 2)) + 1};
}

bool Sweep::contains(double x, double y) const {
  if (degrees_ >= 360) return true;
  const double slack = on_boundary * (std::abs(x) + std::abs(y));
  if (y >= -slack && degrees_ >= 180) return true;
  // Beyond the end when the turn from the end's direction to the point is to the left.
  const double turn = y * std::cos(radian * degrees_) - x * std::sin(radian * degrees_);
  if (degrees_ <= 180) return y >= -slack && turn <= slack;
  return turn <= slack;
}

Box Sweep::box(double radius, double lower, double upper) const {
  return {
      {{only_positive_x() ? 0 : -radius, only_positive_y() ? 0 : -radius, lower}, {radius, radius, upper}}};
}

double Sweep::arc_count(double radius, double spacing) const {
  if (quadrants_ > 0) return quadrants_ * whole_count(std::numbers::pi / 2 * radius, spacing);
  return whole_count(radian * degrees_ * radius, spacing);
}

std::array<double, 2> Sweep::arc_direction(std::uint64_t index, std::uint64_t count) const {
  if (quadrants_ == 0) {
    const double angle = radian * degrees_ * (static_cast<double>(index) + 0.5) / static_cast<double>(count);
    return {std::cos(angle), std::sin(angle)};
  }
  const std::uint64_t per_quadrant = count / static_cast<std::uint64_t>(quadrants_);
  const auto [c, s] = quadrant_direction(index % per_quadrant, per_quadrant);
  switch (index / per_quadrant) {
    case 0: return {c, s};
    case 1: return {-s, c};
    case 2: return {-c, -s};
    default: return {s, -c};
  }
}

}  // namespace mpm::core
