#pragma once
// Upper limits of a scene, used by the reader, the programs and the set-up.

#include <cstdint>

namespace mpm::core {

/// Bricks of four cells, whose coordinates have 21 bits, one of them spare.
inline constexpr std::int64_t most_cells_per_axis = std::int64_t{4} << 20;

/// Threads per rank; with very many the system ends the program.
inline constexpr int most_threads = 1024;

}  // namespace mpm::core
