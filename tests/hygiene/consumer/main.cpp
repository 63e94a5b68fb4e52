// A user's program against an installed tree: prints the version that it was linked with.
#include <cstdio>

#include "core/version.hpp"

int main() {
  std::printf("mpm %s %s, %d lanes\n", mpm::core::version.data(), mpm::core::git_hash.data(), MPM_SIMD_LANES);
  return mpm::core::simd_lanes == MPM_SIMD_LANES ? 0 : 1;
}
