// Memory that the ranks have needed.
#pragma once

#include <cstdint>

#include "core/communication/reductions.hpp"

namespace mpm::io {

/// Bytes, of the most that each rank has held at a time.
struct MemoryUse {
  std::int64_t largest = 0;  ///< of any rank
  std::int64_t sum = 0;      ///< over the ranks
};

/// Peak resident memory up to now. Collective.
MemoryUse peak_memory(core::Reductions& ranks);

}  // namespace mpm::io
