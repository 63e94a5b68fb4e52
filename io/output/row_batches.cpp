#include "io/output/row_batches.hpp"

namespace mpm::io {

std::vector<RowBatch> cut_into_batches(const core::Model& model, const ParticleOrder& order,
                                       std::span<const std::int64_t> first_row_of_body, std::size_t most) {
  std::vector<RowBatch> batches;
  for (const TilePlace& place : order.mine) {
    const core::ParticleTile& tile = tile_at(model, place);
    const std::int64_t base = first_row_of_body[static_cast<std::size_t>(tile.body)];
    if (base == left_out) continue;
    if (batches.empty() || batches.back().particles + tile.count > most) batches.emplace_back();
    RowBatch& batch = batches.back();
    const auto first = static_cast<std::uint64_t>(base + place.first_row);
    if (!batch.rows.empty() && batch.rows.back().first + batch.rows.back().count == first) {
      batch.rows.back().count += tile.count;
    } else {
      batch.rows.push_back({first, tile.count});
    }
    batch.parts.push_back({place, batch.particles});
    batch.particles += tile.count;
  }
  return batches;
}

}  // namespace mpm::io
