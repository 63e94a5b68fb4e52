// What shape functions report about the particles' domains, in particles times steps.
#pragma once

#include <cstdint>

namespace mpm::core {

struct DomainCounts {
  std::int64_t wide = 0;     ///< larger than their support, evaluated with a smaller size
  std::int64_t tangled = 0;  ///< without a positive volume at a corner, replaced by another one
  DomainCounts& operator+=(const DomainCounts& more) {
    wide += more.wide;
    tangled += more.tangled;
    return *this;
  }
};

}  // namespace mpm::core
