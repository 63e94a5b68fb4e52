// The trilinear hexahedron x(xi) = sum_c M_c(xi) x_c, -1 <= xi_k <= 1, and the exact means over it that CPDI2
// needs (Sadeghirad, Brannon and Guilkey, IJNME 95 (2013) 928). Corner c = i + 2 j + 4 k has M_c =
// (1 +- xi_1)(1 +- xi_2)(1 +- xi_3)/8.
//
// In modes instead of corners, with (k, l, m) cyclic,
//   x = x_0 + sum_k (a_k xi_k + b_k xi_l xi_m) + h xi_1 xi_2 xi_3
// and <.> the mean over xi, all means are polynomials. With A_k = a_l x a_m and Q_k = b_m x b_l
//   <J>          = a_1 . A_1 + sum_k a_k . Q_k / 3                  an eighth of the volume
//   d<J>/d a_k   = A_k + Q_k/3,  d<J>/d b_k = B_k = (a_m x b_l + b_m x a_l)/3,  d<J>/d h = 0
//   <xi_k J>     = (A_m . b_l + A_l . b_m + h . B_k)/3
//   <xi_l xi_m J> = (A_k . h - a_l . Q_m - a_m . Q_l - h . Q_k/3)/9,  <xi_1 xi_2 xi_3 J> = -2 b_3 . Q_3/27
// The integral of grad M_c is the volume's derivative with respect to corner c. Shown against quadrature by
// tests/core/shape.
#pragma once

#include <initializer_list>

#include "core/simd/lanes.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

inline constexpr int corners = 8;

/// Replaces x[c] and x[c | bit] by `lower` and `upper` of the two, axis by axis.
template <class T, class Lower, class Upper>
inline void combine_along_axes(T (&x)[corners], Lower lower, Upper upper) {
  for (const int bit : {1, 2, 4}) {
    for (int c = 0; c < corners; ++c) {
      if ((c & bit) != 0) continue;
      const T low = x[c], high = x[c | bit];
      x[c] = lower(low, high);
      x[c | bit] = upper(low, high);
    }
  }
}
/// Sums over the corners with the signs of each mode: 1, xi_1, xi_2, xi_1 xi_2, xi_3, ... (bit k: xi_k).
template <class T>
inline void corners_to_modes(T (&x)[corners]) {
  combine_along_axes(
      x, [](const T& low, const T& high) { return low + high; },
      [](const T& low, const T& high) { return high - low; });
}
/// Sums over the modes with their signs at each corner.
template <class T>
inline void modes_to_corners(T (&x)[corners]) {
  combine_along_axes(
      x, [](const T& even, const T& odd) { return even - odd; },
      [](const T& even, const T& odd) { return even + odd; });
}

/// The corners middle +-a +-b +-c, a component of them.
template <class T>
inline void parallelepiped_corners(T middle, T a, T b, T c, T (&corner)[corners]) {
  const T sum = a + b, difference = a - b;
  for (const int upper : {0, 1}) {
    const T face = upper == 0 ? middle - c : middle + c;
    T* at = corner + 4 * upper;
    at[0] = face - sum;
    at[1] = face + difference;
    at[2] = face - difference;
    at[3] = face + sum;
  }
}

/// Means over a domain of its corners' functions M_c and of their gradients.
template <class T>
struct CornerWeights {
  T value[corners];
  T slope[3][corners];
};

template <class T>
class Hexahedron {
 public:
  /// Corners by component.
  explicit Hexahedron(const T (&x)[3][corners]) {
    const T eighth(0.125), third(1.0 / 3.0);
    for (int i = 0; i < 3; ++i) {
      T mode[corners];
      for (int c = 0; c < corners; ++c) mode[c] = eighth * x[i][c];
      corners_to_modes(mode);
      middle[i] = mode[0];
      for (int k = 0; k < 3; ++k) {
        a[k][i] = mode[1 << k];
        b[k][i] = mode[7 - (1 << k)];
      }
      h[i] = mode[7];
    }
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      A_[k] = cross(a[l], a[m]);
      Q_[k] = cross(b[m], b[l]);
      B_[k] = third * (cross(a[m], b[l]) + cross(b[m], a[l]));
    }
    mean_jacobian = dot(a[0], A_[0]) + third * (dot(a[0], Q_[0]) + dot(a[1], Q_[1]) + dot(a[2], Q_[2]));
  }

  CornerWeights<T> weights() const {
    const T scale = T(0.125) / mean_jacobian, third(1.0 / 3.0);
    CornerWeights<T> w;
    moments(w.value);
    for (T& v : w.value) v = scale * v;
    modes_to_corners(w.value);
    for (int i = 0; i < 3; ++i) {
      w.slope[i][0] = w.slope[i][7] = T(0.0);
      for (int k = 0; k < 3; ++k) {
        w.slope[i][1 << k] = scale * (A_[k][i] + third * Q_[k][i]);
        w.slope[i][7 - (1 << k)] = scale * B_[k][i];
      }
      modes_to_corners(w.slope[i]);
    }
    return w;
  }

  /// sum_c <M_c J> x_c / <J>.
  Vec3<T> centroid() const {
    T moment[corners];
    moments(moment);
    Vec3<T> sum = moment[7] * h;
    for (int k = 0; k < 3; ++k) sum = sum + moment[1 << k] * a[k] + moment[7 - (1 << k)] * b[k];
    return middle + (T(1.0) / mean_jacobian) * sum;
  }

  Vec3<T> middle, a[3], b[3], h;  ///< the modes
  T mean_jacobian;

 private:
  /// <m J> of the modes m.
  void moments(T (&moment)[corners]) const {
    const T third(1.0 / 3.0), ninth(1.0 / 9.0);
    moment[0] = mean_jacobian;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      moment[1 << k] = third * (dot(A_[m], b[l]) + dot(A_[l], b[m]) + dot(h, B_[k]));
      moment[7 - (1 << k)] = ninth * (dot(h, A_[k] - third * Q_[k]) - dot(a[l], Q_[m]) - dot(a[m], Q_[l]));
    }
    moment[7] = T(-2.0 / 27.0) * dot(b[2], Q_[2]);
  }

  Vec3<T> A_[3], B_[3], Q_[3];
};

/// The smallest of the Jacobians at the corners, which are triple products of half edges, and of their mean.
template <class T>
inline T smallest_jacobian(const T (&x)[3][corners], const T& mean) {
  T smallest(0.0);
  for (int c = 0; c < corners; ++c) {
    Vec3<T> edge[3];
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) edge[k][i] = T(0.5) * (x[i][c | (1 << k)] - x[i][c & ~(1 << k)]);
    const T here = dot(edge[0], cross(edge[1], edge[2]));
    smallest = c == 0 ? here : min(smallest, here);
  }
  return min(smallest, mean);  // in this order, so that a NaN remains
}

}  // namespace mpm::core
