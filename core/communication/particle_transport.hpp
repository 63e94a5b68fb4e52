// Transport of migrating particles to the rank that owns their brick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

/// Migrating particles: their columns, each particle's in a row, and their destinations.
struct MigrationBuffer {
  struct Head {
    BrickCoord to;
    std::int32_t body = 0;
    std::int32_t unused = 0;  ///< heads are sent as whole doubles
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
  /// Keeps the memory for the next step: where a lattice moves with one velocity, whole layers cross at once,
  /// and fresh pages for them take as long as the copies.
  void clear() {
    heads.clear();
    offsets.clear();
    columns.clear();
  }
};

class ParticleTransport {
 public:
  virtual ~ParticleTransport() = default;

  /// Sends the particles that enter other ranks' bricks and receives ours; on return `particles` holds all
  /// that enter our bricks, in no particular order. `columns_of[body]` is the number of columns. Throws
  /// std::logic_error, on this rank alone, where a brick does not exist or is not next to one of ours.
  /// Collective, with the neighbouring ranks.
  virtual void migrate(const BrickGrid& grid, MigrationBuffer& particles,
                       std::span<const int> columns_of) = 0;
  /// The same between any ranks. Needs up to twice the particles' memory: call it in pieces. Collective.
  virtual void scatter(MigrationBuffer& particles, std::span<const int> columns_of) = 0;
};

}  // namespace mpm::core
