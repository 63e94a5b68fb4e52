// Software prefetching for the passes. The hardware cannot predict which columns of the next blocks are
// needed, where the next brick's blocks are stored, or where the neighbours' nodes are; without prefetching a
// pass takes twice as long. A few lines at a time are requested while other data is processed.
#pragma once

#include <algorithm>
#include <array>

#include "core/model.hpp"
#include "core/prefetch.hpp"
#include "core/step/shared_nodes.hpp"

namespace mpm::core {

/// Over all of a brick's tiles.
inline std::size_t block_count(const Brick& brick) {
  std::size_t n = 0;
  for (const ParticleTile& c : brick.tiles) n += c.blocks.size();
  return n;
}

/// Prefetches the data that locate the next bricks' particles. Each level points to the next: a brick to its
/// tiles, a tile to its block indices. So each level is requested one brick later than the one that points to
/// it.
inline void prefetch_coming_bricks(const BrickGrid& grid, Slot now) {
  const auto line = [](const void* at, std::size_t n) {
    __builtin_prefetch(static_cast<const char*>(at) + 64 * n, 0, 3);
  };
  const Slot last = grid.owned() - 1;
  for (std::size_t n = 0; n < 3; ++n) line(&grid.brick(std::min(now + 3, last)), n);
  const std::vector<ParticleTile>& then = grid.brick(std::min(now + 2, last)).tiles;
  line(then.data(), 0);
  const std::vector<ParticleTile>& next = grid.brick(std::min(now + 1, last)).tiles;
  if (next.empty()) return;
  const std::vector<BlockIndex>& blocks = next.front().blocks;
  for (std::size_t b = 0; b < blocks.size(); b += 16) line(blocks.data() + b, 0);
}

/// Prefetches the blocks that a pass processes next: the rest of the tile, then the next tile, in this brick
/// or the following one. Into the second-level cache: the first has too few outstanding requests to hide the
/// latency of main memory.
class BlockPrefetch {
 public:
  BlockPrefetch(const Model& model, Slot slot, std::size_t tile) : model_(model) {
    const BrickGrid& grid = *model.grid;
    const Brick& brick = grid.brick(slot);
    now_ = &brick.tiles[tile];
    if (tile + 1 < brick.tiles.size()) {
      then_ = &brick.tiles[tile + 1];
    } else if (slot + 1 < grid.owned() && !grid.brick(slot + 1).tiles.empty()) {
      then_ = &grid.brick(slot + 1).tiles.front();
    }
  }
  /// The lines of the block to fetch while block `b` is processed; none where there is no such block.
  [[gnu::always_inline]] PrefetchLines lines(std::size_t b) const {
    const ParticleTile* tile = now_;
    b += distance;
    if (b >= tile->blocks.size()) {
      b -= tile->blocks.size();
      tile = then_;
      if (tile == nullptr || b >= tile->blocks.size()) return {};
    }
    const BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile->body)].pool;
    const double* block = pool.block(tile->blocks[b]);
    return {block, block + pool.layout().block_doubles()};
  }
  /// Requests the first columns of that block at once, and those in which shape functions S keep domains.
  template <class S>
  [[gnu::always_inline]] void request(std::size_t b, const ColumnLayout& layout, int columns) const {
    PrefetchLines of_block = lines(b);
    PrefetchLines domain = of_block;
    of_block.request(columns);
    if constexpr (requires { S::first_of_domain; }) {
      if (domain.next == nullptr) return;
      domain.next += layout.offset(S::first_of_domain);
      domain.request(S::columns_of_domain);
    }
  }

 private:
  static constexpr std::size_t distance = 8;  // hides main memory latency and still fits in the cache
  const Model& model_;
  const ParticleTile* now_;
  const ParticleTile* then_ = nullptr;
};

/// A memory range, requested for writing in as many equal parts as there are calls of next(): what a pass
/// stores for the next brick's nodes.
class SpreadPrefetch {
 public:
  SpreadPrefetch(const double* room, int doubles, std::size_t calls)
      : room_{room, room == nullptr ? nullptr : room + doubles},
        lines_((doubles / block_lanes + static_cast<int>(calls)) / std::max(static_cast<int>(calls), 1)) {}
  [[gnu::always_inline]] void next() { room_.request<true>(lines_); }

 private:
  PrefetchLines room_;
  int lines_;
};

/// Prefetches what sum_contributions will read for a brick, a few records at a time, while another brick is
/// processed: neighbours are far apart in memory, and the hardware cannot predict them.
template <NodeArray of>
class ContributionPrefetch {
 public:
  /// `slot` may be past the last brick. `calls`: how often next() will be called.
  ContributionPrefetch(const BrickGrid& grid, const SharedNodes& shared, Slot slot, std::size_t calls) {
    if (slot >= grid.owned()) return;
    const Brick& brick = grid.brick(slot);
    const bool after_lower_x = brick.neighbour[lower_x_index] == slot - 1;
    shares_ = shared.lines(record_doubles(of), after_lower_x);
    step_ = shares_.size() / std::max<std::size_t>(calls, 1) + 1;
    for (std::size_t n = 0; n < neighbourhood; ++n) {
      from_[n] = grid.contributions(of, brick.neighbour[n] == no_slot ? slot : brick.neighbour[n]);
    }
  }
  [[gnu::always_inline]] void next() {
    const std::size_t count = std::min(step_, shares_.size());
    const SharedNodes::Share* const last = shares_.data() + count;
    for (const SharedNodes::Share* s = shares_.data(); s != last; ++s)
      __builtin_prefetch(from_[static_cast<std::size_t>(s->neighbour)] + record_doubles(of) * s->node, 0, 2);
    shares_ = shares_.subspan(count);
  }

 private:
  std::span<const SharedNodes::Share> shares_;  ///< yet to be requested
  std::array<const double*, neighbourhood> from_{};
  std::size_t step_ = 0;
};

}  // namespace mpm::core
