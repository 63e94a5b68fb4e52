// The order of particles in files that hold all of them: body after body, within a body brick after brick by
// key, within a brick as stored, those in the failed component last. It does not depend on ranks or threads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"
#include "core/particle_range.hpp"

namespace mpm::io {

/// The particles of one body in one brick; those in the failed component have a record of their own, after
/// it.
struct TileRecord {
  core::BrickKey brick = 0;
  std::int64_t body = 0;
  std::uint64_t particles = 0;
  std::uint64_t hash = 0;  ///< of the particles' columns, row by row; 0 unless requested
  bool operator==(const TileRecord&) const = default;
};

/// Rows of this rank: a tile and the index of its first particle among all particles of its body.
struct TilePlace {
  core::Slot slot = 0;
  int tile = 0;  ///< index into the brick's tiles
  std::int64_t first_row = 0;
};

struct ParticleOrder {
  std::vector<TileRecord> tiles;        ///< of all ranks, by body, then brick
  std::vector<TilePlace> mine;          ///< of this rank, in the same order
  std::vector<std::int64_t> particles;  ///< per body, of all ranks
};

/// With `hashes` every record has its hash. Collective.
ParticleOrder order_particles(const core::Model& model, core::Reductions& ranks, bool hashes);

/// Hash of the state of all particles: names of bodies and columns, and every record of the order. The same
/// for the same bits, on any number of ranks. Collective.
std::uint64_t state_hash(const core::Model& model, core::Reductions& ranks);
std::uint64_t state_hash(const std::vector<TileRecord>& tiles, const std::vector<std::string>& bodies);
/// Contribution of a body to state_hash(): its name and the names of its columns.
std::string described(const std::string& name, const core::ColumnSet& columns);

/// The particles of a tile.
inline const core::ParticleTile& tile_at(const core::Model& model, const TilePlace& place) {
  return model.grid->brick(place.slot).tiles[static_cast<std::size_t>(place.tile)];
}
inline core::BlockRange<const core::Model> blocks_at(const core::Model& model, const TilePlace& place) {
  return blocks_of(model, std::as_const(*model.grid).brick(place.slot), tile_at(model, place));
}

/// Hash of a record, from all its rows of `columns` doubles.
std::uint64_t hash_of(const TileRecord& record, const double* rows, int columns);

}  // namespace mpm::io
