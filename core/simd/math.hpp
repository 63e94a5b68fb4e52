// exp, log and pow of Lanes, in plain vector arithmetic: no call per lane, no intrinsics, any width.
//
// Errors against the exact value (tests/core/simd/math_test.cpp): exp and log below 1.5 ulp, also for
// subnormal arguments and results; pow below 2.3e-16 (3 + 2 |y log x|) relative, enough for the laws'
// exponents. Special values: exp(-inf) = 0, exp(+inf) = inf, log(0) = -inf, log(x < 0) = NaN, log(inf) = inf,
// NaN stays NaN. pow is for x >= 0: pow(x, 0) = 1, pow(0, y > 0) = 0, pow(0, y < 0) = inf; a negative x gives
// NaN. The double instances are the C library's (core/simd/lanes.hpp).
#pragma once

#include <limits>

#include "core/simd/lanes.hpp"

namespace mpm::core {

namespace detail {

// ln 2 in two parts: a multiple of the first by a whole number below 2^11 is exact.
inline constexpr double ln2_high = 0x1.62e42fefap-1;
inline constexpr double ln2_low = 0x1.cf79abc9e3b3ap-40;
/// Adding it rounds to an integer, which is then in the low bits of the sum.
inline constexpr double round_magic = 0x1.8p52;

template <int L>
using Bits = typename Vector<L>::bits;

template <int L>
inline Bits<L> to_bits(Lanes<L> x) {
  return reinterpret_cast<Bits<L>>(x.v);
}
template <int L>
inline Lanes<L> from_bits(Bits<L> b) {
  return reinterpret_cast<typename Vector<L>::real>(b);
}

/// 2^n for integer n in [-1022, 1023].
template <int L>
inline Lanes<L> power_of_two(Lanes<L> n) {
  return from_bits<L>((to_bits<L>(n + round_magic) << 52) + (std::int64_t{1023} << 52));
}

}  // namespace detail

template <int L>
inline Lanes<L> exp(Lanes<L> x) {
  using namespace detail;
  // Beyond these bounds the result is 0 or infinity anyway, and n stays in range.
  const Lanes<L> held = min(max(x, -746.0), 710.0);
  const Lanes<L> n = (held * 0x1.71547652b82fep+0 + round_magic) - round_magic;
  const Lanes<L> r = (held - n * ln2_high) - n * ln2_low;  // |r| <= ln(2)/2
  // Taylor series to r^13/13!; the truncation error is below 5e-18. Summed in pairs of pairs to shorten the
  // dependence chain.
  const Lanes<L> r2 = r * r, r4 = r2 * r2;
  const Lanes<L> a = (1.0 / 2 + r * (1.0 / 6)) + r2 * (1.0 / 24 + r * (1.0 / 120));
  const Lanes<L> b = (1.0 / 720 + r * (1.0 / 5040)) + r2 * (1.0 / 40320 + r * (1.0 / 362880));
  const Lanes<L> c = (1.0 / 3628800 + r * (1.0 / 39916800)) + r2 * (1.0 / 479001600 + r * (1.0 / 6227020800));
  const Lanes<L> p = r2 * (a + r4 * (b + r4 * c)) + r + 1.0;
  // In two factors, so that results near the ends of the range overflow and underflow correctly.
  const Lanes<L> half = (0.5 * n + round_magic) - round_magic;
  const Lanes<L> result = p * power_of_two(half) * power_of_two(n - half);
  return select(x == x, result, x);
}

template <int L>
inline Lanes<L> log(Lanes<L> x) {
  using namespace detail;
  // Subnormal numbers are scaled up first; arguments without a logarithm are replaced by 1 and corrected at
  // the end.
  const auto tiny = x < std::numeric_limits<double>::min();
  const Lanes<L> y = select(x > 0.0, select(tiny, x * 0x1p54, x), 1.0);
  // x = 2^k m with m in [sqrt(1/2), sqrt(2)), so that k is 0 about x = 1.
  constexpr std::int64_t sqrt_half = 0x3fe6a09e667f3bcd;
  const Bits<L> shifted = to_bits(y) - sqrt_half;
  const Bits<L> exponent = shifted >> 52;
  const Lanes<L> m = from_bits<L>((shifted & 0x000fffffffffffff) + sqrt_half);
  const Lanes<L> k =
      from_bits<L>(exponent + 0x4338000000000000) - round_magic - select(tiny, 54.0, Lanes<L>(0.0));
  // log(1 + f) = 2 artanh(t) for t = f/(2 + f); in the form f - t (f - 2 t^2 (1/3 + t^2/5 + ...)) the leading
  // term is exact. t^2 < 0.0295: the relative truncation error is below 3e-18.
  const Lanes<L> f = m - 1.0;
  const Lanes<L> t = f / (2.0 + f);
  const Lanes<L> t2 = t * t;
  const Lanes<L> t4 = t2 * t2, t8 = t4 * t4;
  const Lanes<L> a = (2.0 / 3 + t2 * (2.0 / 5)) + t4 * (2.0 / 7 + t2 * (2.0 / 9));
  const Lanes<L> b = (2.0 / 11 + t2 * (2.0 / 13)) + t4 * (2.0 / 15 + t2 * (2.0 / 17));
  const Lanes<L> p = a + t8 * (b + t8 * (2.0 / 19 + t2 * (2.0 / 21)));
  Lanes<L> result = k * ln2_high + (f - (t * (f - p * t2) - k * ln2_low));
  constexpr double infinity = std::numeric_limits<double>::infinity();
  result = select(x == infinity, infinity, result);
  result = select(x == 0.0, -infinity, result);
  return select(x >= 0.0, result, std::numeric_limits<double>::quiet_NaN());
}

template <int L>
inline Lanes<L> pow(Lanes<L> x, Lanes<L> y) {
  return select(y == 0.0, 1.0, exp(y * log(x)));
}
template <int L>
inline Lanes<L> pow(Lanes<L> x, double y) {
  return pow(x, Lanes<L>(y));
}

}  // namespace mpm::core
