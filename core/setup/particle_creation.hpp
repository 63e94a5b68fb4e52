// Creation of particles, at the start of a run and during it.
//
// Every rank creates its own share of every body's particles, twice: once to count them per brick, so that
// each brick gets an owner, and once to send each particle to the rank that owns its brick. No rank ever
// holds more than its share and a buffer of fixed size. Identities come from the bodies' lattices, so they do
// not depend on ranks.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/communication/communication.hpp"
#include "core/discretise/seeds.hpp"
#include "core/model.hpp"
#include "core/setup/start_velocity.hpp"

namespace mpm::core {

/// A body whose particles are to be created.
struct BodySeeds {
  std::size_t body = 0;  ///< its number in the model
  const BodyInput* input = nullptr;
  std::unique_ptr<SeedSource> source;
  std::int64_t block_bytes = 0;  ///< of eight of its particles; 0: only those outside the grid are counted
};

/// Of these bodies of the model. Throws all errors in any of them.
std::vector<BodySeeds> seeds_of(const Model& model, std::span<const std::size_t> bodies);

/// Throws InputErrors where the bodies' identities, from `first_identity` on, exceed the largest one; names
/// the largest body.
void refuse_uncounted(std::span<const BodySeeds> bodies, std::uint64_t first_identity);

/// Counts of this rank's share.
struct SeedCount {
  std::map<BrickKey, std::int64_t> bricks;
  std::vector<std::int64_t> bodies;  ///< particles of each body, including those outside the grid
  std::int64_t block_bytes = 0;  ///< of the blocks that hold them: in every brick of every body, full but one
  std::int64_t outside = 0;      ///< of the grid
  std::string first_outside;     ///< text that describes it

  std::vector<BrickCount> in_bricks() const;
};
SeedCount count_seeds(const GridGeometry& geometry, std::span<const BodySeeds> bodies,
                      const Reductions& ranks);

/// Throws InputErrors on every rank if any has a particle outside the grid. Collective.
void refuse_outside(const Scene& scene, const GridGeometry& geometry, const SeedCount& count,
                    Reductions& ranks);

/// Throws InputErrors on every rank for each body without particles (bodies too large to be checked before,
/// core/discretise/shape_check.hpp). Collective.
void refuse_empty(const Scene& scene, std::span<const BodySeeds> bodies, const SeedCount& count,
                  Reductions& ranks);

/// The columns of a particle as given by the body's input, in the order of `layout`; the material's own start
/// from zero (ConstitutiveModel::initialise).
void fill_columns(const ColumnLayout& layout, const BodyInput& input, StartVelocity& velocity,
                  const Seed& seed, double identity, std::vector<double>& columns);

/// Throws InputErrors on every rank where an expression of a velocity has no finite value for a particle at
/// its creation at `time`; names the first one. Identities continue from `first_identity`. Collective.
void refuse_undefined_velocities(std::span<const BodySeeds> bodies, std::uint64_t first_identity, double time,
                                 Reductions& ranks);

/// Creates the particles and sends each to its brick, which some rank owns; identities continue from the
/// model's next one. Afterwards tiles are ordered by cell and, within a cell, by identity. Collective.
void create_particles(Model& model, std::span<const BodySeeds> bodies, Communication& communication);

}  // namespace mpm::core
