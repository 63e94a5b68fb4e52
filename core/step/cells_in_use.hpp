// The cells that hold particles at the beginning of a step: for every brick, its own and one layer around it
// (core/grid/cells_around.hpp), stored in the grid; where components have velocity fields of their own
// (contact), also those of each field. A brick's 64 cells are the bits of a word; other ranks get them as a
// nodal field, in the record of each cell's lowest node. In scenes of several materials cells are weighted by
// density (core/shape/ddmp.hpp), or those beside much lighter ones are found (core/shape/linear.hpp).
#pragma once

#include <algorithm>
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

/// What shape functions need to know of the cells.
struct CellNeeds {
  bool use = false;      ///< which hold particles
  bool weights = false;  ///< in means over cells
  bool lighter = false;  ///< which are beside much lighter ones
};

class CellsInUse {
 public:
  /// `without`: bodies that use no cells.
  CellsInUse(Model& model, NodeHalo& halo, CellNeeds needs, std::vector<int> without = {});

  /// Finds the cells of the bricks; when it returns, the exchange is in progress. Collective.
  void find();
  /// Completes the exchange, and combines the cells of neighbours. Collective.
  void finish_exchange();

 private:
  using Cells = std::uint64_t;
  /// Of a field's particles in each cell, by the number of its bit; 0: not in use.
  struct Densities {
    std::array<double, brick_cells * brick_cells * brick_cells> thinnest{}, densest{};
  };
  /// Of a field's cells in use; 0 if there are none.
  struct Range {
    double thinnest = 0, densest = 0;
    double weight = 0;  ///< of all of them; or `several`
  };
  static constexpr double several = -1;

  bool has_densities() const { return needs_.weights || needs_.lighter; }
  void find_own(Slot s);
  void find_field(Slot s, int field, std::int32_t component);
  Densities find_densities(Slot s, std::int32_t component) const;
  void take(Slot s, int field, const Densities& found);
  void write_to_nodes(Slot s);
  void read_from_nodes(Slot s);
  Cells& cells(Slot s, int field) { return cells_[model_.grid->field_index(s, field)]; }
  template <class F>
  void for_fields_of(Slot s, std::int32_t component, F f) const;
  Cells cells_of(Slot s, std::int32_t component) const;
  double thinnest_of(Slot s, std::int32_t component, std::size_t cell) const;
  double densest_of(Slot s, std::int32_t component, std::size_t cell) const;
  double weight_of(double density) const { return std::min(density, largest_weight_); }
  bool weigh_alike(const Brick& brick, std::int32_t component) const;
  void combine(Slot s, std::int32_t component, CellsAround& around, CellWeightsAround* weights) const;
  void combine_use(Slot s, std::int32_t component, CellsAround& around, CellWeightsAround* weights) const;
  template <class F>
  void collect(Slot s, std::int32_t component, CellsAround& around, CellWeightsAround* values, F value) const;
  Cells find_beside_lighter(Slot s, std::int32_t component) const;

  Model& model_;
  NodeHalo& halo_;
  const std::vector<int> without_;
  const CellNeeds needs_;
  const double largest_weight_;       ///< a tenth of the bodies' largest density of reference
  const double empty_density_;        ///< of cells without particles, where these count; or 0
  std::vector<Cells> cells_;          ///< by BrickGrid::field_index()
  std::vector<Densities> densities_;  ///< alike, where they are needed
  std::vector<Range> ranges_;         ///< alike
};

/// Densities of a cell and of one beside it differ much where their ratio exceeds this.
inline constexpr double much_lighter = 10;

/// Null for shape functions that do not depend on which cells are in use, and where none can be much lighter
/// than another one.
std::unique_ptr<CellsInUse> make_cells_in_use(Model& model, NodeHalo& halo, std::vector<int> without = {});

}  // namespace mpm::core
