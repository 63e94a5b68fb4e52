#include "parallel/implicit/petsc_augmented.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "parallel/implicit/petsc_errors.hpp"

namespace mpm::parallel {

namespace {

/// Each rank has its displacements first, then its pressures.
void split(Vec whole, Vec u, Vec p) {
  const PetscScalar* from = nullptr;
  PetscScalar *to_u = nullptr, *to_p = nullptr;
  PetscInt n = 0, m = 0;
  check_petsc(VecGetLocalSize(u, &n));
  check_petsc(VecGetLocalSize(p, &m));
  check_petsc(VecGetArrayRead(whole, &from));
  check_petsc(VecGetArrayWrite(u, &to_u));
  check_petsc(VecGetArrayWrite(p, &to_p));
  std::copy_n(from, n, to_u);
  std::copy_n(from + n, m, to_p);
  check_petsc(VecRestoreArrayWrite(p, &to_p));
  check_petsc(VecRestoreArrayWrite(u, &to_u));
  check_petsc(VecRestoreArrayRead(whole, &from));
}

void join(Vec u, Vec p, Vec whole) {
  const PetscScalar *from_u = nullptr, *from_p = nullptr;
  PetscScalar* to = nullptr;
  PetscInt n = 0, m = 0;
  check_petsc(VecGetLocalSize(u, &n));
  check_petsc(VecGetLocalSize(p, &m));
  check_petsc(VecGetArrayRead(u, &from_u));
  check_petsc(VecGetArrayRead(p, &from_p));
  check_petsc(VecGetArrayWrite(whole, &to));
  std::copy_n(from_u, n, to);
  std::copy_n(from_p, m, to + n);
  check_petsc(VecRestoreArrayWrite(whole, &to));
  check_petsc(VecRestoreArrayRead(p, &from_p));
  check_petsc(VecRestoreArrayRead(u, &from_u));
}

/// f(), for PETSc, through which exceptions must not pass.
template <class F>
PetscErrorCode as_code(F f) {
  try {
    f();
    return 0;
  } catch (const PetscError& error) { return error.code(); } catch (...) {
    return PETSC_ERR_LIB;
  }
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

void AugmentedSystem::choose(KSP ksp) {
  PC pc = nullptr;
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
  if (grids.usable()) {
    grids.choose(multigrid_);
    check_petsc(PCSetFromOptions(multigrid_));
    grids.take(multigrid_, k_);
  } else {
    check_petsc(PCSetType(multigrid_, PCGAMG));
    check_petsc(PCSetFromOptions(multigrid_));
  }
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
  check_petsc(
      KSPGMRESSetRestart(ksp_, 200));  // a restart costs it half; memory is taken as iterations need it
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
  return as_code([&] {
    AugmentedSystem* s = nullptr;
    check_petsc(MatShellGetContext(of, &s));
    split(x, s->u_, s->p_);
    check_petsc(MatMult(s->k_, s->u_, s->forces_));
    check_petsc(MatMultTransposeAdd(s->e_, s->p_, s->forces_, s->forces_));
    check_petsc(MatMult(s->e_, s->u_, s->volumes_));
    check_petsc(VecPointwiseMult(s->p_, s->p_, s->compliance_));
    check_petsc(VecAXPY(s->volumes_, -1, s->p_));
    check_petsc(VecPointwiseMult(s->volumes_, s->volumes_, s->weight_));
    join(s->forces_, s->volumes_, y);
  });
}

PetscErrorCode AugmentedSystem::precondition(PC of, Vec x, Vec y) {
  return as_code([&] {
    AugmentedSystem* s = nullptr;
    check_petsc(PCShellGetContext(of, &s));
    split(x, s->forces_, s->p_);
    check_petsc(VecPointwiseDivide(s->p_, s->p_, s->weight_));
    check_petsc(VecPointwiseDivide(s->p_, s->p_, s->schur_));
    check_petsc(MatMultTransposeAdd(s->e_, s->p_, s->forces_, s->forces_));
    check_petsc(VecScale(s->p_, -1));
    check_petsc(PCApply(s->multigrid_, s->forces_, s->u_));
    join(s->u_, s->p_, y);
  });
}

PetscErrorCode AugmentedSystem::solve(PC of, Vec r, Vec u) {
  return as_code([&] {
    AugmentedSystem* s = nullptr;
    check_petsc(PCShellGetContext(of, &s));
    check_petsc(VecZeroEntries(s->p_));
    join(r, s->p_, s->right_);
    check_petsc(KSPSolve(s->ksp_, s->right_, s->solution_));
    PetscInt iterations = 0;
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    check_petsc(KSPGetIterationNumber(s->ksp_, &iterations));
    check_petsc(KSPGetConvergedReason(s->ksp_, &reason));
    s->iterations_ += iterations;
    split(s->solution_, u, s->p_);
    check_petsc(PCSetFailedReason(of, reason < 0 ? PC_SUBPC_ERROR : PC_NOERROR));
  });
}

}  // namespace mpm::parallel
