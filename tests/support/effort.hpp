// How long a test goes on.
#pragma once

#include <algorithm>

namespace mpm::tests {

/// `steps`, or four under the address sanitizer: it makes a step 20 times slower, and what it looks for shows
/// in the first ones.
constexpr int brief(int steps) {
#ifdef __SANITIZE_ADDRESS__
  return std::min(steps, 4);
#else
  return steps;
#endif
}

}  // namespace mpm::tests
