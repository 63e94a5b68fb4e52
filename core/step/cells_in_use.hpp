// The cells that hold particles at the beginning of a step: for every brick, its own and one layer around it
// (core/grid/cells_around.hpp), stored in the grid; where components have velocity fields of their own
// (contact), also those of each field. A brick's 64 cells are the bits of a word; other ranks get them as a
// nodal field, in the record of each cell's lowest node.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/communication/node_halo.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// The cells that hold a brick's particles of a component, (i, j, k) in bit i + 4 j + 16 k; of all bodies but
/// those of `without`.
std::uint64_t find_cells(const Model& model, Slot s, std::int32_t component = all_components,
                         std::span<const int> without = {});

class CellsInUse {
 public:
  /// `without`: bodies that use no cells.
  CellsInUse(Model& model, NodeHalo& halo, std::vector<int> without = {})
      : model_(model), halo_(halo), without_(std::move(without)) {}

  /// Finds the cells of the bricks; when it returns, the exchange is in progress. Collective.
  void find();
  /// Completes the exchange, and combines the cells of neighbours. Collective.
  void finish_exchange();

 private:
  using Cells = std::uint64_t;
  void find_own(Slot s);
  void write_to_nodes(Slot s);
  void read_from_nodes(Slot s);
  Cells& cells(Slot s, int field) { return cells_[model_.grid->field_index(s, field)]; }
  Cells cells_of(Slot s, std::int32_t component) const;
  void combine(Slot s, std::int32_t component, CellsAround& around) const;

  Model& model_;
  NodeHalo& halo_;
  const std::vector<int> without_;
  std::vector<Cells> cells_;  ///< by BrickGrid::field_index()
};

/// Null for shape functions that do not depend on which cells are in use.
std::unique_ptr<CellsInUse> make_cells_in_use(Model& model, NodeHalo& halo, std::vector<int> without = {});

}  // namespace mpm::core
