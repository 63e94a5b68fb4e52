// Storage for the particles of bodies with the same columns: blocks of eight particles of one body, each
// block column by column. Blocks have 32-bit numbers, move only in arrange(), and are reused.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/pages.hpp"
#include "core/particles/columns.hpp"

namespace mpm::core {

using BlockIndex = std::uint32_t;

class BlockPool {
 public:
  explicit BlockPool(const ColumnLayout& layout);

  const ColumnLayout& layout() const { return layout_; }

  double* block(BlockIndex i) { return slabs_[i / slab_blocks].get() + slab_offset(i); }
  const double* block(BlockIndex i) const { return slabs_[i / slab_blocks].get() + slab_offset(i); }

  /// Thread-safe; contents are zero.
  BlockIndex allocate();
  void release(BlockIndex i);
  /// Moves the blocks in use, given in order, to the numbers 0, 1, 2 ...; references to block in_use[i] then
  /// become i. Not thread-safe.
  void arrange(std::span<const BlockIndex> in_use);

  std::size_t blocks_in_use() const { return next_ - free_.size(); }

 private:
  static constexpr BlockIndex slab_blocks = 32768;  // its columns fill whole huge pages, one each
  std::size_t slab_offset(BlockIndex i) const {
    return static_cast<std::size_t>(i % slab_blocks) * static_cast<std::size_t>(layout_.block_doubles());
  }

  ColumnLayout layout_;
  // Reserved in advance, so that block() may run while another thread allocates.
  std::vector<Pages> slabs_;
  std::vector<BlockIndex> free_;
  BlockIndex next_ = 0;
  std::mutex mutex_;
};

/// One pool for each set of columns: with very many small bodies, a slab per body would exhaust memory.
class BlockPools {
 public:
  std::shared_ptr<BlockPool> of(const ColumnSet& columns);

 private:
  std::vector<std::shared_ptr<BlockPool>> pools_;
};

/// The particles of one body in one brick, or those of them that are in the failed component: all blocks but
/// the last are full.
struct ParticleTile {
  int body = 0;
  std::int32_t component = 0;  ///< the body's, or failed_component()
  std::uint32_t count = 0;
  std::vector<BlockIndex> blocks;

  /// Lanes of block `b` that hold particles; all lanes except in the last block.
  int used_lanes(std::size_t b) const {
    return static_cast<int>(std::min<std::size_t>(block_lanes, count - block_lanes * b));
  }
};

/// Appends one particle, whose columns are given consecutively. Returns its index in the tile.
std::uint32_t append(BlockPool& pool, ParticleTile& tile, const double* columns);
/// Copies the columns of particle `index` to `columns`.
void extract(const BlockPool& pool, const ParticleTile& tile, std::uint32_t index, double* columns);
/// Overwrites particle `index` with the last one and drops the last; depends on the tile's order alone.
void remove_swapping(BlockPool& pool, ParticleTile& tile, std::uint32_t index);

}  // namespace mpm::core
