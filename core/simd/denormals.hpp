// Flushes numbers below 2^-1022 to zero. Ahead of a wave the stress falls by a factor per cell and step until
// it is that small, and operations on denormal numbers take a hundred times longer.
#pragma once

#include <bit>
#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace mpm::core {

/// For the calling thread, until it ends: results and operands.
inline void flush_denormals_to_zero() {
#if defined(__SSE2__)
  _mm_setcsr(_mm_getcsr() | 0x8040);  // FTZ and DAZ
#elif defined(__aarch64__)
  std::uint64_t control = 0;
  asm volatile("mrs %0, fpcr" : "=r"(control));
  asm volatile("msr fpcr, %0" : : "r"(control | (std::uint64_t{1} << 24)));
#endif
}

/// Whether flush_denormals_to_zero() would make the number 0; correct before and after that call.
inline bool is_subnormal(double x) {
  constexpr std::uint64_t exponent = 0x7FF0000000000000, mantissa = 0x000FFFFFFFFFFFFF;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  return (bits & exponent) == 0 && (bits & mantissa) != 0;
}

}  // namespace mpm::core
