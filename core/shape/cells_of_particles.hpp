// The cells of a brick that hold particles, for shape functions that depend on them (ddmp.hpp).
#pragma once

#include <cstdint>
#include <cstring>

#include "core/shape/linear.hpp"

namespace mpm::core {

class CellsOfParticles {
 public:
  /// The particles in these lanes of a block, which lie in the brick.
  [[gnu::always_inline]] void add(const BrickFrame& frame, const ColumnLayout& layout, const double* block,
                                  unsigned lanes) {
    const double* x = block + layout.offset(Column::position_x);
    const auto p =
        locate_in_sites<Lanes<block_lanes>, brick_cells>(frame, x, x + block_lanes, x + 2 * block_lanes);
    typedef int Numbers __attribute__((vector_size(block_lanes * sizeof(int))));
    Numbers cell;
    std::memcpy(&cell, p.node, sizeof cell);
    constexpr Wide lane_numbers = {0, 1, 2, 3, 4, 5, 6, 7};
    const Wide one = (Wide{} + std::int64_t{lanes}) >> lane_numbers & 1;
    of_lanes_ |= one << __builtin_convertvector(cell, Wide);
  }
  /// Cell (i, j, k) in bit i + 4 j + 16 k.
  std::uint64_t cells() const {
    std::int64_t cells = 0;
    for (int l = 0; l < block_lanes; ++l) cells |= of_lanes_[l];
    return static_cast<std::uint64_t>(cells);
  }

 private:
  using Wide = LaneMask<block_lanes>::vector;
  Wide of_lanes_{};
};

/// The bit of the cell of one particle at x in the brick.
inline std::uint64_t cell_of(const BrickFrame& frame, const double* x) {
  return std::uint64_t{1} << locate_in_sites<double, brick_cells>(frame, x, x + 1, x + 2).node[0];
}

}  // namespace mpm::core
