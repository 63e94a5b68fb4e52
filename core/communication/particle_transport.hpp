// Particles on their way to the rank that owns their brick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

/// Particles that go to another brick: their columns one after the other, with where they go.
struct MigrationBuffer {
  struct Head {
    BrickCoord to;
    std::int32_t body = 0;
    std::int32_t unused = 0;  ///< heads travel in whole doubles
  };
  std::vector<Head> heads;
  std::vector<std::size_t> offsets;  ///< of each particle in `columns`
  std::vector<double> columns;

  void add(BrickCoord to, int body, const double* first, int n) {
    heads.push_back({to, body});
    offsets.push_back(columns.size());
    columns.insert(columns.end(), first, first + n);
  }
  std::size_t size() const { return heads.size(); }
  /// Keeps the room of a usual step. Where a lattice moves with one velocity, whole layers cross at once: too
  /// rare to keep room for.
  void clear() {
    constexpr std::size_t kept = std::size_t{1} << 18;  // doubles
    if (columns.capacity() > kept) *this = {};
    heads.clear();
    offsets.clear();
    columns.clear();
  }
};

class ParticleTransport {
 public:
  virtual ~ParticleTransport() = default;

  /// Hand over the particles that another rank's bricks await and receive ours; on return `particles` holds
  /// all that enter our bricks, in no particular order. `columns_of[body]` is the number of columns. Throws
  /// std::logic_error, on this rank alone, where a brick does not exist or is not next to one of ours.
  /// Collective, with the ranks next to this one.
  virtual void migrate(const BrickGrid& grid, MigrationBuffer& particles,
                       std::span<const int> columns_of) = 0;
  /// The same from anywhere to anywhere. Holds up to twice the particles' memory: give it pieces. Collective.
  virtual void scatter(MigrationBuffer& particles, std::span<const int> columns_of) = 0;
};

}  // namespace mpm::core
