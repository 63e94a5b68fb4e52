// Software prefetches, a few cache lines at a time: the processor supports few outstanding requests, and
// further ones stall.
#pragma once

#include "core/simd/lanes.hpp"

namespace mpm::core {

/// A memory range that will be needed soon.
struct PrefetchLines {
  const double* next = nullptr;
  const double* last = nullptr;
  /// Requests the next `lines` cache lines, into the second-level cache. Always inlined: g++ considers a
  /// function that only prefetches free of effects and drops the call.
  template <bool to_write = false>
  [[gnu::always_inline]] void request(int lines) {
    for (int i = 0; i < lines && next < last; ++i, next += block_lanes)
      __builtin_prefetch(next, to_write ? 1 : 0, 2);
  }
};

}  // namespace mpm::core
