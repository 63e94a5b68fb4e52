// Memory use of the ranks.
#pragma once

#include <cstdint>

#include "core/communication/reductions.hpp"

namespace mpm::io {

/// Peak memory of the ranks in bytes.
struct MemoryUse {
  std::int64_t largest = 0;  ///< of any rank
  std::int64_t sum = 0;      ///< over the ranks
};

/// Peak resident memory up to now. Collective.
MemoryUse peak_memory(core::Reductions& ranks);

}  // namespace mpm::io
