// How long a test goes on.
#pragma once

#include <algorithm>

namespace mpm::tests {

/// Whether this build's tests are brief (MPM_BRIEF_TESTS): what another build tests with each of several
/// methods is then tested with one after the other in turns.
#ifdef MPM_BRIEF_TESTS
inline constexpr bool brief_tests = true;
#else
inline constexpr bool brief_tests = false;
#endif

/// `steps`, or at most four in a build whose tests are brief (MPM_BRIEF_TESTS).
constexpr int brief(int steps) { return brief_tests ? std::min(steps, 4) : steps; }

}  // namespace mpm::tests
