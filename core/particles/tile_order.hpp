// Order of particles within tiles and of blocks in memory: insertion and sorting.
//
// The order inside a tile decides the order of sums, so it depends only on the particles' history, never on
// ranks or threads.
#pragma once

#include "core/communication/particle_transport.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Appends a particle of a body to a brick's tile of its component (core/contact/failed_component.hpp).
void append(Model& model, Brick& brick, int body, const double* columns);

/// Appends particles to their bricks, which must be ours, in ascending order of identity per tile.
void insert_particles(Model& model, const MigrationBuffer& particles);

/// Sorts the particles of a tile by site; the sort is stable.
void sort_by_site(const BrickGrid& grid, BrickCoord brick, BlockPool& pool, ParticleTile& tile);

/// Sorts the particles of a tile by identity.
void sort_by_identity(BlockPool& pool, ParticleTile& tile);

/// Sorts the tiles of all bodies, or of those for which `wanted` is true, by site and, within a site, by
/// identity, independently of the order of arrival.
void sort_tiles(Model& model, const std::vector<bool>& wanted = {});

/// Stores every brick's blocks consecutively. Without it, particles that arrived in pieces and by several
/// threads are scattered in memory: the passes of two threads were a tenth slower.
void arrange_blocks(Model& model);

}  // namespace mpm::core
