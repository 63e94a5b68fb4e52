// Random numbers of a particle: drawn from its identity alone, so that a run is reproducible on any number of
// ranks. Shown by tests/physics/gurson_test.cpp.
#pragma once

#include <cstdint>

#include "core/random/normal.hpp"
#include "core/simd/lanes.hpp"

namespace mpm::physics {

/// Standard normal.
inline double normal_deviate(double identity) {
  constexpr std::uint64_t seed = 0x506f726f73697479;  // arbitrary; fixed, so that a case is reproducible
  return core::standard_normal(static_cast<std::uint64_t>(identity), 0, seed);
}
template <int L>
core::Lanes<L> normal_deviate(core::Lanes<L> identity) {
  core::Lanes<L> all(0.0);
  for (int i = 0; i < L; ++i) all.set(i, normal_deviate(identity[i]));
  return all;
}

}  // namespace mpm::physics
