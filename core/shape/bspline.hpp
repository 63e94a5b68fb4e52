// Quadratic and cubic B-splines on the uniform grid (Steffen, Kirby and Berzins, IJNME 76 (2008) 922; review
// 2.2.3). They keep one form up to walls, where outer nodes follow their mirror image (BoundaryFaces).
#pragma once

#include "core/shape/separable.hpp"

namespace mpm::core {

/// Around a node, t = s - 1/2 from it: (1/2 - t)^2 / 2, 3/4 - t^2, (1/2 + t)^2 / 2.
struct QuadraticAlong {
  static constexpr int nodes = 3;
  static constexpr bool has_size = false;
  template <class T>
  static void evaluate(T s, T* value, T* slope) {
    const T t = s - T(0.5), u = T(1.0) - s;
    value[0] = T(0.5) * u * u;
    value[1] = T(0.75) - t * t;
    value[2] = T(0.5) * s * s;
    slope[0] = -u;
    slope[1] = T(-2.0) * t;
    slope[2] = s;
  }
};

/// In a cell, s from its lower node.
struct CubicAlong {
  static constexpr int nodes = 4;
  static constexpr bool has_size = false;
  template <class T>
  static void evaluate(T s, T* value, T* slope) {
    const T u = T(1.0) - s, sixth(1.0 / 6.0), half(0.5);
    value[0] = sixth * u * u * u;
    value[1] = T(2.0 / 3.0) - s * s * (T(1.0) - half * s);
    value[2] = T(2.0 / 3.0) - u * u * (T(1.0) - half * u);
    value[3] = sixth * s * s * s;
    slope[0] = -half * u * u;
    slope[1] = s * (T(1.5) * s - T(2.0));
    slope[2] = u * (T(2.0) - T(1.5) * u);
    slope[3] = half * s * s;
  }
};

struct QuadraticBSpline : Separable<QuadraticAlong> {
  static constexpr std::string_view name = "QuadraticBSpline";
};
static_assert(ShapePolicy<QuadraticBSpline>);

struct CubicBSpline : Separable<CubicAlong> {
  static constexpr std::string_view name = "CubicBSpline";
};
static_assert(ShapePolicy<CubicBSpline>);

}  // namespace mpm::core
