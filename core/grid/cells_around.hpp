// Which of the cells in a brick and one layer around it are in use, for shape functions that need to know
// (core/shape/ddmp.hpp, and core/shape/linear.hpp where densities differ much).
#pragma once

#include <array>
#include <cstdint>

#include "core/grid/brick.hpp"

namespace mpm::core {

/// A value of each of the cells around a brick, such as its weight in means; 0 of those that are not in use.
struct CellWeightsAround {
  static constexpr int side = brick_cells + 2, row_doubles = 8;
  alignas(64) double row[side * side][row_doubles] = {};  ///< cell i in double i + 1
};

/// Cells (i, j, k), -1 .. brick_cells, counted from the brick's first. Its own cells are in use where they
/// hold particles, as are those of its neighbours; beyond a constrained face of the grid, the mirror images
/// of cells in use. All weigh 1 in means, or what `weights` holds. For shape functions that need the lighter
/// cells alone none is in use.
class CellsAround {
 public:
  static constexpr int side = CellWeightsAround::side;

  bool has(int i, int j, int k) const { return (row(j, k) >> (i + 1) & 1) != 0; }
  void add(int i, int j, int k) { row_[index(j, k)] |= static_cast<std::uint8_t>(1u << (i + 1)); }
  /// Cells by bits, as row() returns them.
  void add_row(int j, int k, unsigned cells) { row_[index(j, k)] |= static_cast<std::uint8_t>(cells); }
  void add_all() { row_ = all_; }
  /// Cell i of the row in bit i + 1.
  unsigned row(int j, int k) const { return row_[index(j, k)]; }
  double weight(int i, int j, int k) const {
    if (!has(i, j, k)) return 0;
    return weights == nullptr ? 1 : weights->row[index(j, k)][i + 1];
  }
  /// Of the eight cells around point (i, j, k), the lowest one of cell (i, j, k).
  double weight_beside(int i, int j, int k) const {
    double sum = 0;
    for (int c = 0; c < 8; ++c) sum += weight(i - (c & 1), j - (c >> 1 & 1), k - (c >> 2));
    return sum;
  }
  /// All cells, and all alike: in bricks far from the body's surface.
  bool full() const { return weights == nullptr && row_ == all_; }

  static constexpr std::size_t index(int j, int k) {
    return static_cast<std::size_t>(j + 1 + side * (k + 1));
  }
  const CellWeightsAround* weights = nullptr;
  /// Of the brick's own cells, those beside a much lighter one, by the bits of core/step/cells_in_use.hpp.
  std::uint64_t beside_lighter = 0;

 private:
  using Rows = std::array<std::uint8_t, side * side>;
  static constexpr Rows all_ = [] {
    Rows rows{};
    for (std::uint8_t& row : rows) row = (1u << side) - 1;
    return rows;
  }();
  Rows row_{};
};

}  // namespace mpm::core
