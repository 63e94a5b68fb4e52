#pragma once
// Upper limits of a scene, used by the reader, the programs and the set-up.

#include <cstdint>

namespace mpm::core {

/// Bricks have four cells per axis, and coordinates of 21 bits, of which 20 are used.
inline constexpr std::int64_t most_cells_per_axis = std::int64_t{4} << 20;

/// Threads per rank; with very many the system terminates the program.
inline constexpr int most_threads = 1024;

}  // namespace mpm::core
