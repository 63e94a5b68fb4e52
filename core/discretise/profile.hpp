#pragma once
// Outlines of solids of revolution: radii as functions of the height above the base. Both outlines are
// monotone in z.

#include <memory>

#include "core/scene/geometry.hpp"

namespace mpm::core {

class Profile {
 public:
  virtual ~Profile() = default;
  virtual double height() const = 0;
  virtual double inner(double z) const = 0;  ///< z in [0, height]
  virtual double outer(double z) const = 0;
  /// Volume of the full revolution between two heights and between two fractions of the wall (0: the inner
  /// surface, 1: the outer one). Volumes of adjacent pieces add up to the whole to round-off.
  virtual double volume(double lower, double upper, double from, double to) const = 0;
};

/// A solid of revolution from the input, with any outline.
struct Revolved {
  Vec3<double> base{};  ///< centre of the base, local frame
  double bottom_spacing = 0;
  double top_spacing = 0;
  double angle = 360;
  std::shared_ptr<const Profile> profile;
};

/// Radii linear between bottom and top.
Revolved revolved(const CylinderGeometry& cylinder);

/// A tangent ogive: an arc of radius R whose centre lies in the base plane, so that it starts at the base's
/// rim, of radius E, in the direction of the axis: r(z) = sqrt(R^2 - z^2) - (R - E); the tip is where r = 0.
Revolved revolved(const OgiveGeometry& ogive);

}  // namespace mpm::core
