#include "parallel/implicit/petsc_augmented.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "parallel/implicit/petsc_errors.hpp"

namespace mpm::parallel {

namespace {

/// Each rank has its displacements first, then its pressures. Errors are codes here and in the functions that
/// PETSc calls, so that its own words reach the log.
PetscErrorCode split(Vec whole, Vec u, Vec p) {
  const PetscScalar* from = nullptr;
  PetscScalar *to_u = nullptr, *to_p = nullptr;
  PetscInt n = 0, m = 0;
  PetscCall(VecGetLocalSize(u, &n));
  PetscCall(VecGetLocalSize(p, &m));
  PetscCall(VecGetArrayRead(whole, &from));
  PetscCall(VecGetArrayWrite(u, &to_u));
  PetscCall(VecGetArrayWrite(p, &to_p));
  std::copy_n(from, n, to_u);
  std::copy_n(from + n, m, to_p);
  PetscCall(VecRestoreArrayWrite(p, &to_p));
  PetscCall(VecRestoreArrayWrite(u, &to_u));
  PetscCall(VecRestoreArrayRead(whole, &from));
  return 0;
}

PetscErrorCode join(Vec u, Vec p, Vec whole) {
  const PetscScalar *from_u = nullptr, *from_p = nullptr;
  PetscScalar* to = nullptr;
  PetscInt n = 0, m = 0;
  PetscCall(VecGetLocalSize(u, &n));
  PetscCall(VecGetLocalSize(p, &m));
  PetscCall(VecGetArrayRead(u, &from_u));
  PetscCall(VecGetArrayRead(p, &from_p));
  PetscCall(VecGetArrayWrite(whole, &to));
  std::copy_n(from_u, n, to);
  std::copy_n(from_p, m, to + n);
  PetscCall(VecRestoreArrayWrite(whole, &to));
  PetscCall(VecRestoreArrayRead(p, &from_p));
  PetscCall(VecRestoreArrayRead(u, &from_u));
  return 0;
}

}  // namespace

void AugmentedSystem::clear() {
  KSPDestroy(&ksp_);
  PCDestroy(&multigrid_);
  MatDestroy(&action_);
  MatDestroy(&e_);
  for (Vec* v : {&compliance_, &weight_, &schur_, &u_, &p_, &forces_, &volumes_, &right_, &solution_})
    VecDestroy(v);
}

std::int64_t AugmentedSystem::take_iterations() { return std::exchange(iterations_, 0); }

void AugmentedSystem::choose(SNES snes) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  check_petsc(SNESGetKSP(snes, &ksp));
  check_petsc(KSPSetOptionsPrefix(ksp, "outer_"));
  check_petsc(KSPSetType(ksp, KSPPREONLY));
  check_petsc(KSPGetPC(ksp, &pc));
  check_petsc(PCSetType(pc, PCSHELL));
  check_petsc(PCShellSetName(pc, "gmres with mg, mean pressures as further unknowns"));
  check_petsc(PCShellSetContext(pc, this));
  check_petsc(PCShellSetApply(pc, solve));
}

void AugmentedSystem::take(const MatrixValues& values, GridHierarchy& grids) {
  clear();
  k_ = values.matrix();
  e_ = factors(values.products(), [](double e) { return e; });
  check_petsc(MatCreateVecs(e_, &u_, &p_));
  check_petsc(VecDuplicate(u_, &forces_));
  for (Vec* v : {&compliance_, &weight_, &schur_, &volumes_}) check_petsc(VecDuplicate(p_, v));
  find_diagonals(values.products());
  check_petsc(PCCreate(comm_, &multigrid_));
  check_petsc(PCSetOperators(multigrid_, k_, k_));
  grids.choose(multigrid_);
  check_petsc(PCSetFromOptions(multigrid_));
  grids.take(multigrid_, k_);
  check_petsc(PCSetUp(multigrid_));
  make_solver();
}

/// A row of entry(e) per product.
Mat AugmentedSystem::factors(const MatrixValues::Products& products,
                             const std::function<double(double)>& entry) const {
  PetscInt own = 0, all = 0, begin = 0, end = 0;
  check_petsc(MatGetLocalSize(k_, &own, nullptr));
  check_petsc(MatGetSize(k_, &all, nullptr));
  check_petsc(MatGetOwnershipRange(k_, &begin, &end));
  const std::size_t count = products.stiffness.size();
  std::vector<PetscInt> inside(count), outside(count), columns;
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t i = products.first[c]; i < products.first[c + 1]; ++i) {
      const std::int64_t column = 3 * products.nodes[i];
      (column >= begin && column < end ? inside : outside)[c] += 3;
    }
  }
  Mat matrix = nullptr;
  check_petsc(MatCreateAIJ(comm_, static_cast<PetscInt>(count), own, PETSC_DETERMINE, all, 0, inside.data(),
                           0, outside.data(), &matrix));
  PetscInt row = 0;
  check_petsc(MatGetOwnershipRange(matrix, &row, nullptr));
  std::vector<PetscScalar> entries;
  for (std::size_t c = 0; c < count; ++c, ++row) {
    columns.clear();
    entries.clear();
    for (std::size_t i = products.first[c]; i < products.first[c + 1]; ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        columns.push_back(static_cast<PetscInt>(3 * products.nodes[i]) + static_cast<PetscInt>(a));
        entries.push_back(entry(products.factors[3 * i + a]));
      }
    }
    check_petsc(MatSetValues(matrix, 1, &row, static_cast<PetscInt>(columns.size()), columns.data(),
                             entries.data(), INSERT_VALUES));
  }
  check_petsc(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  return matrix;
}

void AugmentedSystem::find_diagonals(const MatrixValues::Products& products) {
  PetscScalar* to = nullptr;
  check_petsc(VecGetArrayWrite(compliance_, &to));
  std::ranges::transform(products.stiffness, to, [](double k) { return 1 / k; });
  check_petsc(VecRestoreArrayWrite(compliance_, &to));

  Mat squares = factors(products, [](double e) { return e * e; });
  check_petsc(VecSet(u_, 1));
  check_petsc(MatMult(squares, u_, weight_));
  check_petsc(VecSqrtAbs(weight_));
  check_petsc(VecPointwiseDivide(weight_, weight_, compliance_));

  check_petsc(MatGetDiagonal(k_, u_));
  check_petsc(VecReciprocal(u_));
  check_petsc(MatMult(squares, u_, schur_));
  check_petsc(VecAXPY(schur_, 1, compliance_));
  check_petsc(MatDestroy(&squares));
}

void AugmentedSystem::make_solver() {
  PetscInt displacements = 0, pressures = 0;
  check_petsc(VecGetLocalSize(u_, &displacements));
  check_petsc(VecGetLocalSize(p_, &pressures));
  const PetscInt both = displacements + pressures;
  check_petsc(VecCreateMPI(comm_, both, PETSC_DETERMINE, &right_));
  check_petsc(VecDuplicate(right_, &solution_));
  check_petsc(MatCreateShell(comm_, both, both, PETSC_DETERMINE, PETSC_DETERMINE, this, &action_));
  check_petsc(MatShellSetOperation(action_, MATOP_MULT, reinterpret_cast<void (*)()>(multiply)));
  check_petsc(KSPCreate(comm_, &ksp_));
  check_petsc(KSPSetOperators(ksp_, action_, action_));
  check_petsc(KSPSetType(ksp_, KSPGMRES));
  // A restart costs up to half of what has been gained; memory is taken as iterations need it.
  check_petsc(KSPGMRESSetRestart(ksp_, 200));
  check_petsc(KSPSetPCSide(ksp_, PC_RIGHT));
  check_petsc(KSPSetTolerances(ksp_, 1e-5, PETSC_DEFAULT, PETSC_DEFAULT, 1000));
  PC pc = nullptr;
  check_petsc(KSPGetPC(ksp_, &pc));
  check_petsc(PCSetType(pc, PCSHELL));
  check_petsc(PCShellSetContext(pc, this));
  check_petsc(PCShellSetApply(pc, precondition));
  check_petsc(KSPSetFromOptions(ksp_));
}

PetscErrorCode AugmentedSystem::multiply(Mat of, Vec x, Vec y) {
  AugmentedSystem* s = nullptr;
  PetscCall(MatShellGetContext(of, &s));
  PetscCall(split(x, s->u_, s->p_));
  PetscCall(MatMult(s->k_, s->u_, s->forces_));
  PetscCall(MatMultTransposeAdd(s->e_, s->p_, s->forces_, s->forces_));
  PetscCall(MatMult(s->e_, s->u_, s->volumes_));
  PetscCall(VecPointwiseMult(s->p_, s->p_, s->compliance_));
  PetscCall(VecAXPY(s->volumes_, -1, s->p_));
  PetscCall(VecPointwiseMult(s->volumes_, s->volumes_, s->weight_));
  PetscCall(join(s->forces_, s->volumes_, y));
  return 0;
}

PetscErrorCode AugmentedSystem::precondition(PC of, Vec x, Vec y) {
  AugmentedSystem* s = nullptr;
  PetscCall(PCShellGetContext(of, &s));
  PetscCall(split(x, s->forces_, s->p_));
  PetscCall(VecPointwiseDivide(s->p_, s->p_, s->weight_));
  PetscCall(VecPointwiseDivide(s->p_, s->p_, s->schur_));
  PetscCall(MatMultTransposeAdd(s->e_, s->p_, s->forces_, s->forces_));
  PetscCall(VecScale(s->p_, -1));
  PetscCall(PCApply(s->multigrid_, s->forces_, s->u_));
  PetscCall(join(s->u_, s->p_, y));
  return 0;
}

PetscErrorCode AugmentedSystem::solve(PC of, Vec r, Vec u) {
  AugmentedSystem* s = nullptr;
  PetscCall(PCShellGetContext(of, &s));
  PetscCall(VecZeroEntries(s->p_));
  PetscCall(join(r, s->p_, s->right_));
  PetscCall(KSPSolve(s->ksp_, s->right_, s->solution_));
  PetscInt iterations = 0;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscCall(KSPGetIterationNumber(s->ksp_, &iterations));
  PetscCall(KSPGetConvergedReason(s->ksp_, &reason));
  s->iterations_ += iterations;
  PetscCall(split(s->solution_, u, s->p_));
  PetscCall(PCSetFailedReason(of, reason < 0 ? PC_SUBPC_ERROR : PC_NOERROR));
  return 0;
}

}  // namespace mpm::parallel
