// Principal values of a symmetric tensor, for all lanes at once and without a loop.
//
// The largest root of the characteristic equation of the normalised deviator, 4 c^3 - 3 c = r with c =
// cos(acos(r)/3) (Smith, Comm. ACM 4 (1961) 168), is well separated from the other two when r >= 0; where r <
// 0 the tensor's sign is reversed. The other two do not come from the same formula, which loses half the
// digits where they nearly coincide: the tensor is reduced to the plane normal to the first axis, where half
// their difference is a norm. The error is below 8e-15 of the largest component, also for double and triple
// values, for tensors of any size (tests/core/tensor/principal_test.cpp, against an iterative solver).
#pragma once

#include <limits>

#include "core/tensor/tensor.hpp"

namespace mpm::core {

namespace detail {

/// Cosine of a third of the acute angle of cosine r, 0 <= r <= 1: the root of 4 c^3 - 3 c = r in
/// [cos(pi/6), 1].
template <class T>
T cosine_of_third_of_acute(const T& r) {
  // A parabola within 2e-3 of the root; the error of each Newton step is below 2.1 times the square of the
  // previous one.
  T c = 0.8660254037844386 + r * (0.166 - 0.032 * r);
  for (int i = 0; i < 3; ++i) c = (8.0 * c * c * c + r) / (12.0 * c * c - 3.0);
  return c;
}

/// Unit vector along the null space of a symmetric matrix of rank two; zero for rank less than two.
template <class T>
Vec3<T> null_vector(const Sym3<T>& a) {
  // The columns of the adjugate are multiples of it, and their length is large where their diagonal component
  // is.
  const T xx = a.yy * a.zz - a.yz * a.yz, yy = a.xx * a.zz - a.xz * a.xz, zz = a.xx * a.yy - a.xy * a.xy;
  const T xy = a.xz * a.yz - a.xy * a.zz, xz = a.xy * a.yz - a.xz * a.yy, yz = a.xy * a.xz - a.yz * a.xx;
  const auto y_first = abs(yy) > abs(xx);
  Vec3<T> v{select(y_first, xy, xx), select(y_first, yy, xy), select(y_first, yz, xz)};
  const auto z_first = abs(zz) > max(abs(xx), abs(yy));
  v = {select(z_first, xz, v.x), select(z_first, yz, v.y), select(z_first, zz, v.z)};
  const T length2 = dot(v, v);
  return select(length2 > 0.0, 1.0 / sqrt(length2), T(0.0)) * v;
}

}  // namespace detail

/// x >= y >= z. A NaN component makes all results NaN.
template <class T>
Vec3<T> principal_values(const Sym3<T>& a) {
  const T largest = max(max(max(abs(a.xx), abs(a.yy)), max(abs(a.zz), abs(a.xy))), max(abs(a.yz), abs(a.xz)));
  const T scale = select(largest > std::numeric_limits<double>::min(), largest, T(1.0));
  const T per_scale = 1.0 / scale;
  const Sym3<T> unit = per_scale * a;
  const T mean = trace(unit) * (1.0 / 3.0);
  const Sym3<T> d{unit.xx - mean, unit.yy - mean, unit.zz - mean, unit.xy, unit.yz, unit.xz};

  // In units of `radius` the deviator's values are 2 cos of angles a third of a revolution apart. Below this
  // size the square is round-off of the mean.
  const T radius2 = contract(d, d) * (1.0 / 6.0);
  const T radius = sqrt(radius2);
  const Sym3<T> b = select(radius2 > 1e-40, 1.0 / radius, T(0.0)) * d;
  const T determinant_b = b.xx * (b.yy * b.zz - b.yz * b.yz) - b.xy * (b.xy * b.zz - b.yz * b.xz) +
                          b.xz * (b.xy * b.yz - b.yy * b.xz);
  const auto flipped = determinant_b < 0.0;
  const T sign = select(flipped, T(-1.0), T(1.0));
  const T first = 2.0 * detail::cosine_of_third_of_acute(min(abs(determinant_b) * 0.5, 1.0));

  // The plane normal to the first axis n: M = P (B + first/2) P with P = I - n n has the values +-half, 0.
  const Sym3<T> s = sign * b;
  const Vec3<T> n = detail::null_vector(Sym3<T>{s.xx - first, s.yy - first, s.zz - first, s.xy, s.yz, s.xz});
  const T shift = 0.5 * first;
  const Sym3<T> c{s.xx + shift, s.yy + shift, s.zz + shift, s.xy, s.yz, s.xz};
  const Vec3<T> w{c.xx * n.x + c.xy * n.y + c.xz * n.z, c.xy * n.x + c.yy * n.y + c.yz * n.z,
                  c.xz * n.x + c.yz * n.y + c.zz * n.z};
  const T k = dot(n, w);
  const Sym3<T> m{c.xx - 2.0 * n.x * w.x + k * n.x * n.x,       c.yy - 2.0 * n.y * w.y + k * n.y * n.y,
                  c.zz - 2.0 * n.z * w.z + k * n.z * n.z,       c.xy - n.x * w.y - n.y * w.x + k * n.x * n.y,
                  c.yz - n.y * w.z - n.z * w.y + k * n.y * n.z, c.xz - n.x * w.z - n.z * w.x + k * n.x * n.z};
  const T half = sqrt(0.5 * contract(m, m));

  // Without a first axis, in a multiple of the unit tensor, radius and all of this are zero.
  const T outer = sign * first, upper = half - sign * shift, lower = -half - sign * shift;
  const auto value = [&](const T& v) { return scale * (mean + radius * v); };
  const Vec3<T> up{value(outer), value(upper), value(lower)}, down{value(upper), value(lower), value(outer)};
  const auto undefined = (largest * 0.0 != 0.0) | (mean != mean);
  const auto choose = [&](const T& u, const T& l) {
    return select(undefined, std::numeric_limits<double>::quiet_NaN(), select(flipped, l, u));
  };
  return {choose(up.x, down.x), choose(up.y, down.y), choose(up.z, down.z)};
}

}  // namespace mpm::core
