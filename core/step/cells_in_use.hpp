// The cells that hold particles at the beginning of a step: for every brick, its own and one layer around it
// (core/grid/cells_around.hpp), stored in the grid; where components have velocity fields of their own
// (contact), also those of each field. A brick's 64 cells are the bits of a word; other ranks get them as a
// nodal field. In scenes of several materials cells are weighted by density (core/shape/ddmp.hpp), and those
// beside much lighter ones are found (core/shape/linear.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
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

/// Densities of a cell and of one beside it differ much where their ratio exceeds this.
inline constexpr double much_lighter = 10;

/// What shape functions need to know of the cells.
struct CellNeeds {
  bool use = false;      ///< which hold particles
  bool weights = false;  ///< in means over cells
  bool lighter = false;  ///< which are beside much lighter ones, by densities of reference
  bool densities() const { return weights || lighter; }
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
  using OfCells = std::array<double, brick_cells * brick_cells * brick_cells>;
  struct Found {
    OfCells weight{};               ///< in means over cells
    OfCells thinnest{}, densest{};  ///< densities of reference; the latter of owned bricks
  };
  /// Densities of reference of a brick's particles.
  struct Range {
    double thinnest = std::numeric_limits<double>::infinity(), densest = 0;
    void include(const Range& other) {
      thinnest = std::min(thinnest, other.thinnest);
      densest = std::max(densest, other.densest);
    }
    bool differs_much() const { return densest > much_lighter * thinnest; }
  };
  static constexpr double several = -1;

  NodeFields exchanged() const;
  void find_own(Slot s);
  void find_field(Slot s, int field, std::int32_t component);
  Range range_of(Slot s) const;
  bool may_be_beside_lighter(Slot s) const;
  Found find_densities(Slot s, std::int32_t component) const;
  void take(std::size_t at, const Found& found);
  void clear_nodes(Slot s);
  void write_to_nodes(Slot s);
  void read_from_nodes(Slot s);
  Cells& cells(Slot s, int field) { return cells_[model_.grid->field_index(s, field)]; }
  template <class F>
  void for_fields_of(Slot s, std::int32_t component, F f) const;
  Cells cells_of(Slot s, std::int32_t component) const;
  double largest_of(const OfCells Found::*what, Slot s, std::int32_t component, std::size_t cell) const;
  double thinnest_of(Slot s, std::int32_t component, std::size_t cell) const;
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
  const double largest_weight_;        ///< a tenth of the bodies' largest density of reference
  const double empty_density_;         ///< of cells without particles, where these count; or 0
  std::vector<Cells> cells_;           ///< by BrickGrid::field_index()
  std::vector<Found> found_;           ///< alike, where more is needed
  std::vector<double> common_weight_;  ///< alike, of all cells in use of a field; 0: none; or several
  std::vector<Range> ranges_;          ///< by owned slot
};

/// Null for shape functions that do not depend on which cells are in use, and where none can be much lighter
/// than another one.
std::unique_ptr<CellsInUse> make_cells_in_use(Model& model, NodeHalo& halo, std::vector<int> without = {});

}  // namespace mpm::core
