// Software prefetches, a few cache lines at a time: the processor has only so many requests under way, and
// what asks for more at once waits.
#pragma once

#include "core/simd/lanes.hpp"

namespace mpm::core {

/// A stretch of memory that will be wanted soon.
struct PrefetchLines {
  const double* next = nullptr;
  const double* last = nullptr;
  /// Request the next `lines` cache lines, into the second-level cache. Inlined without fail: g++ takes a
  /// function that only prefetches for one that does nothing, and drops the call.
  template <bool to_write = false>
  [[gnu::always_inline]] void request(int lines) {
    for (int i = 0; i < lines && next < last; ++i, next += block_lanes)
      __builtin_prefetch(next, to_write ? 1 : 0, 2);
  }
};

}  // namespace mpm::core
