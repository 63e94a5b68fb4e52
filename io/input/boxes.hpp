// Boxes around bodies, from what the input states of their shapes: no particles are made.
#pragma once

#include <array>
#include <cmath>

#include "core/scene/scene.hpp"

namespace mpm::io {

struct Box {
  std::array<double, 3> lower{INFINITY, INFINITY, INFINITY};
  std::array<double, 3> upper{-INFINITY, -INFINITY, -INFINITY};

  bool empty() const { return lower[0] > upper[0]; }
  void include(const std::array<double, 3>& p) {
    for (std::size_t i = 0; i < 3; ++i) {
      lower[i] = std::fmin(lower[i], p[i]);
      upper[i] = std::fmax(upper[i], p[i]);
    }
  }
};

/// In the global frame; empty for shapes that are read from files or made later.
Box box_of(const core::BodyInput& body, const core::Scene& scene);

}  // namespace mpm::io
