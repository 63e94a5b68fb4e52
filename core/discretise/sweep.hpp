#pragma once
// The part of a solid of revolution from the xz half plane (x > 0) through `angle` about local Z, and points
// on its arcs. Sweeps of whole quadrants are exact, and their arcs symmetric to the last bit.

#include <array>
#include <cstdint>

#include "core/discretise/frame.hpp"

namespace mpm::core {

/// Integers [begin, end).
struct Span {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

class Sweep {
 public:
  /// degrees in (0, 360]
  explicit Sweep(double degrees);

  double fraction() const { return degrees_ / 360; }
  bool only_positive_x() const { return degrees_ <= 90; }
  bool only_positive_y() const { return degrees_ <= 180; }

  /// The i for which the lattice point (2i + 1, row) is in the sweep; row is odd.
  Span columns(std::int64_t row) const;
  bool contains(double x, double y) const;
  /// Box around the swept disc, between the heights given.
  Box box(double radius, double lower, double upper) const;

  /// Number of nearly equal steps of about `spacing` along the arc at `radius`; a multiple of the number of
  /// quadrants where the sweep consists of whole ones. Grows with radius/spacing.
  double arc_count(double radius, double spacing) const;
  /// Cosine and sine at the middle of an arc's step, index < count.
  std::array<double, 2> arc_direction(std::uint64_t index, std::uint64_t count) const;

 private:
  double degrees_;
  double cotangent_ = 0;
  int quadrants_ = 0;  ///< 0 unless made of whole quadrants
};

}  // namespace mpm::core
