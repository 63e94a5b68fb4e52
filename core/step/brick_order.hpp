// The order in which the passes (passes_with.hpp, of which this is a part) go through bricks and their
// blocks, by several threads and with prefetching.
#pragma once

#include <algorithm>
#include <tuple>

#include <omp.h>

#include "core/step/passes_with.hpp"

namespace mpm::core {

/// f(slot, scratch) for the bricks first .. last - 1, by all threads.
template <ShapePolicy S, TransferPolicy T>
template <class F>
void PassesWith<S, T>::for_bricks(int first, int last, F f) {
  // Long runs of neighbours per thread: most prefetched data and sums then stay in that thread's cache. Four
  // runs per thread balance differences between bricks.
  const auto threads = static_cast<int>(scratch_.size());
  for (Scratch& w : scratch_) std::apply([](auto&... sums) { (sums.forget(), ...); }, w.carried);
  for_each_by_threads(
      first, last, std::max((last - first) / (4 * threads), 1),
      [&](int s) {
        prefetch_coming_bricks(*model_.grid, static_cast<Slot>(s));
        f(static_cast<Slot>(s), scratch_[static_cast<std::size_t>(omp_get_thread_num())]);
      },
      threads);
}

/// f(tile index, block index, body number, layout, block, lanes in use) for a brick's blocks with particles
/// of a component. `columns`: number of leading columns that are read.
template <ShapePolicy S, TransferPolicy T>
template <class F>
[[gnu::always_inline]] inline void PassesWith<S, T>::for_each_block(Slot s, std::int32_t component,
                                                                    int columns, F f) {
  const Brick& brick = model_.grid->brick(s);
  for (std::size_t c = 0; c < brick.tiles.size(); ++c) {
    const ParticleTile& tile = brick.tiles[c];
    if (!holds(tile, component)) continue;
    BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
    const BlockPrefetch prefetch(model_, s, c);
    for (std::size_t b = 0; b < tile.blocks.size(); ++b) {
      prefetch.template request<S>(b, pool.layout(), columns);
      f(c, b, tile.body, pool.layout(), pool.block(tile.blocks[b]), tile.used_lanes(b));
    }
  }
}

/// Processes a brick's blocks with particles of a component in batches: for each tile tile_work(tile); for
/// each block of a batch block_work(body, block of the batch, lanes in use), then, with the next blocks
/// prefetched, batch_work(tile index, first block index, tile). `at` holds the batch and its particles'
/// places.
template <ShapePolicy S, TransferPolicy T>
template <class E, class F, class G>
[[gnu::always_inline]] inline void PassesWith<S, T>::for_each_batch(Slot s, std::int32_t component,
                                                                    const BrickFrame& frame, Scratch& at,
                                                                    E tile_work, F block_work, G batch_work) {
  const Brick& brick = model_.grid->brick(s);
  Batch& batch = at.batch;
  batch.time = strain_.end;
  batch.dt = strain_.dt;
  batch.part = strain_.part;
  batch.cell_size = model_.grid->geometry().smallest_cell();
  for (std::size_t c = 0; c < brick.tiles.size(); ++c) {
    const ParticleTile& tile = brick.tiles[c];
    if (!holds(tile, component)) continue;
    const BlockPrefetch prefetch(model_, s, c);
    BlockPool& pool = *model_.bodies[static_cast<std::size_t>(tile.body)].pool;
    batch.layout = &pool.layout();
    tile_work(tile);
    const int lines_before_update = std::max(pool.layout().columns() - parts_of_update, 0);
    for (std::size_t first = 0; first < tile.blocks.size(); first += batch_blocks) {
      batch.blocks = static_cast<int>(std::min<std::size_t>(batch_blocks, tile.blocks.size() - first));
      batch.particles =
          static_cast<int>(std::min<std::size_t>(batch_particles, tile.count - block_lanes * first));
      // All places first: locating a block is a long chain of operations, and the chains of several blocks
      // overlap.
      for (int b = 0; b < batch.blocks; ++b) {
        const std::size_t number = first + static_cast<std::size_t>(b);
        batch.block[b] = pool.block(tile.blocks[number]);
        at.places[b].find(frame, pool.layout(), batch.block[b], tile.used_lanes(number));
      }
      for (int b = 0; b < batch.blocks; ++b) {
        const std::size_t at_block = first + static_cast<std::size_t>(b);
        batch.background[b] = prefetch.lines(at_block);
        batch.background[b].request(lines_before_update);
        block_work(tile.body, b, tile.used_lanes(at_block));
      }
      batch_work(c, first, tile);
    }
  }
}

/// work(slot, scratch) for all bricks, which maps the fields to be exchanged; the exchange of the boundary
/// bricks overlaps with the interior ones.
template <ShapePolicy S, TransferPolicy T>
template <NodeFields what, class F>
void PassesWith<S, T>::map_bricks(F work) {
  BrickGrid& grid = *model_.grid;
  for_bricks(0, grid.boundary(), work);
  halo_.begin(grid, what);
  for_bricks(grid.boundary(), grid.owned(), work);
}

}  // namespace mpm::core
