// Numbers below 2^-1022 count as zero. Ahead of a wave a stress falls by a factor per cell and step until it
// is that small, and the processor then takes a hundred times longer for each operation on it.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <cstdint>
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

}  // namespace mpm::core
