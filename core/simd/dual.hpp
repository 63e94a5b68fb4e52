// Dual numbers: a value with its derivatives with respect to N parameters. Code written for a value type T
// (double or Lanes) runs unchanged with Dual<T, N> and yields derivatives that are exact to round-off.
//
// Comparisons compare values, so the derivatives are those of the branch that the values take; select()
// chooses the derivatives with the value, and nothing of the other branch enters, not even NaN. Where a
// derivative is infinite or undefined it is set to zero: sqrt at 0, pow at 0 for exponents below 1, and
// exp(-inf), which is how the laws write 0^m. Values are those of T to the last bit or two: the compiler may
// contract other products.
//
// In memory the value is at its address p and derivative k at p + (k + 1) shadow_distance (load, store), so
// that code addresses memory laid out for T, followed by N copies of the layout. That memory is the caller's
// concern (physics/material/tangent.cpp). Tested by tests/core/simd/dual_test.cpp.
#pragma once

#include <type_traits>

#include "core/simd/math.hpp"

namespace mpm::core {

/// Doubles from a value in memory to its first derivative, and from each derivative to the next: an odd
/// number of cache lines, so that the N + 1 lines of a number are in different sets of the first-level cache.
inline constexpr int shadow_distance = 345 * 8;

template <class T, int N>
struct Dual {
  using Mask = typename LaneTraits<T>::Mask;
  T v;     ///< value
  T d[N];  ///< derivatives

  Dual() = default;
  Dual(double x) : v(x) { constant(); }
  Dual(const T& x) requires(!std::is_same_v<T, double>) : v(x) { constant(); }

  /// f(v), where f' = slope.
  Dual chain(const T& value, const T& slope) const {
    Dual r;
    r.v = value;
    for (int k = 0; k < N; ++k) r.d[k] = slope * d[k];
    return r;
  }

  friend Dual operator+(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v + b.v;
    for (int k = 0; k < N; ++k) r.d[k] = a.d[k] + b.d[k];
    return r;
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v - b.v;
    for (int k = 0; k < N; ++k) r.d[k] = a.d[k] - b.d[k];
    return r;
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v * b.v;
    for (int k = 0; k < N; ++k) r.d[k] = a.d[k] * b.v + a.v * b.d[k];
    return r;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    Dual r;
    r.v = a.v / b.v;
    const T inverse = 1.0 / b.v;
    for (int k = 0; k < N; ++k) r.d[k] = inverse * (a.d[k] - r.v * b.d[k]);
    return r;
  }
  friend Dual operator-(const Dual& a) {
    Dual r;
    r.v = -a.v;
    for (int k = 0; k < N; ++k) r.d[k] = -a.d[k];
    return r;
  }
  // With a constant.
  friend Dual operator+(Dual a, double b) {
    a.v = a.v + b;
    return a;
  }
  friend Dual operator+(double a, const Dual& b) { return b + a; }
  friend Dual operator-(Dual a, double b) {
    a.v = a.v - b;
    return a;
  }
  friend Dual operator-(double a, const Dual& b) {
    Dual r;
    r.v = a - b.v;
    for (int k = 0; k < N; ++k) r.d[k] = -b.d[k];
    return r;
  }
  friend Dual operator*(double a, const Dual& b) { return b.chain(a * b.v, a); }
  friend Dual operator*(const Dual& a, double b) { return b * a; }
  friend Dual operator/(double a, const Dual& b) {
    const T value = a / b.v;
    return b.chain(value, -value / b.v);
  }
  friend Dual operator/(const Dual& a, double b) { return a.chain(a.v / b, 1 / b); }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }

  friend Mask operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend Mask operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend Mask operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend Mask operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }
  friend Mask operator==(const Dual& a, const Dual& b) { return a.v == b.v; }
  friend Mask operator!=(const Dual& a, const Dual& b) { return a.v != b.v; }

 private:
  void constant() {
    for (int k = 0; k < N; ++k) d[k] = 0.0;
  }
};

template <class T, int N>
struct LaneTraits<Dual<T, N>> {
  static constexpr int width = LaneTraits<T>::width;
  using Mask = MaskOf<T>;
};

/// How many derivatives a value type carries.
template <class T>
inline constexpr int derivatives_of = 0;
template <class T, int N>
inline constexpr int derivatives_of<Dual<T, N>> = N;

template <class T>
requires(derivatives_of<T> > 0) inline T load(const double* p) {
  T x;
  x.v = load<decltype(x.v)>(p);
  for (int k = 0; k < derivatives_of<T>; ++k) x.d[k] = load<decltype(x.v)>(p + (k + 1) * shadow_distance);
  return x;
}
template <class T, int N>
inline void store(double* p, const Dual<T, N>& x) {
  store(p, x.v);
  for (int k = 0; k < N; ++k) store(p + (k + 1) * shadow_distance, x.d[k]);
}

template <class T, int N>
inline Dual<T, N> select(MaskOf<T> m, const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> r;
  r.v = select(m, a.v, b.v);
  for (int k = 0; k < N; ++k) r.d[k] = select(m, a.d[k], b.d[k]);
  return r;
}
template <class T, int N>
inline Dual<T, N> select(MaskOf<T> m, const Dual<T, N>& a, double b) {
  return select(m, a, Dual<T, N>(b));
}
template <class T, int N>
inline Dual<T, N> select(MaskOf<T> m, double a, const Dual<T, N>& b) {
  return select(m, Dual<T, N>(a), b);
}

// Of equal arguments the second is the minimum, as for Lanes, but the first is the maximum: laws write
// max(x, 0) + min(x, 0), which must keep the derivative of x where x is zero.
template <class T, int N>
inline Dual<T, N> min(const Dual<T, N>& a, const Dual<T, N>& b) {
  return select(a.v < b.v, a, b);
}
template <class T, int N>
inline Dual<T, N> max(const Dual<T, N>& a, const Dual<T, N>& b) {
  return select(a.v >= b.v, a, b);
}
template <class T, int N>
inline Dual<T, N> min(const Dual<T, N>& a, double b) {
  return min(a, Dual<T, N>(b));
}
template <class T, int N>
inline Dual<T, N> max(const Dual<T, N>& a, double b) {
  return max(a, Dual<T, N>(b));
}
template <class T, int N>
inline Dual<T, N> abs(const Dual<T, N>& a) {
  return select(a.v < 0.0, -a, a);
}
template <class T, int N>
inline Dual<T, N> floor(const Dual<T, N>& a) {
  return floor(a.v);
}

template <class T, int N>
inline Dual<T, N> sqrt(const Dual<T, N>& a) {
  const T root = sqrt(a.v);
  return a.chain(root, select(root > 0.0, 0.5 / root, T(0.0)));
}
template <class T, int N>
inline Dual<T, N> exp(const Dual<T, N>& a) {
  const T value = exp(a.v);
  return select(value > 0.0, a.chain(value, value), Dual<T, N>(value));
}
template <class T, int N>
inline Dual<T, N> log(const Dual<T, N>& a) {
  return a.chain(log(a.v), 1.0 / a.v);
}
/// For x >= 0.
template <class T, int N>
inline Dual<T, N> pow(const Dual<T, N>& x, double y) {
  const T value = pow(x.v, y);
  return x.chain(value, select(x.v > 0.0, y * value / x.v, T(y == 1 ? 1.0 : 0.0)));
}
template <class T, int N>
inline Dual<T, N> pow(const Dual<T, N>& x, const Dual<T, N>& y) {
  const T value = pow(x.v, y.v), per_x = y.v * value / x.v, per_y = value * log(x.v);
  const MaskOf<T> regular = x.v > 0.0;
  Dual<T, N> r;
  r.v = value;
  for (int k = 0; k < N; ++k) r.d[k] = select(regular, per_x * x.d[k] + per_y * y.d[k], T(0.0));
  return r;
}

/// The number as an X: its value alone where X carries no derivatives.
template <class X, class T>
inline X as(const T& x) {
  if constexpr (derivatives_of<X> == 0 && derivatives_of < T >> 0)
    return x.v;
  else
    return x;
}

/// The derivatives of a root x of f(x) = 0 that was found by iteration (implicit function theorem): `f` is
/// evaluated at the root without its derivatives, `slope` is -df/dx there.
template <class T, int N>
inline Dual<T, N> implicit_root(const Dual<T, N>& x, const Dual<T, N>& f, const Dual<T, N>& slope) {
  return f.chain(x.v, 1.0 / slope.v);
}

}  // namespace mpm::core
