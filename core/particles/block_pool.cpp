#include "core/particles/block_pool.hpp"

#include <cstring>

namespace mpm::core {

namespace {
constexpr std::size_t max_slabs = std::size_t{1} << 17;  // 2^32 blocks
}

BlockPool::BlockPool(const ColumnLayout& layout) : layout_(layout) {
  // Pointers only: 128 Ki slabs of 32768 blocks cover every 32-bit number; pages are allocated on first use.
  slabs_.reserve(max_slabs);
}

BlockIndex BlockPool::allocate() {
  const std::lock_guard lock(mutex_);
  BlockIndex i = 0;
  if (!free_.empty()) {
    i = free_.back();
    free_.pop_back();
  } else {
    if (next_ % slab_blocks == 0) {
      slabs_.push_back(allocate_pages(slab_blocks * static_cast<std::size_t>(layout_.block_doubles())));
    }
    i = next_++;
  }
  std::memset(block(i), 0, sizeof(double) * static_cast<std::size_t>(layout_.block_doubles()));
  return i;
}

void BlockPool::release(BlockIndex i) {
  const std::lock_guard lock(mutex_);
  free_.push_back(i);
}

void BlockPool::arrange(std::span<const BlockIndex> in_use) {
  // from[i]: current location of the block that becomes block i; a permutation of all blocks ever allocated.
  std::vector<BlockIndex> from(in_use.begin(), in_use.end());
  std::vector<bool> used(next_);
  for (const BlockIndex i : in_use) used[i] = true;
  for (BlockIndex i = 0; i < next_; ++i) {
    if (!used[i]) from.push_back(i);
  }
  const std::size_t bytes = sizeof(double) * static_cast<std::size_t>(layout_.block_doubles());
  std::vector<double> aside(static_cast<std::size_t>(layout_.block_doubles()));
  for (BlockIndex first = 0; first < next_; ++first) {
    if (from[first] == first) continue;
    std::memcpy(aside.data(), block(first), bytes);
    BlockIndex to = first;
    while (from[to] != first) {
      const BlockIndex next = from[to];
      std::memcpy(block(to), block(next), bytes);
      from[to] = to;
      to = next;
    }
    std::memcpy(block(to), aside.data(), bytes);
    from[to] = to;
  }
  next_ = static_cast<BlockIndex>(in_use.size());
  free_.clear();
  slabs_.resize((next_ + slab_blocks - 1) / slab_blocks);
}

std::shared_ptr<BlockPool> BlockPools::of(const ColumnSet& columns) {
  for (const std::shared_ptr<BlockPool>& pool : pools_) {
    if (pool->layout().set() == columns) return pool;
  }
  return pools_.emplace_back(std::make_shared<BlockPool>(ColumnLayout(columns)));
}

std::uint32_t append(BlockPool& pool, ParticleTile& tile, const double* columns) {
  const std::uint32_t lane = tile.count % block_lanes;
  if (lane == 0) tile.blocks.push_back(pool.allocate());
  double* block = pool.block(tile.blocks.back());
  // The first particle of a block also fills its unused lanes: the kernels process them like the others, and
  // a copy of a valid particle raises no error. Their results are never read.
  const int lanes = lane == 0 ? block_lanes : 1;
  for (int c = 0; c < pool.layout().columns(); ++c) {
    for (int i = 0; i < lanes; ++i) block[block_lanes * c + static_cast<int>(lane) + i] = columns[c];
  }
  return tile.count++;
}

void extract(const BlockPool& pool, const ParticleTile& tile, std::uint32_t index, double* columns) {
  const double* block = pool.block(tile.blocks[index / block_lanes]);
  const int lane = static_cast<int>(index % block_lanes);
  for (int c = 0; c < pool.layout().columns(); ++c) columns[c] = block[block_lanes * c + lane];
}

void remove_swapping(BlockPool& pool, ParticleTile& tile, std::uint32_t index) {
  const std::uint32_t last = tile.count - 1;
  double* to = pool.block(tile.blocks[index / block_lanes]) + index % block_lanes;
  double* from = pool.block(tile.blocks[last / block_lanes]) + last % block_lanes;
  for (int c = 0; c < pool.layout().columns(); ++c) { to[block_lanes * c] = from[block_lanes * c]; }
  tile.count = last;
  if (last % block_lanes == 0) {
    pool.release(tile.blocks.back());
    tile.blocks.pop_back();
  }
}

}  // namespace mpm::core
