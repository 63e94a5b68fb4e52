// Blocks and tiles: what goes in comes out, blocks are reused, and unused lanes hold sound numbers.
#include "core/particles/block_pool.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <catch2/catch.hpp>

using namespace mpm::core;

namespace {

ColumnLayout layout_with(Column extra) {
  ColumnSet set = ColumnSet::mechanics();
  set.add(extra);
  return ColumnLayout(set);
}

/// Columns of particle n: n + c / 100.
std::vector<double> particle(const BlockPool& pool, int n) {
  std::vector<double> columns;
  for (int c = 0; c < pool.layout().columns(); ++c) columns.push_back(n + 0.01 * c);
  return columns;
}

std::vector<double> numbers(const BlockPool& pool, const ParticleTile& tile) {
  std::vector<double> first, columns(static_cast<std::size_t>(pool.layout().columns()));
  for (std::uint32_t i = 0; i < tile.count; ++i) {
    extract(pool, tile, i, columns.data());
    first.push_back(columns[0]);
    REQUIRE(columns == particle(pool, static_cast<int>(columns[0])));
  }
  return first;
}

}  // namespace

TEST_CASE("A layout has the columns of its set and no others, one cache line each") {
  const ColumnLayout layout = layout_with(Column::damage);
  CHECK(layout.columns() == ColumnSet::mechanics().size() + 1);
  CHECK(layout.has(Column::identity));
  CHECK_FALSE(layout.has(Column::yield_stress));
  CHECK(layout.offset(Column::yield_stress) == -1);
  std::set<int> offsets;
  for (int c = 0; c < column_count; ++c) {
    const int offset = layout.offset(static_cast<Column>(c));
    if (offset < 0) continue;
    CHECK(offset % block_lanes == 0);
    CHECK(offset < layout.block_doubles());
    offsets.insert(offset);
  }
  CHECK(offsets.size() == static_cast<std::size_t>(layout.columns()));
}

TEST_CASE("Particles come out of a tile as they went in, in blocks full but for the last") {
  BlockPool pool(layout_with(Column::damage));
  ParticleTile tile;
  std::vector<double> expected;
  for (int n = 0; n < 37; ++n) {
    CHECK(append(pool, tile, particle(pool, n).data()) == static_cast<std::uint32_t>(n));
    expected.push_back(n);
    CHECK(tile.blocks.size() == static_cast<std::size_t>(n / 8 + 1));
  }
  CHECK(numbers(pool, tile) == expected);
  CHECK(pool.blocks_in_use() == 5);
}

TEST_CASE("The lanes beyond the last particle of a new block repeat its first") {
  BlockPool pool(layout_with(Column::damage));
  ParticleTile tile;
  for (int n = 0; n < 10; ++n) append(pool, tile, particle(pool, n).data());
  const double* block = pool.block(tile.blocks[1]);
  for (int c = 0; c < pool.layout().columns(); ++c) {
    for (int lane = 2; lane < block_lanes; ++lane) CHECK(block[block_lanes * c + lane] == 8 + 0.01 * c);
  }
}

TEST_CASE("Removing puts the last particle into the gap, and gives back empty blocks") {
  BlockPool pool(layout_with(Column::damage));
  ParticleTile tile;
  for (int n = 0; n < 17; ++n) append(pool, tile, particle(pool, n).data());
  remove_swapping(pool, tile, 3);
  CHECK(tile.count == 16);
  CHECK(tile.blocks.size() == 2);
  CHECK(pool.blocks_in_use() == 2);
  CHECK(numbers(pool, tile) == std::vector<double>{0, 1, 2, 16, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15});
  remove_swapping(pool, tile, 15);
  CHECK(numbers(pool, tile).back() == 14);
  while (tile.count > 0) remove_swapping(pool, tile, 0);
  CHECK(tile.blocks.empty());
  CHECK(pool.blocks_in_use() == 0);
}

TEST_CASE(
    "Blocks keep their address while others come, lie on cache lines, and are zero when given out anew") {
  BlockPool pool(layout_with(Column::damage));
  std::vector<BlockIndex> blocks;
  std::vector<const double*> addresses;
  for (int i = 0; i < 70000; ++i) {  // more than two slabs
    blocks.push_back(pool.allocate());
    addresses.push_back(pool.block(blocks.back()));
    pool.block(blocks.back())[0] = i;
  }
  bool steady = true, aligned = true;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    steady = steady && pool.block(blocks[i]) == addresses[i] && *addresses[i] == static_cast<double>(i);
    aligned = aligned && reinterpret_cast<std::uintptr_t>(addresses[i]) % 64 == 0;
  }
  CHECK(steady);
  CHECK(aligned);
  const std::set<BlockIndex> first(blocks.begin(), blocks.end());
  CHECK(first.size() == blocks.size());
  for (const BlockIndex b : blocks) pool.release(b);
  CHECK(pool.blocks_in_use() == 0);
  bool zero = true;
  std::set<BlockIndex> again;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const BlockIndex b = pool.allocate();
    zero = zero && pool.block(b)[0] == 0;
    again.insert(b);
  }
  CHECK(zero);
  CHECK(again == first);  // the memory of the released blocks serves again
}

TEST_CASE("Blocks that were dealt out in any order are arranged one tile after the other") {
  BlockPool pool(layout_with(Column::damage));
  std::vector<ParticleTile> tiles(3);
  for (int n = 0; n < 500; ++n)
    append(pool, tiles[static_cast<std::size_t>(n * n % 7 % 3)], particle(pool, n).data());
  while (tiles[1].count > 20) remove_swapping(pool, tiles[1], tiles[1].count / 2);  // leaves gaps
  std::vector<std::vector<double>> before;
  std::vector<BlockIndex> in_use;
  for (ParticleTile& tile : tiles) {
    before.push_back(numbers(pool, tile));
    for (BlockIndex& b : tile.blocks) {
      in_use.push_back(b);
      b = static_cast<BlockIndex>(in_use.size() - 1);
    }
  }
  REQUIRE_FALSE(std::is_sorted(in_use.begin(), in_use.end()));
  pool.arrange(in_use);
  for (std::size_t c = 0; c < tiles.size(); ++c) CHECK(numbers(pool, tiles[c]) == before[c]);
  CHECK(pool.blocks_in_use() == in_use.size());
  // What comes next takes no block that is in use.
  ParticleTile more;
  for (int n = 600; n < 900; ++n) append(pool, more, particle(pool, n).data());
  CHECK(more.blocks.front() == in_use.size());
  for (std::size_t c = 0; c < tiles.size(); ++c) CHECK(numbers(pool, tiles[c]) == before[c]);
  BlockPool none(layout_with(Column::damage));
  none.arrange({});
  CHECK(none.blocks_in_use() == 0);
}

TEST_CASE("Bodies with the same columns share a pool, others do not") {
  BlockPools pools;
  ColumnSet more = ColumnSet::mechanics();
  more.add(Column::damage);
  const auto plain = pools.of(ColumnSet::mechanics()), damaged = pools.of(more);
  CHECK(plain != damaged);
  CHECK(pools.of(ColumnSet::mechanics()) == plain);
  CHECK(pools.of(more) == damaged);
  CHECK(damaged->layout().has(Column::damage));
  CHECK_FALSE(plain->layout().has(Column::damage));
}
