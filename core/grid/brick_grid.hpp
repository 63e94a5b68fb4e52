// The bricks of one rank: which exist, their neighbours, and their contributions to their nodes.
//
// Slots 0 .. owned()-1 are this rank's bricks, those next to another rank's first; the following slots are
// ghosts: other ranks' bricks next to ours, of which only the contributions to shared nodes are stored.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/grid/brick.hpp"
#include "core/grid/cells_around.hpp"
#include "core/grid/node_fields.hpp"
#include "core/pages.hpp"
#include "core/particles/block_pool.hpp"

namespace mpm::core {

using Slot = std::int32_t;
inline constexpr Slot no_slot = -1;

/// In place of a component's number: all of them.
inline constexpr std::int32_t all_components = -1;

/// Resizable, page-aligned array of doubles; contents are undefined after a resize.
class AlignedDoubles {
 public:
  void resize(std::size_t n);
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  std::size_t size() const { return size_; }

 private:
  Pages data_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

struct Brick {
  BrickCoord coord;
  std::array<Slot, neighbourhood> neighbour{};  ///< owned or ghost slots; no_slot where no brick exists
  /// In ascending order of body, then component; none is empty after migration.
  std::vector<ParticleTile> tiles;
  std::size_t particles() const {
    std::size_t n = 0;
    for (const ParticleTile& c : tiles) n += c.count;
    return n;
  }
};

/// Throws std::logic_error for more than most_layers of nodes beyond the brick.
void require_few_layers(const NodeBlockShape& shape);

class BrickGrid {
 public:
  /// Throws std::logic_error for more than most_layers of nodes beyond the brick.
  explicit BrickGrid(const GridGeometry& geometry, NodeBlockShape shape = {},
                     NodeArraySet arrays = {NodeArray::first, NodeArray::second});

  const GridGeometry& geometry() const { return geometry_; }
  const NodeBlockShape& shape() const { return shape_; }

  int owned() const { return static_cast<int>(bricks_.size()); }
  int boundary() const { return boundary_; }  ///< owned bricks next to a ghost: slots 0 .. boundary()-1
  int ghosts() const { return static_cast<int>(ghosts_.size()); }
  Brick& brick(Slot s) { return bricks_[static_cast<std::size_t>(s)]; }
  const Brick& brick(Slot s) const { return bricks_[static_cast<std::size_t>(s)]; }
  BrickCoord ghost(int i) const { return ghosts_[static_cast<std::size_t>(i)]; }
  std::span<Brick> bricks() { return bricks_; }
  std::span<const Brick> bricks() const { return bricks_; }

  /// Slot of an owned or ghost brick, or no_slot.
  Slot find(BrickCoord b) const {
    const auto it = slot_.find(key_of(b));
    return it == slot_.end() ? no_slot : it->second;
  }

  /// Replaces the set of bricks: those of `owned` that exist keep their particles, new ones start empty; a
  /// brick that is dropped must be empty. Slots, neighbours and node arrays change.
  void reset(std::vector<BrickCoord> owned, std::vector<BrickCoord> ghosts);

  const NodeArraySet& arrays() const { return arrays_; }
  /// Replaces the set of node arrays; their contents become undefined.
  void set_arrays(NodeArraySet arrays);
  /// Contributions of the slot's particles to its nodes: shape().nodes() records of record_doubles(of). `of`
  /// is one of arrays().
  double* contributions(NodeArray of, Slot s) {
    return array(of).data() + stride(of) * static_cast<std::size_t>(s);
  }
  const double* contributions(NodeArray of, Slot s) const {
    return array(of).data() + stride(of) * static_cast<std::size_t>(s);
  }
  /// Of one of its velocity fields; field 0 is the one above.
  double* contributions(NodeArray of, Slot s, int field) {
    return array(of).data() + stride(of) * field_index(s, field);
  }
  const double* contributions(NodeArray of, Slot s, int field) const {
    return array(of).data() + stride(of) * field_index(s, field);
  }

  /// Gives every component a velocity field of its own in each brick that holds particles of it (contact).
  /// of_slot: the components of each owned and ghost slot, ascending. Without effect if they are those of
  /// before; else the contents of the node arrays are undefined. After reset() all slots have one field for
  /// all components.
  void set_components(const std::vector<std::vector<std::int32_t>>& of_slot);
  bool has_fields_by_component() const { return !component_begin_.empty(); }
  /// Of a slot, in the order of its fields; where there are fields by component.
  std::span<const std::int32_t> components(Slot s) const {
    const auto at = static_cast<std::size_t>(s);
    return std::span(components_)
        .subspan(component_begin_[at], component_begin_[at + 1] - component_begin_[at]);
  }
  /// The field of a component in a slot; -1 if the brick holds no particles of it.
  int field_of(Slot s, std::int32_t component) const {
    const std::span<const std::int32_t> there = components(s);
    for (std::size_t f = 0; f < there.size(); ++f)
      if (there[f] == component) return static_cast<int>(f);
    return -1;
  }
  /// At least 1.
  int velocity_fields(Slot s) const {
    return extra_begin_.empty() ? 1
                                : 1 + extra_begin_[static_cast<std::size_t>(s) + 1] -
                                      extra_begin_[static_cast<std::size_t>(s)];
  }

  /// Place of a field in arrays over the fields of all slots: after the first fields of all slots come the
  /// further ones.
  std::size_t field_index(Slot s, int field) const {
    const auto at = static_cast<std::size_t>(s);
    if (field == 0) return at;
    return bricks_.size() + ghosts_.size() + static_cast<std::size_t>(extra_begin_[at] + field - 1);
  }
  /// Of all owned and ghost slots together.
  std::size_t field_count() const {
    const Slot extra = extra_begin_.empty() ? 0 : extra_begin_.back();
    return bricks_.size() + ghosts_.size() + static_cast<std::size_t>(extra);
  }

  /// The cells that hold particles of a field of an owned brick, or of any, in this step; null unless the
  /// shape functions need them (core/step/cells_in_use.hpp).
  const CellsAround* cells_in_use(Slot s, int field) const {
    if (!has_fields_by_component()) return cells_in_use(s);
    return cells_of_fields_.empty() ? nullptr : &cells_of_fields_[field_index(s, field)];
  }
  const CellsAround* cells_in_use(Slot s) const {
    return cells_around_.empty() ? nullptr : &cells_around_[static_cast<std::size_t>(s)];
  }
  CellsAround& cells_around(Slot s, int field) { return cells_of_fields_[field_index(s, field)]; }
  CellsAround& cells_around(Slot s) { return cells_around_[static_cast<std::size_t>(s)]; }
  /// Room for their weights.
  CellWeightsAround& cell_weights(Slot s, int field) { return weights_of_fields_[field_index(s, field)]; }
  CellWeightsAround& cell_weights(Slot s) { return cell_weights_[static_cast<std::size_t>(s)]; }
  /// None in use, for every owned brick; with room for weights or without.
  void reset_cells_around(bool weighted) {
    const std::size_t fields = has_fields_by_component() ? field_count() : 0;
    cells_around_.assign(bricks_.size(), {});
    cells_of_fields_.assign(fields, {});
    cell_weights_.resize(weighted ? bricks_.size() : 0);
    weights_of_fields_.resize(weighted ? fields : 0);
  }
  /// Those that hold particles of an owned brick, where the pass that has moved these has found them:
  /// cell (i, j, k) in bit i + 4 j + 16 k.
  std::optional<std::uint64_t>& own_cells(Slot s) { return own_cells_[static_cast<std::size_t>(s)]; }

  /// Incremented whenever the set of bricks or of node arrays changes; communication plans are then rebuilt.
  std::uint64_t revision() const { return revision_; }

 private:
  /// Whole cache lines, so that no record crosses one.
  std::size_t stride(NodeArray of) const {
    constexpr int line = 8;
    return static_cast<std::size_t>((shape_.nodes() * record_doubles(of) + line - 1) / line * line);
  }
  void allocate_nodes(std::size_t blocks);
  AlignedDoubles& array(NodeArray of) { return nodes_[static_cast<std::size_t>(of)]; }
  const AlignedDoubles& array(NodeArray of) const { return nodes_[static_cast<std::size_t>(of)]; }

  GridGeometry geometry_;
  NodeBlockShape shape_;
  NodeArraySet arrays_;
  std::vector<Brick> bricks_;
  std::vector<BrickCoord> ghosts_;
  std::unordered_map<BrickKey, Slot> slot_;
  std::array<AlignedDoubles, node_arrays.size()> nodes_;
  std::vector<Slot>
      extra_begin_;  ///< by slot: index of its first extra block; empty while all have one field
  std::vector<std::size_t> component_begin_;  ///< by slot, in `components_`; empty while fields are for all
  std::vector<std::int32_t> components_;
  std::vector<CellsAround> cells_around_;     ///< by owned slot, or empty
  std::vector<CellsAround> cells_of_fields_;  ///< by field_index(), where there are fields by component
  std::vector<CellWeightsAround> cell_weights_, weights_of_fields_;  ///< alike, or empty
  int boundary_ = 0;
  std::uint64_t revision_ = 0;
  std::vector<std::optional<std::uint64_t>> own_cells_;  ///< by owned slot
};

}  // namespace mpm::core
