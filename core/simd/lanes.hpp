// A short vector of doubles: the value type of every hot kernel and every batched law.
//
// Code is written once as `template <class T>` over T = double (the readable reference) or T = Lanes<L>.
// Lanes wraps the vector extension of g++ and clang, so any width compiles on any machine; the width that
// suits the machine is chosen at configure time (MPM_SIMD_LANES).
// Every operation acts on each lane alone: a particle's result never depends on its neighbours in the vector,
// so results do not depend on where a particle is stored.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace mpm::core {

/// Doubles per particle block; every column of a block is one cache line.
inline constexpr int block_lanes = 8;

#ifndef MPM_SIMD_LANES
#define MPM_SIMD_LANES 8
#endif

namespace detail {
// Written out per width: the attribute does not take a size that depends on a template parameter everywhere.
template <int L>
struct Vector;
template <>
struct Vector<2> {
  typedef double real __attribute__((vector_size(16)));
  typedef std::int64_t bits __attribute__((vector_size(16)));
};
template <>
struct Vector<4> {
  typedef double real __attribute__((vector_size(32)));
  typedef std::int64_t bits __attribute__((vector_size(32)));
};
template <>
struct Vector<8> {
  typedef double real __attribute__((vector_size(64)));
  typedef std::int64_t bits __attribute__((vector_size(64)));
};
typedef long long Long8 __attribute__((vector_size(64)));  // as the compilers' built-ins require
}  // namespace detail

/// Comparison result: all bits of a lane set where true.
template <int L>
struct LaneMask {
  using vector = typename detail::Vector<L>::bits;
  vector v;
  friend LaneMask operator&(LaneMask a, LaneMask b) { return {a.v & b.v}; }
  friend LaneMask operator|(LaneMask a, LaneMask b) { return {a.v | b.v}; }
  friend LaneMask operator!(LaneMask a) { return {~a.v}; }
  bool operator[](int i) const { return v[i] != 0; }
};

template <int L>
struct Lanes {
  using vector = typename detail::Vector<L>::real;
  using Mask = LaneMask<L>;
  vector v;

  Lanes() = default;
  Lanes(vector x) : v(x) {}
  Lanes(double x) : v(x - vector{}) {}  // broadcast; x - 0 keeps every bit, also of -0

  double operator[](int i) const { return v[i]; }
  void set(int i, double x) { v[i] = x; }

  friend Lanes operator+(Lanes a, Lanes b) { return a.v + b.v; }
  friend Lanes operator-(Lanes a, Lanes b) { return a.v - b.v; }
  friend Lanes operator*(Lanes a, Lanes b) { return a.v * b.v; }
  friend Lanes operator/(Lanes a, Lanes b) { return a.v / b.v; }
  friend Lanes operator-(Lanes a) { return -a.v; }
  Lanes& operator+=(Lanes b) {
    v += b.v;
    return *this;
  }
  Lanes& operator-=(Lanes b) {
    v -= b.v;
    return *this;
  }
  Lanes& operator*=(Lanes b) {
    v *= b.v;
    return *this;
  }
  Lanes& operator/=(Lanes b) {
    v /= b.v;
    return *this;
  }

  friend Mask operator<(Lanes a, Lanes b) { return {a.v < b.v}; }
  friend Mask operator<=(Lanes a, Lanes b) { return {a.v <= b.v}; }
  friend Mask operator>(Lanes a, Lanes b) { return {a.v > b.v}; }
  friend Mask operator>=(Lanes a, Lanes b) { return {a.v >= b.v}; }
  friend Mask operator==(Lanes a, Lanes b) { return {a.v == b.v}; }
  friend Mask operator!=(Lanes a, Lanes b) { return {a.v != b.v}; }
};

/// Value type of a block's column: its width, and its mask.
template <class T>
struct LaneTraits {
  static constexpr int width = 1;
  using Mask = bool;
};
template <int L>
struct LaneTraits<Lanes<L>> {
  static constexpr int width = L;
  using Mask = typename Lanes<L>::Mask;
};
template <class T>
using MaskOf = typename LaneTraits<T>::Mask;

namespace detail {
template <int L>
struct RealOf {
  using type = Lanes<L>;
};
template <>
struct RealOf<1> {
  using type = double;
};
}  // namespace detail

/// The value type of the production kernels.
using Real = detail::RealOf<MPM_SIMD_LANES>::type;
inline constexpr int real_width = LaneTraits<Real>::width;

// --- memory: unaligned access costs nothing on aligned data, and scratch arrays need no alignment ---------
template <class T>
inline T load(const double* p) {
  static_assert(sizeof(T) == LaneTraits<T>::width * sizeof(double));
  T x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
template <class T>
inline void store(double* p, T x) {
  static_assert(sizeof(T) == LaneTraits<T>::width * sizeof(double));
  std::memcpy(p, &x, sizeof x);
}

// --- the scalar instances ---------------------------------------------------------------------------------
inline double select(bool m, double a, double b) { return m ? a : b; }
inline bool any(bool m) { return m; }
inline bool all(bool m) { return m; }
inline bool test(bool m, int) { return m; }
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
using std::abs;
using std::cos;
using std::exp;
using std::floor;
using std::log;
using std::pow;
using std::sin;
using std::sqrt;

// --- the vector instances ---------------------------------------------------------------------------------
template <int L>
inline Lanes<L> select(LaneMask<L> m, Lanes<L> a, Lanes<L> b) {
  return m.v ? a.v : b.v;
}
template <int L>
inline Lanes<L> select(LaneMask<L> m, Lanes<L> a, double b) {
  return select(m, a, Lanes<L>(b));
}
template <int L>
inline Lanes<L> select(LaneMask<L> m, double a, Lanes<L> b) {
  return select(m, Lanes<L>(a), b);
}
template <int L>
inline Lanes<L> select(LaneMask<L> m, double a, double b) {
  return select(m, Lanes<L>(a), Lanes<L>(b));
}
template <int L>
inline bool test(LaneMask<L> m, int lane) {
  return m[lane];
}
/// One bit per lane, lane 0 lowest. Machine-specific, because neither compiler finds the single instruction
/// for it.
template <int L>
inline unsigned bits(LaneMask<L> m) {
#if defined(__AVX512DQ__)
  if constexpr (L == 8) return __builtin_ia32_cvtq2mask512(reinterpret_cast<detail::Long8>(m.v));
#endif
#if defined(__AVX__)
  if constexpr (L == 4)
    return static_cast<unsigned>(__builtin_ia32_movmskpd256(reinterpret_cast<detail::Vector<4>::real>(m.v)));
  if constexpr (L == 8) {
    return bits(LaneMask<4>{__builtin_shufflevector(m.v, m.v, 0, 1, 2, 3)}) |
           bits(LaneMask<4>{__builtin_shufflevector(m.v, m.v, 4, 5, 6, 7)}) << 4;
  }
#endif
#if defined(__SSE2__)
  if constexpr (L == 2)
    return static_cast<unsigned>(__builtin_ia32_movmskpd(reinterpret_cast<detail::Vector<2>::real>(m.v)));
#endif
  unsigned r = 0;
  for (int i = 0; i < L; ++i) r |= static_cast<unsigned>(m.v[i] != 0) << i;
  return r;
}
template <int L>
inline bool any(LaneMask<L> m) {
  return bits(m) != 0;
}
template <int L>
inline bool all(LaneMask<L> m) {
  return bits(m) == (1u << L) - 1;
}
template <int L>
inline Lanes<L> min(Lanes<L> a, Lanes<L> b) {
#if defined(__AVX512F__) && !defined(__clang__)
  // g++ reverses a comparison with a constant and then finds no instruction for it.
  if constexpr (L == 8) return __builtin_ia32_minpd512_mask(a.v, b.v, a.v, -1, 4);
#endif
  return a.v < b.v ? a.v : b.v;
}
template <int L>
inline Lanes<L> max(Lanes<L> a, Lanes<L> b) {
#if defined(__AVX512F__) && !defined(__clang__)
  if constexpr (L == 8) return __builtin_ia32_maxpd512_mask(a.v, b.v, a.v, -1, 4);
#endif
  return a.v > b.v ? a.v : b.v;
}
template <int L>
inline Lanes<L> min(Lanes<L> a, double b) {
  return min(a, Lanes<L>(b));
}
template <int L>
inline Lanes<L> max(Lanes<L> a, double b) {
  return max(a, Lanes<L>(b));
}
template <int L>
inline Lanes<L> abs(Lanes<L> a) {
  using Bits = typename detail::Vector<L>::bits;
  return (typename Lanes<L>::vector)((Bits)a.v & INT64_MAX);
}

namespace detail {
template <int L, class F>
inline Lanes<L> lanewise(Lanes<L> a, F f) {
  for (int i = 0; i < L; ++i) a.v[i] = f(a.v[i]);
  return a;
}
}  // namespace detail

// g++ compiles these loops over eight lanes to two halves, which it stores and reads back as one vector. The
// load waits until both stores have completed: 40 % of the time to locate a block's particles.
template <int L>
inline Lanes<L> sqrt(Lanes<L> a) {
#if defined(__AVX512F__) && !defined(__clang__)
  if constexpr (L == 8) return __builtin_ia32_sqrtpd512_mask(a.v, a.v, -1, 4);
#endif
  return detail::lanewise(a, [](double x) { return std::sqrt(x); });
}
template <int L>
inline Lanes<L> floor(Lanes<L> a) {
#if defined(__AVX512F__) && !defined(__clang__)
  constexpr int downward = 9;  // and without exceptions
  if constexpr (L == 8) return __builtin_ia32_rndscalepd_mask(a.v, downward, a.v, -1, 4);
#endif
  return detail::lanewise(a, [](double x) { return std::floor(x); });
}

}  // namespace mpm::core
