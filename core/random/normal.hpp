// Counter-based normal random numbers: as in philox.hpp, a pure function of the draw.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/random/philox.hpp"

namespace mpm::core {

/// Mean 0 and standard deviation 1, for the `item`-th draw of a kind (Box and Muller, Ann. Math. Stat. 29
/// (1958) 610).
inline double standard_normal(std::uint64_t item, std::uint32_t kind, std::uint64_t seed) {
  const auto [u, v] = uniform_pair(item, kind, seed);
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

}  // namespace mpm::core
