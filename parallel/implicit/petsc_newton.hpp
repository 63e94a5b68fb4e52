// Newton's method in PETSc's SNES: the functions that it calls (residual, Jacobian, test of convergence,
// length of a step), and how it takes its steps. All see the solve through one record.
#pragma once

#include <exception>

#include <petscsnes.h>

#include "core/implicit/newton_solver.hpp"
#include "parallel/implicit/petsc_augmented.hpp"
#include "parallel/implicit/petsc_hierarchy.hpp"
#include "parallel/implicit/petsc_matrix.hpp"

namespace mpm::parallel {

/// What the functions see of a solve.
struct NewtonSolve {
  core::NonlinearProblem* problem = nullptr;
  const core::NewtonOptions* options = nullptr;
  MatrixValues* values = nullptr;
  GridHierarchy* grids = nullptr;        ///< null without
  AugmentedSystem* augmented = nullptr;  ///< null without
  core::NewtonReport report;
  std::exception_ptr failure;  ///< of the problem; must not pass through PETSc
  bool usable = true;          ///< the last state could be evaluated
};

/// `solve` has to stay where it is as long as `snes` is used.
void set_functions(SNES snes, Vec residual, NewtonSolve& solve);
/// `action`: the matrix itself, or its product with a vector by differences.
void set_jacobian(SNES snes, Mat action, Mat matrix, NewtonSolve& solve);

/// Whether `norm`, of the last residual, is within the tolerances.
bool is_small(double norm, const NewtonSolve& solve);

/// Full steps: a residual that grows once, as in bending, is no harm to them, but stops a search that lets it
/// fall alone.
void choose_full_steps(SNES snes, NewtonSolve& solve);
bool takes_full_steps(SNES snes);
/// A search, where full steps failed. False: the user has chosen how steps are taken.
bool choose_line_search(SNES snes);

}  // namespace mpm::parallel
