// Which methods PETSc takes for the linear systems of a solve, before its own options replace them
// (SNESSetFromOptions), and which others after a failure.
//
// Small problems are solved directly, slender ones by PETSc's own factorisation with the bandwidth reduced,
// others by MUMPS; larger ones by GMRES with multigrid on coarser grids (petsc_hierarchy.hpp), or, where
// nodes are scattered, with smoothed aggregation (GAMG). The single system of a linearised step is solved by
// conjugate gradients, preconditioned with the blocks of the nodes; where it turns out not to be positive
// definite (a law that softens or whose flow is not associated), by GMRES. Where the user names a
// preconditioner that is no factorisation, and no method, small systems are solved by GMRES, too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <petscsnes.h>

#include "parallel/implicit/petsc_hierarchy.hpp"

namespace mpm::parallel {

/// Nodes in the widest level of a slender body, whose systems are solved directly whatever their size: the
/// work grows with their length alone.
inline constexpr std::size_t slender_up_to = 24;

/// Whether such systems are solved with multigrid on coarser grids, and the user has not chosen otherwise.
/// `springs`: NonlinearProblem::has_springs().
bool takes_multigrid(std::int64_t unknowns, bool springs, bool slender);
/// Whether products that are far stiffer than the rest then become further unknowns (petsc_augmented.hpp):
/// unless the user has chosen a method.
bool takes_augmented_system();
void choose_linear_solver(SNES snes, std::int64_t unknowns, bool springs, bool slender,
                          const GridHierarchy* grids);
/// For the one system of a linearised step.
void choose_conjugate_gradients(SNES snes, double tolerance);
/// PETSc's own factorisation does not exchange rows, MUMPS does.
void prefer_pivots(SNES snes);
/// After conjugate gradients that met a matrix that is not positive definite. False: they did not, or the
/// user has chosen.
bool choose_gmres(SNES snes);

/// The names of the methods.
std::string description_of(SNES snes);

}  // namespace mpm::parallel
