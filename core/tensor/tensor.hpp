// Small tensors of any value type (double or Lanes): general and symmetric second-order tensors.
// Components refer to the global Cartesian frame. Symmetric tensors hold tensor (not engineering) shear.
#pragma once

#include "core/simd/lanes.hpp"
#include "core/tensor/vec3.hpp"

namespace mpm::core {

/// Component ij is row i, column j; a velocity gradient has xy = d v_x / d y.
template <class T>
struct Mat3 {
  T xx, xy, xz, yx, yy, yz, zx, zy, zz;
  friend Mat3 operator+(const Mat3& a, const Mat3& b) {
    return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yx + b.yx, a.yy + b.yy,
            a.yz + b.yz, a.zx + b.zx, a.zy + b.zy, a.zz + b.zz};
  }
  friend Mat3 operator-(const Mat3& a, const Mat3& b) {
    return {a.xx - b.xx, a.xy - b.xy, a.xz - b.xz, a.yx - b.yx, a.yy - b.yy,
            a.yz - b.yz, a.zx - b.zx, a.zy - b.zy, a.zz - b.zz};
  }
  friend Mat3 operator*(T k, const Mat3& a) {
    return {k * a.xx, k * a.xy, k * a.xz, k * a.yx, k * a.yy, k * a.yz, k * a.zx, k * a.zy, k * a.zz};
  }
  friend Mat3 operator*(const Mat3& a, const Mat3& b) {
    return {a.xx * b.xx + a.xy * b.yx + a.xz * b.zx, a.xx * b.xy + a.xy * b.yy + a.xz * b.zy,
            a.xx * b.xz + a.xy * b.yz + a.xz * b.zz, a.yx * b.xx + a.yy * b.yx + a.yz * b.zx,
            a.yx * b.xy + a.yy * b.yy + a.yz * b.zy, a.yx * b.xz + a.yy * b.yz + a.yz * b.zz,
            a.zx * b.xx + a.zy * b.yx + a.zz * b.zx, a.zx * b.xy + a.zy * b.yy + a.zz * b.zy,
            a.zx * b.xz + a.zy * b.yz + a.zz * b.zz};
  }
};

template <class T>
T determinant(const Mat3<T>& a) {
  return a.xx * (a.yy * a.zz - a.yz * a.zy) - a.xy * (a.yx * a.zz - a.yz * a.zx) +
         a.xz * (a.yx * a.zy - a.yy * a.zx);
}

/// Inverse of `a` times its determinant.
template <class T>
Mat3<T> adjugate(const Mat3<T>& a) {
  return {a.yy * a.zz - a.yz * a.zy, a.xz * a.zy - a.xy * a.zz, a.xy * a.yz - a.xz * a.yy,
          a.yz * a.zx - a.yx * a.zz, a.xx * a.zz - a.xz * a.zx, a.xz * a.yx - a.xx * a.yz,
          a.yx * a.zy - a.yy * a.zx, a.xy * a.zx - a.xx * a.zy, a.xx * a.yy - a.xy * a.yx};
}

template <class T>
struct Sym3 {
  T xx, yy, zz, xy, yz, xz;
  friend Sym3 operator+(const Sym3& a, const Sym3& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.yz + b.yz, a.xz + b.xz};
  }
  friend Sym3 operator-(const Sym3& a, const Sym3& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.yz - b.yz, a.xz - b.xz};
  }
  friend Sym3 operator*(T k, const Sym3& a) {
    return {k * a.xx, k * a.yy, k * a.zz, k * a.xy, k * a.yz, k * a.xz};
  }
};

template <class T>
T trace(const Sym3<T>& a) {
  return a.xx + a.yy + a.zz;
}
/// a : b
template <class T>
T contract(const Sym3<T>& a, const Sym3<T>& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + T(2.0) * (a.xy * b.xy + a.yz * b.yz + a.xz * b.xz);
}
template <class T>
Sym3<T> deviator(const Sym3<T>& a) {
  const T m = trace(a) * T(1.0 / 3.0);
  return {a.xx - m, a.yy - m, a.zz - m, a.xy, a.yz, a.xz};
}
/// sqrt(3/2 s:s) of a deviator: the von Mises equivalent stress.
template <class T>
T mises(const Sym3<T>& s) {
  return sqrt(T(1.5) * contract(s, s));
}

/// R a R^T
template <class T>
Sym3<T> rotate(const Mat3<T>& r, const Sym3<T>& a) {
  const Mat3<T> b = r * Mat3<T>{a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz};
  return {b.xx * r.xx + b.xy * r.xy + b.xz * r.xz, b.yx * r.yx + b.yy * r.yy + b.yz * r.yz,
          b.zx * r.zx + b.zy * r.zy + b.zz * r.zz, b.xx * r.yx + b.xy * r.yy + b.xz * r.yz,
          b.yx * r.zx + b.yy * r.zy + b.yz * r.zz, b.xx * r.zx + b.xy * r.zy + b.xz * r.zz};
}

/// Rotation of one step by the mid-point rule, R = (I - W/2)^-1 (I + W/2), for the spin increment W with
/// axial vector w (W a = w x a). Orthogonal to round-off for any w, second order in the angle.
/// Hughes and Winget, Int. J. Numer. Methods Eng. 15 (1980) 1862-1867.
template <class T>
Mat3<T> mid_point_rotation(const Vec3<T>& w) {
  const T x = T(0.5) * w.x, y = T(0.5) * w.y, z = T(0.5) * w.z;
  const T n = x * x + y * y + z * z;
  const T k = T(2.0) / (T(1.0) + n);
  // R = I + k (A + A A) for A the skew tensor of w/2, and A A = a a^T - n I.
  return {T(1.0) + k * (x * x - n), k * (x * y - z),          k * (x * z + y),
          k * (x * y + z),          T(1.0) + k * (y * y - n), k * (y * z - x),
          k * (x * z - y),          k * (y * z + x),          T(1.0) + k * (z * z - n)};
}

}  // namespace mpm::core
