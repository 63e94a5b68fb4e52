// A system (K + sum_c k_c e_c e_c^T) u = r whose products are far stiffer than K, as are those of the
// averaged volume changes of nearly incompressible material (core/implicit/averaged_batches.hpp). Multigrid
// for the sum needs hundreds of iterations, since no smoother of single nodes reaches motions without change
// of volume. Solved is the equivalent system
//   K u + sum_c e_c p_c = r,   e_c . u - p_c/k_c = 0
// with an unknown p_c for each product, the mean pressure of a site, by GMRES with the preconditioner
//   p_c = -s_c/S_c,   u = M (r - sum_c e_c p_c),   S_c = 1/k_c + e_c . diag(K)^-1 e_c
// of a right side (r, s), where M is a cycle of multigrid for K (Benzi, Golub and Liesen, Acta Numerica 14
// (2005) 1, section 10). The second equations are multiplied by k_c |e_c|: the norm that GMRES reduces then
// bounds the residual of the sum. What it gains: docs/implicit.md, "Jacobian and linear solver".
#pragma once

#include <cstdint>
#include <functional>

#include <petscsnes.h>

#include "parallel/implicit/petsc_hierarchy.hpp"
#include "parallel/implicit/petsc_matrix.hpp"

namespace mpm::parallel {

class AugmentedSystem {
 public:
  explicit AugmentedSystem(MPI_Comm comm) : comm_(comm) {}
  ~AugmentedSystem() { clear(); }
  AugmentedSystem(const AugmentedSystem&) = delete;
  AugmentedSystem& operator=(const AugmentedSystem&) = delete;

  /// Makes the solver of such systems the preconditioner of the linear solver, which does no more than apply
  /// it. PETSc's options -ksp_... then belong to the solver within.
  void choose(SNES snes);
  /// K and the products of `values`; `grids` precondition K. Collective.
  void take(const MatrixValues& values, GridHierarchy& grids);
  /// Of the solutions since the last call.
  std::int64_t take_iterations();

 private:
  static PetscErrorCode multiply(Mat of, Vec x, Vec y);
  static PetscErrorCode precondition(PC of, Vec x, Vec y);
  static PetscErrorCode solve(PC of, Vec r, Vec u);
  void clear();
  Mat factors(const MatrixValues::Products& products, const std::function<double(double)>& entry) const;
  void find_diagonals(const MatrixValues::Products& products);
  void make_solver();

  MPI_Comm comm_;
  Mat k_ = nullptr;                                                       ///< of the caller
  Mat e_ = nullptr;                                                       ///< a row e_c per product
  Vec compliance_ = nullptr, weight_ = nullptr, schur_ = nullptr;         ///< 1/k_c, k_c |e_c|, S_c
  Vec u_ = nullptr, p_ = nullptr, forces_ = nullptr, volumes_ = nullptr;  ///< for the functions
  Vec right_ = nullptr, solution_ = nullptr;                              ///< (r, s) and (u, p)
  PC multigrid_ = nullptr;
  Mat action_ = nullptr;
  KSP ksp_ = nullptr;
  std::int64_t iterations_ = 0;
};

}  // namespace mpm::parallel
