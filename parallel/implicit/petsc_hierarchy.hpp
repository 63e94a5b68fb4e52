// Multigrid on a hierarchy of coarser grids (coarse_lattice.hpp) as preconditioner, by PETSc's PCMG: Galerkin
// products, two steps of Chebyshev's method with the nodes' 3 x 3 blocks before and after, and a direct
// solution on the coarsest grid. Against GAMG: docs/implicit.md.
#pragma once

#include <cstdint>
#include <vector>

#include <petscksp.h>

#include "core/implicit/newton_solver.hpp"

namespace mpm::parallel {

class GridHierarchy {
 public:
  /// Collective.
  GridHierarchy(MPI_Comm comm, const core::NonlinearProblem& problem);
  ~GridHierarchy();
  GridHierarchy(const GridHierarchy&) = delete;
  GridHierarchy& operator=(const GridHierarchy&) = delete;

  /// Whether there are coarser grids, and the coarsest is small. It is not where nodes are scattered.
  bool usable() const { return usable_; }
  /// Of the same nodes, on this rank.
  bool is_of(const core::NonlinearProblem& problem) const;
  /// Makes `pc` multigrid on this hierarchy, unless it is; smoothed aggregation (GAMG) where that is not
  /// usable.
  void choose(PC pc) const;
  /// Makes the matrices of the coarser grids from that of the finest one, for `pc`, if that is
  /// multigrid on this hierarchy. Collective.
  void take(PC pc, Mat finest);

 private:
  std::vector<std::int32_t> places_, fields_;
  std::vector<std::uint8_t> held_;
  bool usable_ = false;
  std::vector<Mat> interpolations_;  ///< from the finest grid on
  std::vector<Mat> coarse_;          ///< Galerkin products, in the same order
  Mat rows_ = nullptr;  ///< the finest matrix by rows, where it is not: PETSc has products of such alone
};

}  // namespace mpm::parallel
