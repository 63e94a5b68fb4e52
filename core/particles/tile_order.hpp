// Particles within their bricks' tiles: inserted, sorted, and their blocks laid one after the other in
// memory.
//
// The order inside a tile decides the order of sums, so it depends on the particles' history alone: never on
// which rank or thread carried a particle where.
#pragma once

#include "core/communication/particle_transport.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Append particles to their bricks, which must be ours: each tile's in ascending order of identity.
void insert_particles(Model& model, const MigrationBuffer& particles);

/// Particles of a tile in ascending order of their cells, otherwise as they were.
void sort_by_cell(const BrickGrid& grid, BrickCoord brick, BlockPool& pool, ParticleTile& tile);

/// Particles of a tile in ascending order of identity.
void sort_by_identity(BlockPool& pool, ParticleTile& tile);

/// Every brick's blocks one after the other in memory. Particles that came in pieces, and by several threads,
/// lie all over the place: the passes of two threads were a tenth slower.
void arrange_blocks(Model& model);

}  // namespace mpm::core
