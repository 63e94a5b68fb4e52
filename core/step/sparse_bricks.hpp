// Bricks with few particles, of which clouds of debris consist: of their nodes only those that the particles
// reach are cleared, summed and updated. Contributions to the other nodes stay zero, so that neighbours and
// other ranks need not know which these are. Which bricks are sparse depends on their particles alone, and so
// does not differ between ranks.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

class SparseBricks {
 public:
  /// Most particles, of as many nodes along an axis, with which a brick is sparse: those that reach half of
  /// its nodes where they share none. With more, whole rows, with those that neighbours have in common
  /// carried along, are summed as fast.
  static constexpr std::size_t most_particles(const NodeBlockShape& shape, int nodes_per_axis) {
    return static_cast<std::size_t>(shape.nodes()) /
           static_cast<std::size_t>(2 * nodes_per_axis * nodes_per_axis * nodes_per_axis);
  }

  /// Before the first map of a step.
  void begin_step(const BrickGrid& grid) {
    const auto owned = static_cast<std::size_t>(grid.owned());
    if (revision_ == grid.revision() && reached_.size() == owned) return;
    revision_ = grid.revision();
    reached_.assign(owned, {});
    for (const NodeArray of : {NodeArray::first, NodeArray::second, NodeArray::sixth, NodeArray::seventh})
      if (grid.arrays().has(of)) written_[static_cast<std::size_t>(of)].assign(owned, {});
  }
  /// The nodes that the particles of a brick reach in this step; null: all of them.
  const NodeMask* reached(Slot s) const {
    const Nodes& nodes = reached_[static_cast<std::size_t>(s)];
    return nodes.all ? nullptr : &nodes.some;
  }
  void set_all(Slot s) { reached_[static_cast<std::size_t>(s)].all = true; }
  void set_some(Slot s, const NodeMask& nodes) { reached_[static_cast<std::size_t>(s)] = {false, nodes}; }

  /// Clears the contributions to the nodes of a brick before those reached are added to, unless all are
  /// replaced; `width`: doubles of a record.
  void begin_map(NodeArray of, const NodeBlockShape& shape, Slot s, int width, bool replaces,
                 double* contributions) {
    Nodes& written = written_[static_cast<std::size_t>(of)][static_cast<std::size_t>(s)];
    const Nodes& reached = reached_[static_cast<std::size_t>(s)];
    if (replaces) {
      written.all = true;
      return;
    }
    if (written.all || reached.all) {
      std::fill_n(contributions, width * shape.nodes(), 0.0);
    } else {
      written.some.for_each(shape, [&](int first, int count) {
        std::fill_n(contributions + width * first, width * count, 0.0);
      });
    }
    written = reached;
  }

 private:
  struct Nodes {
    bool all = true;
    NodeMask some;
  };
  std::uint64_t revision_ = 0;  ///< of the grid
  std::vector<Nodes> reached_;  ///< by slot
  std::array<std::vector<Nodes>, node_arrays.size()>
      written_;  ///< by array and slot: where contributions may not be zero
};

}  // namespace mpm::core
