// Boxes around bodies, from what the input states of their shapes: no particles are made.
#pragma once

#include <cmath>

#include "core/scene/scene.hpp"

namespace mpm::io {

struct Box {
  core::Vec3<double> lower{INFINITY, INFINITY, INFINITY};
  core::Vec3<double> upper{-INFINITY, -INFINITY, -INFINITY};

  bool empty() const { return lower[0] > upper[0]; }
  void include(const core::Vec3<double>& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      lower[i] = std::fmin(lower[i], p[i]);
      upper[i] = std::fmax(upper[i], p[i]);
    }
  }
};

/// In the global frame; empty for shapes that are read from files or made later.
Box box_of(const core::BodyInput& body, const core::Scene& scene);

}  // namespace mpm::io
