#pragma once
// Bounding boxes of the shapes of bodies from the input alone, without particles.

#include <cmath>

#include "core/scene/scene.hpp"

namespace mpm::core {

struct SolidBox {
  Vec3<double> lower{INFINITY, INFINITY, INFINITY};
  Vec3<double> upper{-INFINITY, -INFINITY, -INFINITY};

  bool empty() const { return lower[0] > upper[0]; }
  void include(const Vec3<double>& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      lower[i] = std::fmin(lower[i], p[i]);
      upper[i] = std::fmax(upper[i], p[i]);
    }
  }
};

/// In the global frame; for a Bool body the box of its minuend. Empty for shapes that are read from files and
/// for finite elements.
SolidBox solid_box(const Scene& scene, const BodyInput& body);

}  // namespace mpm::core
