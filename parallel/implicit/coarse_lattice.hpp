// Coarser grids for the unknowns of an implicit step: of nodes in a lattice, those of the lattice of twice
// the spacing from which one of them interpolates linearly. Rigid motions and all linear fields on the fine
// grid are interpolated exactly.
//
// Nodes of several fields may be at one place (components in contact): each field has coarser grids of its
// own.
//
// Components that are given have identity rows in the matrix. Interpolation leaves them out, so that a coarse
// matrix, the Galerkin product, is the stiffness of what can move; a coarse component that reaches given ones
// alone keeps them, and has an identity row in turn.
//
// A coarse node belongs to the lowest rank that interpolates from it. Ranks find out at a rendezvous, a rank
// that follows from the node's place: none holds more than its share. Shown by
// tests/parallel/coarse_lattice.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <mpi.h>

namespace mpm::parallel {

/// Nodes of one grid that this rank owns, numbered consecutively from rank to rank.
struct LatticeNodes {
  std::vector<std::int32_t> places;  ///< three per node
  std::vector<std::int32_t> fields;  ///< by node
  std::vector<std::uint8_t> held;    ///< bits of the components that are given
  std::int64_t first = 0, all = 0;   ///< this rank's first number, and nodes of all ranks
  std::size_t own() const { return held.size(); }
};

/// How own nodes interpolate from coarse ones, any rank's.
struct Interpolation {
  struct Source {
    std::int64_t number;
    std::array<double, 3> weight;  ///< by component
  };
  std::vector<Source> sources;
  std::vector<std::size_t> begin;  ///< by own node, and the end
  std::span<const Source> of(std::size_t node) const {
    return std::span(sources).subspan(begin[node], begin[node + 1] - begin[node]);
  }
};

/// Whether this rank's nodes are within what coarsen() can number: places from -1 to 2^18 - 3, fields to 509.
bool has_keys(const LatticeNodes& nodes);

/// The next coarser grid. Collective.
LatticeNodes coarsen(MPI_Comm comm, const LatticeNodes& fine, Interpolation& interpolation);

}  // namespace mpm::parallel
