#include "core/grid/brick_grid.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <string>

namespace mpm::core {

void AlignedDoubles::resize(std::size_t n) {
  if (n > capacity_) {
    const std::size_t wanted = n + n / 8;  // bricks are added one by one: avoid reallocation for each
    data_.reset();
    capacity_ = 0;
    data_ = allocate_pages(wanted);
    capacity_ = wanted;
  }
  size_ = n;
}

void require_few_layers(const NodeBlockShape& shape) {
  for (const int layers : {shape.below, shape.above}) {
    if (layers < 0 || layers > most_layers)
      throw std::logic_error("a node block with " + std::to_string(layers) +
                             " layers of nodes beyond its brick: expected 0 to " +
                             std::to_string(most_layers));
  }
}

BrickGrid::BrickGrid(const GridGeometry& geometry, NodeBlockShape shape, NodeArraySet arrays)
    : geometry_(geometry), shape_(shape), arrays_(arrays) {
  require_few_layers(shape);
}

void BrickGrid::reset(std::vector<BrickCoord> owned, std::vector<BrickCoord> ghosts) {
  const auto by_key = [](BrickCoord a, BrickCoord b) { return key_of(a) < key_of(b); };
  std::sort(owned.begin(), owned.end(), by_key);
  std::sort(ghosts.begin(), ghosts.end(), by_key);

  std::unordered_map<BrickKey, Slot> ghost_slot;
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    ghost_slot.emplace(key_of(ghosts[g]), static_cast<Slot>(owned.size() + g));
  }
  const auto touches_ghost = [&](BrickCoord b) {
    if (ghost_slot.empty()) return false;
    for (int n = 0; n < neighbourhood; ++n) {
      if (ghost_slot.contains(key_of(b + neighbour_offset(n)))) return true;
    }
    return false;
  };
  // Bricks with contributions to send come first, so that the exchange overlaps with the others.
  const auto interior = std::stable_partition(owned.begin(), owned.end(), touches_ghost);
  boundary_ = static_cast<int>(interior - owned.begin());

  std::vector<Brick> bricks(owned.size());
  std::unordered_map<BrickKey, Slot> slot = std::move(ghost_slot);
  slot.reserve(owned.size() + ghosts.size());
  for (std::size_t s = 0; s < owned.size(); ++s) {
    bricks[s].coord = owned[s];
    if (const Slot old = find(owned[s]); old != no_slot && old < this->owned()) {
      bricks[s].tiles = std::move(brick(old).tiles);
    }
    slot.emplace(key_of(owned[s]), static_cast<Slot>(s));
  }
  // Each pair of owned bricks is looked up once, from the one that is later in summation order; ghosts from
  // the bricks beside them.
  const auto count = static_cast<Slot>(owned.size());
  for (Brick& b : bricks) b.neighbour.fill(no_slot);
  for (Slot s = 0; s < count; ++s) {
    Brick& b = bricks[static_cast<std::size_t>(s)];
    const std::size_t looked_up = s < boundary_ ? neighbourhood : self_index + 1;
    for (std::size_t n = 0; n < looked_up; ++n) {
      const auto it = slot.find(key_of(b.coord + neighbour_offset(static_cast<int>(n))));
      if (it == slot.end()) continue;
      b.neighbour[n] = it->second;
      if (it->second < count)
        bricks[static_cast<std::size_t>(it->second)].neighbour[neighbourhood - 1 - n] = s;
    }
  }
  for ([[maybe_unused]] const Brick& b : bricks_)
    assert(b.tiles.empty() && "a brick with particles was dropped");
  bricks_ = std::move(bricks);
  ghosts_ = std::move(ghosts);
  slot_ = std::move(slot);
  extra_begin_.clear();
  component_begin_.clear();
  components_.clear();
  cells_around_.clear();
  cells_of_fields_.clear();
  own_cells_.assign(bricks_.size(), {});
  allocate_nodes(bricks_.size() + ghosts_.size());
  ++revision_;
}

void BrickGrid::set_arrays(NodeArraySet arrays) {
  arrays_ = arrays;
  allocate_nodes(field_count());
  ++revision_;
}

void BrickGrid::allocate_nodes(std::size_t blocks) {
  for (NodeArray of : node_arrays) {
    if (arrays_.has(of)) array(of).resize(stride(of) * blocks);
  }
}

void BrickGrid::set_components(const std::vector<std::vector<std::int32_t>>& of_slot) {
  assert(of_slot.size() == bricks_.size() + ghosts_.size());
  std::vector<std::size_t> begin{0};
  std::vector<std::int32_t> components;
  for (const std::vector<std::int32_t>& of : of_slot) {
    assert(std::is_sorted(of.begin(), of.end()));
    components.insert(components.end(), of.begin(), of.end());
    begin.push_back(components.size());
  }
  if (begin == component_begin_ && components == components_) return;
  component_begin_ = std::move(begin);
  components_ = std::move(components);
  extra_begin_.assign(1, 0);
  for (const std::vector<std::int32_t>& of : of_slot)
    extra_begin_.push_back(extra_begin_.back() + std::max(static_cast<Slot>(of.size()), Slot{1}) - 1);
  allocate_nodes(field_count());
  ++revision_;
}

}  // namespace mpm::core
