// The cells that hold particles at the beginning of a step: for every brick, its own and one layer around it
// (core/grid/cells_around.hpp), stored in the grid. A brick's 64 cells are the bits of a word; other ranks
// get them as a nodal field, in the record of each cell's lowest node.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/communication/node_halo.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// The cells that hold a brick's particles, (i, j, k) in bit i + 4 j + 16 k.
std::uint64_t find_cells(const Model& model, Slot s);

class CellsInUse {
 public:
  CellsInUse(Model& model, NodeHalo& halo) : model_(model), halo_(halo) {}

  /// Finds the cells of the bricks; when it returns, the exchange is in progress. Collective.
  void find();
  /// Completes the exchange, and combines the cells of neighbours. Collective.
  void finish_exchange();

 private:
  using Cells = std::uint64_t;
  void write_to_nodes(Slot s);
  Cells read_from_nodes(Slot s) const;
  void combine(Slot s);

  Model& model_;
  NodeHalo& halo_;
  std::vector<Cells> cells_;  ///< by slot, ghosts included
};

/// Null for shape functions that do not depend on which cells are in use.
std::unique_ptr<CellsInUse> make_cells_in_use(Model& model, NodeHalo& halo);

}  // namespace mpm::core
