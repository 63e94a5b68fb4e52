#include "parallel/implicit/petsc_newton.hpp"

#include <cmath>
#include <string>

#include <mpi.h>

#include "parallel/implicit/petsc_errors.hpp"

namespace mpm::parallel {

namespace {

NewtonSolve& solve_of(void* context) { return *static_cast<NewtonSolve*>(context); }

/// f(), whose exceptions are kept.
template <class F>
PetscErrorCode guarded(NewtonSolve& solve, F f) {
  try {
    f();
    return 0;
  } catch (...) {
    if (!solve.failure) solve.failure = std::current_exception();
    return PETSC_ERR_LIB;
  }
}

/// |r| over the forces that balance in it.
double relative(double norm, const core::NonlinearProblem& problem) {
  const double scale = problem.force_scale();
  return norm == 0 ? 0 : scale > 0 ? norm / scale : norm;
}

PetscErrorCode residual(SNES, Vec u, Vec r, void* context) {
  NewtonSolve& solve = solve_of(context);
  return guarded(solve, [&] {
    const double start = MPI_Wtime();
    const PetscScalar* in = nullptr;
    PetscScalar* out = nullptr;
    PetscInt n = 0;
    check_petsc(VecGetLocalSize(u, &n));
    check_petsc(VecGetArrayRead(u, &in));
    check_petsc(VecGetArray(r, &out));
    const auto size = static_cast<std::size_t>(n);
    solve.usable = solve.problem->residual({in, size}, {out, size});
    if (!solve.usable) {
      // So large that a line search goes back from here, and still finite when squared.
      for (std::size_t i = 0; i < size; ++i) out[i] = 1e100;
    }
    check_petsc(VecRestoreArray(r, &out));
    check_petsc(VecRestoreArrayRead(u, &in));
    if (solve.options->linear) {
      PetscReal norm = 0;
      check_petsc(VecNorm(r, NORM_2, &norm));
      solve.report.norms.push_back(relative(norm, *solve.problem));
    }
    solve.report.residual_seconds += MPI_Wtime() - start;
  });
}

/// Makes the preconditioner here, and not within the solve that follows, so that its time is known.
PetscErrorCode set_up_preconditioner(SNES snes, Mat action, Mat matrix, NewtonSolve& solve) {
  const double start = MPI_Wtime();
  KSP ksp = nullptr;
  PetscErrorCode code = SNESGetKSP(snes, &ksp);
  if (code == 0) code = KSPSetOperators(ksp, action, matrix);
  PC pc = nullptr;
  if (code == 0 && solve.augmented != nullptr) {
    code = guarded(solve, [&] { solve.augmented->take(*solve.values, *solve.grids); });
  } else if (code == 0 && solve.grids != nullptr) {
    code = KSPGetPC(ksp, &pc);
    if (code == 0) code = guarded(solve, [&] { solve.grids->take(pc, matrix); });
  }
  if (code == 0) code = KSPSetUp(ksp);
  solve.report.setup_seconds += MPI_Wtime() - start;
  return code;
}

PetscErrorCode jacobian(SNES snes, Vec u, Mat shell, Mat matrix, void* context) {
  NewtonSolve& solve = solve_of(context);
  MatrixValues& values = *solve.values;
  const PetscErrorCode code = guarded(solve, [&] {
    const double start = MPI_Wtime();
    const PetscScalar* in = nullptr;
    PetscInt n = 0;
    check_petsc(VecGetLocalSize(u, &n));
    check_petsc(VecGetArrayRead(u, &in));
    values.begin();
    solve.problem->jacobian({in, static_cast<std::size_t>(n)}, values);
    values.end();
    check_petsc(VecRestoreArrayRead(u, &in));
    if (shell != matrix) {
      check_petsc(MatAssemblyBegin(shell, MAT_FINAL_ASSEMBLY));
      check_petsc(MatAssemblyEnd(shell, MAT_FINAL_ASSEMBLY));
    }
    solve.report.jacobian_seconds += MPI_Wtime() - start;
  });
  // An error here is one of the method, not of the problem.
  return code == 0 ? set_up_preconditioner(snes, shell, matrix, solve) : code;
}

PetscErrorCode converged(SNES, PetscInt iteration, PetscReal size, PetscReal step, PetscReal norm,
                         SNESConvergedReason* reason, void* context) {
  NewtonSolve& solve = solve_of(context);
  const double scale = solve.problem->force_scale();
  solve.report.norms.push_back(relative(norm, *solve.problem));
  *reason = SNES_CONVERGED_ITERATING;
  if (!std::isfinite(norm) || norm >= 1e99)
    *reason = SNES_DIVERGED_FNORM_NAN;
  else if (norm <= solve.options->relative_tolerance * scale)
    *reason = SNES_CONVERGED_FNORM_RELATIVE;
  else if (norm <= solve.options->absolute_tolerance)
    *reason = SNES_CONVERGED_FNORM_ABS;
  else if (iteration > 0 && step <= 1e-14 * size)
    *reason = SNES_CONVERGED_SNORM_RELATIVE;
  else if (iteration >= solve.options->max_iterations)
    *reason = SNES_DIVERGED_MAX_IT;
  return 0;
}

PetscErrorCode search(SNESLineSearch steps, void* context) {
  constexpr int most_halvings = 12;
  NewtonSolve& solve = solve_of(context);
  return guarded(solve, [&] {
    SNES snes = nullptr;
    Vec x = nullptr, f = nullptr, y = nullptr, w = nullptr, g = nullptr;
    check_petsc(SNESLineSearchGetSNES(steps, &snes));
    check_petsc(SNESLineSearchGetVecs(steps, &x, &f, &y, &w, &g));
    const auto evaluate = [&](double length, Vec at, Vec r) {
      check_petsc(VecWAXPY(at, -length, y, x));
      check_petsc(SNESComputeFunction(snes, at, r));
      PetscReal norm = 0;
      check_petsc(VecNorm(r, NORM_2, &norm));
      return solve.usable && std::isfinite(norm) ? norm : -1.0;
    };
    double length = 1, norm = evaluate(length, w, f);
    for (int i = 0; i < most_halvings && norm < 0; ++i) norm = evaluate(length *= 0.5, w, f);
    if (length < 1 && norm >= 0) {
      const double nearer = evaluate(0.5 * length, w, g);
      if (nearer >= 0 && nearer < norm) length *= 0.5;
    }
    check_petsc(VecWAXPY(w, -length, y, x));
    if (length < 1) check_petsc(SNESComputeFunction(snes, w, f));
    check_petsc(VecCopy(w, x));
    check_petsc(VecScale(y, length));
    check_petsc(SNESLineSearchSetLambda(steps, length));
    check_petsc(SNESLineSearchComputeNorms(steps));
    check_petsc(SNESLineSearchSetReason(steps, SNES_LINESEARCH_SUCCEEDED));
  });
}

}  // namespace

bool is_small(double norm, const NewtonSolve& solve) {
  const core::NewtonOptions& options = *solve.options;
  return norm <= options.relative_tolerance * solve.problem->force_scale() ||
         norm <= options.absolute_tolerance;
}

void set_functions(SNES snes, Vec r, NewtonSolve& solve) {
  check_petsc(SNESSetFunction(snes, r, residual, &solve));
  check_petsc(SNESSetConvergenceTest(snes, converged, &solve, nullptr));
}

void set_jacobian(SNES snes, Mat action, Mat matrix, NewtonSolve& solve) {
  check_petsc(SNESSetJacobian(snes, action, matrix, jacobian, &solve));
}

void choose_full_steps(SNES snes, NewtonSolve& solve) {
  SNESLineSearch steps = nullptr;
  check_petsc(SNESGetLineSearch(snes, &steps));
  check_petsc(SNESLineSearchSetType(steps, SNESLINESEARCHSHELL));
  check_petsc(SNESLineSearchShellSetUserFunc(steps, search, &solve));
}

bool takes_full_steps(SNES snes) {
  SNESType method = nullptr;
  SNESLineSearch steps = nullptr;
  SNESLineSearchType search = nullptr;
  check_petsc(SNESGetType(snes, &method));
  check_petsc(SNESGetLineSearch(snes, &steps));
  check_petsc(SNESLineSearchGetType(steps, &search));
  return std::string(method) == SNESNEWTONLS && search != nullptr &&
         std::string(search) == SNESLINESEARCHSHELL;
}

bool choose_line_search(SNES snes) {
  PetscBool chosen = PETSC_FALSE;
  SNESType method = nullptr;
  check_petsc(PetscOptionsHasName(nullptr, nullptr, "-snes_linesearch_type", &chosen));
  check_petsc(SNESGetType(snes, &method));
  if (chosen || std::string(method) != SNESNEWTONLS) return false;
  SNESLineSearch steps = nullptr;
  check_petsc(SNESGetLineSearch(snes, &steps));
  check_petsc(SNESLineSearchSetType(steps, SNESLINESEARCHBT));
  return true;
}

}  // namespace mpm::parallel
