// Splits this rank's particles into batches of bounded memory, for writing datasets of the particles of all
// ranks.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/output/particle_order.hpp"

namespace mpm::io {

struct RowBatch {
  /// Rows [first, first + count) of the dataset.
  struct Stretch {
    std::uint64_t first = 0;
    std::uint64_t count = 0;
  };
  struct Part {
    TilePlace place;
    std::size_t first = 0;  ///< index of its first particle in the batch's memory
  };
  std::vector<Stretch> rows;  ///< ascending, adjacent ones merged; contiguous in memory
  std::vector<Part> parts;
  std::size_t particles = 0;
};

inline constexpr std::int64_t left_out = -1;

/// The batches of the bodies whose first row in the dataset is given, in the dataset's order; `left_out` for
/// bodies that it does not contain. At most about `most` particles each.
std::vector<RowBatch> cut_into_batches(const core::Model& model, const ParticleOrder& order,
                                       std::span<const std::int64_t> first_row_of_body, std::size_t most);

/// f(block, first of its particles in the batch's memory), by all threads.
template <class F>
void for_each_block(const core::Model& model, const RowBatch& batch, F f) {
#pragma omp parallel for schedule(dynamic, 4) if (batch.parts.size() > 32)
  for (std::size_t i = 0; i < batch.parts.size(); ++i) {
    const RowBatch::Part& part = batch.parts[i];
    std::size_t first = part.first;
    for (const core::ConstParticleBlock& block : blocks_at(model, part.place)) {
      f(block, first);
      first += static_cast<std::size_t>(block.used);
    }
  }
}

}  // namespace mpm::io
