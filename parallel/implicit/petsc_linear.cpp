#include "parallel/implicit/petsc_linear.hpp"

#include <fmt/format.h>

#include "parallel/implicit/petsc_errors.hpp"
#include "parallel/implicit/petsc_options.hpp"

namespace mpm::parallel {

namespace {

/// Unknowns up to which systems are solved directly; with stiff springs, at which multigrid may fail.
constexpr std::int64_t direct_up_to = 5000, direct_with_springs = 50000;

bool few(std::int64_t unknowns, bool springs) {
  return unknowns <= (springs ? direct_with_springs : direct_up_to);
}

/// Whether a preconditioner solves the system by itself.
bool is_factorisation(const std::string& preconditioner) {
  return preconditioner == PCLU || preconditioner == PCCHOLESKY;
}

}  // namespace

bool takes_multigrid(std::int64_t unknowns, bool springs, bool slender) {
  return !few(unknowns, springs) && !slender && !option_value("-pc_type");
}

bool takes_augmented_system() { return !option_value("-ksp_type"); }

void choose_linear_solver(SNES snes, std::int64_t unknowns, bool springs, bool slender,
                          const GridHierarchy* grids) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  check_petsc(SNESGetKSP(snes, &ksp));
  check_petsc(KSPGetPC(ksp, &pc));
  const std::optional<std::string> named = option_value("-pc_type");
  // What is no factorisation needs iterations, and has no package that makes one.
  if ((few(unknowns, springs) || slender) && (!named || is_factorisation(*named))) {
    check_petsc(KSPSetType(ksp, KSPPREONLY));
    check_petsc(PCSetType(pc, PCLU));
    // A package that the user has named is not changed: in a later solution PETSc refuses that.
    // MUMPS orders the matrix itself, too: it has refused PETSc's ordering.
    if (!option_value("-pc_factor_mat_solver_type")) {
      check_petsc(PCFactorSetMatSolverType(pc, slender ? MATSOLVERPETSC : MATSOLVERMUMPS));
      if (slender) check_petsc(PCFactorSetMatOrderingType(pc, MATORDERINGRCM));
    }
  } else {
    check_petsc(KSPSetType(ksp, KSPGMRES));
    check_petsc(KSPGMRESSetRestart(ksp, 60));
    check_petsc(KSPSetTolerances(ksp, 1e-5, PETSC_DEFAULT, PETSC_DEFAULT, 1000));
    if (grids != nullptr)
      grids->choose(pc);
    else if (!named)
      check_petsc(PCSetType(pc, PCGAMG));
  }
}

void choose_conjugate_gradients(SNES snes, double tolerance) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  check_petsc(SNESSetType(snes, SNESKSPONLY));
  check_petsc(SNESGetKSP(snes, &ksp));
  check_petsc(KSPGetPC(ksp, &pc));
  check_petsc(KSPSetType(ksp, KSPCG));
  check_petsc(KSPSetTolerances(ksp, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, 10000));
  check_petsc(PCSetType(pc, PCPBJACOBI));
}

void prefer_pivots(SNES snes) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  PCType type = nullptr;
  MatSolverType solver = nullptr;
  check_petsc(SNESGetKSP(snes, &ksp));
  check_petsc(KSPGetPC(ksp, &pc));
  check_petsc(PCGetType(pc, &type));
  if (!is_factorisation(type)) return;
  check_petsc(PCFactorGetMatSolverType(pc, &solver));
  if (solver == nullptr || std::string(solver) != MATSOLVERPETSC) return;
  check_petsc(PCReset(pc));
  check_petsc(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check_petsc(PCFactorSetMatOrderingType(pc, MATORDERINGEXTERNAL));
}

bool choose_gmres(SNES snes) {
  KSP ksp = nullptr;
  KSPConvergedReason why = KSP_CONVERGED_ITERATING;
  check_petsc(SNESGetKSP(snes, &ksp));
  check_petsc(KSPGetConvergedReason(ksp, &why));
  if (option_value("-ksp_type") || (why != KSP_DIVERGED_INDEFINITE_MAT && why != KSP_DIVERGED_INDEFINITE_PC &&
                                    why != KSP_DIVERGED_BREAKDOWN))
    return false;
  check_petsc(KSPSetType(ksp, KSPGMRES));
  return true;
}

std::string description_of(SNES snes) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  check_petsc(SNESGetKSP(snes, &ksp));
  check_petsc(KSPGetPC(ksp, &pc));
  KSPType solver = nullptr;
  PCType preconditioner = nullptr;
  check_petsc(KSPGetType(ksp, &solver));
  check_petsc(PCGetType(pc, &preconditioner));
  SNESType method = nullptr;
  check_petsc(SNESGetType(snes, &method));
  const std::string name = method;
  const char* whole = nullptr;  // a solver within
  if (std::string(preconditioner) == PCSHELL) check_petsc(PCShellGetName(pc, &whole));
  const bool usual = name == SNESNEWTONLS || name == SNESKSPONLY;
  return fmt::format("PETSc {}.{}.{}: {}{}", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR,
                     usual ? "" : name + ", ",
                     whole != nullptr ? whole : fmt::format("{} with {}", solver, preconditioner));
}

}  // namespace mpm::parallel
