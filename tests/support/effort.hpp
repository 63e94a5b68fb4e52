// How long a test goes on.
#pragma once

#include <algorithm>

namespace mpm::tests {

/// `steps`, or at most four in a build whose tests are brief (MPM_BRIEF_TESTS).
constexpr int brief(int steps) {
#ifdef MPM_BRIEF_TESTS
  return std::min(steps, 4);
#else
  return steps;
#endif
}

}  // namespace mpm::tests
