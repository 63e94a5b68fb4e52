#pragma once
// Integer arithmetic that makes the lattices exactly symmetric.

#include <cmath>
#include <cstdint>

namespace mpm::core {

/// Relative tolerance within which a particle on a boundary counts as inside: far above the round-off of
/// decimal input, far below any effect on results; dimensionless.
inline constexpr double on_boundary = 1e-9;

/// Coordinates origin + half * odd, half being half a spacing. Where the origin itself is a multiple of
/// `half` (to 1e-9 of it) both are combined in one integer: a body symmetric about zero is then bitwise
/// symmetric, and bodies that share a lattice share its coordinates.
class LatticeLine {
 public:
  LatticeLine(double origin, double spacing) : origin_(origin), half_(spacing / 2) {
    const double steps = origin / half_;
    steps_ = std::nearbyint(steps);
    snapped_ = std::abs(steps - steps_) <= on_boundary && std::abs(steps) < 1e15;
  }
  double at(double odd) const { return snapped_ ? (steps_ + odd) * half_ : origin_ + odd * half_; }

 private:
  double origin_;
  double half_;
  double steps_ = 0;
  bool snapped_ = false;
};

/// 2 i + 1, exact.
template <class Integer>
double odd(Integer i) {
  return static_cast<double>(2 * i + 1);
}

/// Nearest integer number of spacings in a length, at least 1.
inline double whole_count(double length, double spacing) {
  return std::fmax(1, std::floor(length / spacing + 0.5));
}

/// Largest r with r * r <= n, for n < 2^60.
inline std::int64_t whole_root(std::int64_t n) {
  if (n <= 0) return 0;
  auto r = static_cast<std::int64_t>(std::sqrt(static_cast<double>(n)));
  while (r * r > n) --r;
  while ((r + 1) * (r + 1) <= n) ++r;
  return r;
}

/// Number of odd integers a > 0 with a * a <= n.
inline std::int64_t odd_roots(std::int64_t n) { return (whole_root(n) + 1) / 2; }

}  // namespace mpm::core
