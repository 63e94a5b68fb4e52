// The cells that hold particles at the beginning of a step: for every brick, its own and one layer around it
// (core/grid/cells_around.hpp), stored in the grid; where components have velocity fields of their own
// (contact), also those of each field. A brick's 64 cells are the bits of a word; other ranks get them as a
// nodal field, in the record of each cell's lowest node. In scenes of several materials cells are weighted by
// density (core/shape/ddmp.hpp), or those beside much lighter ones are found (core/shape/linear.hpp).
#pragma once

#include <array>
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

/// What of the cells: whether they hold particles, and in scenes of several materials their weights in means;
/// or which of them are beside lighter ones.
enum class CellUse { means, lighter };

class CellsInUse {
 public:
  /// `without`: bodies that use no cells.
  CellsInUse(Model& model, NodeHalo& halo, CellUse use, std::vector<int> without = {});

  /// Finds the cells of the bricks; when it returns, the exchange is in progress. Collective.
  void find();
  /// Completes the exchange, and combines the cells of neighbours. Collective.
  void finish_exchange();

 private:
  using Cells = std::uint64_t;
  /// By the number of the cell's bit; 0: not in use.
  using Weights = std::array<double, brick_cells * brick_cells * brick_cells>;
  void find_own(Slot s);
  void find_field(Slot s, int field, std::int32_t component);
  template <class F>
  void for_each_density(Slot s, std::int32_t component, F f) const;
  Weights find_heaviest(Slot s, std::int32_t component) const;
  Weights find_lightest(Slot s, std::int32_t component, Weights& heaviest) const;
  void take(Slot s, int field, const Weights& found);
  void write_to_nodes(Slot s);
  void read_from_nodes(Slot s);
  Cells& cells(Slot s, int field) { return cells_[model_.grid->field_index(s, field)]; }
  template <class F>
  void for_fields_of(Slot s, std::int32_t component, F f) const;
  Cells cells_of(Slot s, std::int32_t component) const;
  double weight_of(Slot s, std::int32_t component, std::size_t cell) const;
  bool weigh_alike(const Brick& brick, std::int32_t component) const;
  void combine(Slot s, std::int32_t component, CellsAround& around, CellWeightsAround* weights) const;
  void collect(Slot s, std::int32_t component, CellsAround& around, CellWeightsAround* weights) const;
  Cells find_beside_lighter(Slot s, std::int32_t component) const;

  Model& model_;
  NodeHalo& halo_;
  const std::vector<int> without_;
  const CellUse use_;
  const bool weighs_;              ///< cells, in a scene of several materials
  const double largest_weight_;    ///< a tenth of the bodies' largest density of reference; lighter: infinite
  const double empty_density_;     ///< lighter: as which cells without particles count; or 0
  std::vector<Cells> cells_;       ///< by BrickGrid::field_index()
  std::vector<Weights> weights_;   ///< alike, where it weighs them: in means; lighter: the least densities
  std::vector<Weights> heaviest_;  ///< lighter: the largest densities; of owned bricks
  static constexpr double several = -1;
  std::vector<double> common_weight_;  ///< of all cells in use of a field; 0: none; or several
};

/// Densities of a cell and of one beside it differ much where their ratio exceeds this.
inline constexpr double much_lighter = 10;

/// Null for shape functions that do not depend on which cells are in use, and where none can be much lighter
/// than another one.
std::unique_ptr<CellsInUse> make_cells_in_use(Model& model, NodeHalo& halo, std::vector<int> without = {});

}  // namespace mpm::core
