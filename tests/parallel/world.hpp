// What the parallel tests share. Every case is run by all ranks together, with the same random numbers on
// each.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "core/grid/brick_grid.hpp"
#include "parallel/brick_table.hpp"
#include "parallel/mpi.hpp"

namespace mpm::parallel::test {

/// All ranks of this program.
const Communicator& world();

/// True if every rank gives the same text. Collective.
bool same_on_all(const std::string& text);

/// A grid of n^3 unit cells from the origin.
inline core::GridGeometry unit_grid(std::int64_t n) {
  core::GridGeometry g;
  g.cell = g.inverse_cell = {1, 1, 1};
  g.cells = {n, n, n};
  return g;
}

inline std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  std::uint64_t h = (a ^ (b + 0x9e3779b97f4a7c15u + (a << 6) + (a >> 2))) * 0xff51afd7ed558ccdu;
  return h ^ (h >> 33);
}

/// A set of bricks in which every brick of the box 0 <= component < extent is present with the probability
/// `share`.
inline std::vector<core::BrickCoord> random_bricks(std::mt19937_64& random, core::BrickCoord extent,
                                                   double share) {
  std::vector<core::BrickCoord> bricks;
  for (std::int32_t z = 0; z < extent.z; ++z) {
    for (std::int32_t y = 0; y < extent.y; ++y) {
      for (std::int32_t x = 0; x < extent.x; ++x) {
        if (std::uniform_real_distribution<>()(random) < share) bricks.push_back({x, y, z});
      }
    }
  }
  return bricks;
}

inline bool adjacent(core::BrickCoord a, core::BrickCoord b) {
  return std::abs(a.x - b.x) <= 1 && std::abs(a.y - b.y) <= 1 && std::abs(a.z - b.z) <= 1;
}

/// By definition: the bricks of others that are next to one of `rank`'s.
inline std::set<core::BrickCoord> ghosts_of(const std::set<core::BrickCoord>& bricks, const BrickTable& table,
                                            int rank) {
  std::set<core::BrickCoord> ghosts;
  for (const core::BrickCoord a : bricks) {
    if (table.owner(a) != rank) continue;
    for (const core::BrickCoord b : bricks) {
      if (table.owner(b) != rank && adjacent(a, b)) ghosts.insert(b);
    }
  }
  return ghosts;
}

}  // namespace mpm::parallel::test
