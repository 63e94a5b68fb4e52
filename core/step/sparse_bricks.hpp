// Bricks with few particles, of which clouds of debris consist: of their nodes only those that the particles
// reach are cleared, summed and updated, with the bits that they have in a full brick. Contributions to the
// other nodes stay zero, so that neighbours and other ranks need not know which these are.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

class SparseBricks {
 public:
  /// Most particles, of as many nodes along an axis, with which a brick is sparse: those that reach half of its
  /// nodes where they share none. Beyond it all rows, with those that bricks have in common carried along, are
  /// summed as fast.
  static constexpr int most_particles(const NodeBlockShape& shape, int nodes_per_axis) {
    return shape.nodes() / (2 * nodes_per_axis * nodes_per_axis * nodes_per_axis);
  }

  /// Before the first map of a step.
  void begin_step(const BrickGrid& grid) {
    const auto owned = static_cast<std::size_t>(grid.owned());
    if (revision_ == grid.revision() && reached_.size() == owned) return;
    revision_ = grid.revision();
    reached_.assign(owned, {});
    for (std::vector<Nodes>& of_array : written_) of_array.assign(owned, {});
  }
  /// The nodes that the particles of a brick reach in this step; null: all of them.
  const NodeMask* reached(Slot s) const {
    const Nodes& nodes = reached_[static_cast<std::size_t>(s)];
    return nodes.all ? nullptr : &nodes.some;
  }
  void set_all(Slot s) { reached_[static_cast<std::size_t>(s)].all = true; }
  /// No nodes so far.
  NodeMask& set_some(Slot s) { return (reached_[static_cast<std::size_t>(s)] = {false, {}}).some; }

  /// Clears the contributions to the nodes of a brick before particles add to those reached; `width`: doubles
  /// of a record.
  void clear(NodeArray of, const NodeBlockShape& shape, Slot s, int width, double* contributions) {
    Nodes& written = written_[static_cast<std::size_t>(of)][static_cast<std::size_t>(s)];
    const Nodes& reached = reached_[static_cast<std::size_t>(s)];
    if (written.all || reached.all) {
      std::fill_n(contributions, width * shape.nodes(), 0.0);
    } else {
      written.some.for_each(
          shape, [&](int first, int count) { std::fill_n(contributions + width * first, width * count, 0.0); });
    }
    written = reached;
  }

 private:
  struct Nodes {
    bool all = true;
    NodeMask some;
  };
  std::uint64_t revision_ = 0;                        ///< of the grid
  std::vector<Nodes> reached_;                        ///< by slot
  std::array<std::vector<Nodes>, 2> written_;         ///< by array and slot: what may not be zero
};

}  // namespace mpm::core
