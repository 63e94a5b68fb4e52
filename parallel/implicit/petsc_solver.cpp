// Newton's method by PETSc's SNES (core/implicit/newton_solver.hpp), in a library of its own that is loaded
// when a scene is implicit: explicit runs neither load nor start PETSc.
//
// Small problems are solved directly, slender ones by PETSc's own factorisation with the bandwidth reduced,
// others by MUMPS; larger ones by GMRES with smoothed aggregation multigrid
// (GAMG), which is told the rigid motions. The single system of a linearised step is solved by conjugate
// gradients, preconditioned with the blocks of the nodes; where it turns out not to be positive definite (a
// law that softens or whose flow is not associated), by GMRES. All can be replaced by PETSc's own options,
// after -- on the command line.
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <mpi.h>
#include <petscsnes.h>

#include "core/implicit/newton_solver.hpp"
#include "parallel/implicit/petsc_matrix.hpp"
#include "parallel/implicit/solver_library.hpp"

namespace mpm::parallel {

namespace {

/// PETSc's description of the first error, instead of a stack from every rank.
std::string first_error;  // NOLINT: PETSc's handlers have no state of their own that survives

}  // namespace

void check_petsc(PetscErrorCode code) {
  if (code == 0) return;
  const std::string what =
      first_error.empty() ? fmt::format("PETSc error {}", static_cast<int>(code)) : first_error;
  first_error.clear();
  throw std::runtime_error("PETSc: " + what);
}

namespace {

using core::NewtonOptions;
using core::NewtonReport;
using core::NonlinearProblem;

/// Unknowns up to which systems are solved directly.
constexpr std::int64_t direct_up_to = 5000;
/// Nodes in the widest level of a slender body, whose systems are solved directly whatever their size: the
/// work grows with their length alone.
constexpr std::size_t slender_up_to = 24;

PetscErrorCode keep_error(MPI_Comm, int, const char* function, const char*, PetscErrorCode code,
                          PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL || first_error.empty())
    first_error = fmt::format("{} (in PETSc's {})", message != nullptr ? message : "", function);
  return code;
}

void check(PetscErrorCode code) { check_petsc(code); }

/// Releases a PETSc object at the end of a scope.
template <class Object, PetscErrorCode (*destroy)(Object*)>
struct Owned {
  Object object = nullptr;
  Owned() = default;
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  ~Owned() { destroy(&object); }
  Object* operator&() { return &object; }
  operator Object() const { return object; }
};
using OwnedVec = Owned<Vec, VecDestroy>;
using OwnedMat = Owned<Mat, MatDestroy>;
using OwnedSnes = Owned<SNES, SNESDestroy>;
using OwnedNullSpace = Owned<MatNullSpace, MatNullSpaceDestroy>;

class PetscSolver final : public core::NewtonSolver {
 public:
  PetscSolver(MPI_Comm comm, const std::vector<std::string>& options) {
    check(static_cast<PetscErrorCode>(MPI_Comm_dup(comm, &comm_)));
    PETSC_COMM_WORLD = comm_;
    words_.push_back("mpm");
    words_.insert(words_.end(), options.begin(), options.end());
    for (std::string& w : words_) pointers_.push_back(w.data());
    pointers_.push_back(nullptr);
    int argc = static_cast<int>(words_.size());
    char** argv = pointers_.data();
    PetscOptionsSetValue(nullptr, "-no_signal_handler", nullptr);
    PetscOptionsSetValue(nullptr, "-options_left", "no");
    check(PetscInitialize(&argc, &argv, nullptr, nullptr));
    check(PetscPushErrorHandler(keep_error, nullptr));
    given_ = !options.empty();
  }
  ~PetscSolver() override {
    of_.reset();
    PetscPopErrorHandler();
    PetscFinalize();
    MPI_Comm_free(&comm_);
  }
  PetscSolver(const PetscSolver&) = delete;
  PetscSolver& operator=(const PetscSolver&) = delete;

  NewtonReport solve(NonlinearProblem& problem, std::span<double> u, const NewtonOptions& options) override;
  std::string description() const override { return description_; }

 private:
  /// What PETSc's callbacks see of a solve.
  struct Solve {
    NonlinearProblem& problem;
    const NewtonOptions& options;
    NewtonReport report;
    std::exception_ptr failure;  ///< must not pass through PETSc
    bool usable = true;          ///< the last state could be evaluated
  };
  /// f(), whose exceptions are kept.
  template <class F>
  static PetscErrorCode guarded(Solve& solve, F f) {
    try {
      f();
      return 0;
    } catch (...) {
      if (!solve.failure) solve.failure = std::current_exception();
      return PETSC_ERR_LIB;
    }
  }
  static PetscErrorCode residual(SNES, Vec u, Vec r, void* context);
  static PetscErrorCode jacobian(SNES, Vec u, Mat, Mat matrix, void* context);
  static PetscErrorCode converged(SNES, PetscInt iteration, PetscReal, PetscReal step, PetscReal norm,
                                  SNESConvergedReason* reason, void* context);

  static PetscErrorCode search(SNESLineSearch steps, void* context);

  static double relative(double norm, const NonlinearProblem& problem);
  void set_up(NonlinearProblem& problem);
  static void give_rigid_motions(const NonlinearProblem& problem, Mat matrix);
  void choose_linear_solver(SNES snes, std::int64_t unknowns);
  void choose_conjugate_gradients(SNES snes, double tolerance);
  void describe(SNES snes);
  void prefer_pivots(SNES snes);
  bool try_otherwise(SNES snes, const NewtonOptions& options);
  void refuse_unused_options();

  /// What solves with the same places of entries share: PETSc keeps the symbolic part of a factorisation.
  struct SetUp {
    std::unique_ptr<MatrixValues> values;
    bool slender = false;  ///< as is a bar of few nodes across, on one rank
    OwnedVec solution, residual;
    OwnedMat action;
    OwnedSnes snes;
  };

  MPI_Comm comm_ = MPI_COMM_NULL;
  std::unique_ptr<SetUp> of_;
  Solve* now_ = nullptr;  ///< within solve()
  std::vector<std::string> words_;
  std::vector<char*> pointers_;
  std::string description_;
  bool given_ = false, looked_ = false;
  bool chose_full_steps_ = false;  ///< the user has not chosen how Newton's steps are taken
};

PetscErrorCode PetscSolver::residual(SNES, Vec u, Vec r, void* context) {
  Solve& solve = *static_cast<PetscSolver*>(context)->now_;
  return guarded(solve, [&] {
    const double start = MPI_Wtime();
    const PetscScalar* in = nullptr;
    PetscScalar* out = nullptr;
    PetscInt n = 0;
    check(VecGetLocalSize(u, &n));
    check(VecGetArrayRead(u, &in));
    check(VecGetArray(r, &out));
    const auto size = static_cast<std::size_t>(n);
    solve.usable = solve.problem.residual({in, size}, {out, size});
    if (!solve.usable) {
      // So large that a line search goes back from here, and still finite when squared.
      for (std::size_t i = 0; i < size; ++i) out[i] = 1e100;
    }
    check(VecRestoreArray(r, &out));
    check(VecRestoreArrayRead(u, &in));
    if (solve.options.linear) {
      PetscReal norm = 0;
      check(VecNorm(r, NORM_2, &norm));
      solve.report.norms.push_back(relative(norm, solve.problem));
    }
    solve.report.residual_seconds += MPI_Wtime() - start;
  });
}

PetscErrorCode PetscSolver::jacobian(SNES, Vec u, Mat shell, Mat matrix, void* context) {
  MatrixValues& values = *static_cast<PetscSolver*>(context)->of_->values;
  Solve& solve = *static_cast<PetscSolver*>(context)->now_;
  return guarded(solve, [&] {
    const double start = MPI_Wtime();
    const PetscScalar* in = nullptr;
    PetscInt n = 0;
    check(VecGetLocalSize(u, &n));
    check(VecGetArrayRead(u, &in));
    values.begin();
    solve.problem.jacobian({in, static_cast<std::size_t>(n)}, values);
    values.end();
    check(VecRestoreArrayRead(u, &in));
    if (shell != matrix) {
      check(MatAssemblyBegin(shell, MAT_FINAL_ASSEMBLY));
      check(MatAssemblyEnd(shell, MAT_FINAL_ASSEMBLY));
    }
    solve.report.jacobian_seconds += MPI_Wtime() - start;
  });
}

/// |r| over the forces that balance in it.
double PetscSolver::relative(double norm, const NonlinearProblem& problem) {
  const double scale = problem.force_scale();
  return norm == 0 ? 0 : scale > 0 ? norm / scale : norm;
}

/// |r| against the forces that balance in it; or steps that are rounding errors.
PetscErrorCode PetscSolver::converged(SNES snes, PetscInt iteration, PetscReal size, PetscReal step,
                                      PetscReal norm, SNESConvergedReason* reason, void* context) {
  Solve& solve = *static_cast<PetscSolver*>(context)->now_;
  const double scale = solve.problem.force_scale();
  solve.report.norms.push_back(relative(norm, solve.problem));
  *reason = SNES_CONVERGED_ITERATING;
  if (!std::isfinite(norm) || norm >= 1e99)
    *reason = SNES_DIVERGED_FNORM_NAN;
  else if (norm <= solve.options.relative_tolerance * scale)
    *reason = SNES_CONVERGED_FNORM_RELATIVE;
  else if (norm <= solve.options.absolute_tolerance)
    *reason = SNES_CONVERGED_FNORM_ABS;
  else if (iteration > 0 && step <= 1e-14 * size)
    *reason = SNES_CONVERGED_SNORM_RELATIVE;
  else if (iteration >= solve.options.max_iterations)
    *reason = SNES_DIVERGED_MAX_IT;
  (void)snes;
  return 0;
}

/// A full step, halved until no particle inverts. Of two such lengths the one with the smaller residual:
/// close to an inversion forces are large and their derivative tells little.
PetscErrorCode PetscSolver::search(SNESLineSearch steps, void* context) {
  constexpr int most_halvings = 12;
  Solve& solve = *static_cast<PetscSolver*>(context)->now_;
  return guarded(solve, [&] {
    SNES snes = nullptr;
    Vec x = nullptr, f = nullptr, y = nullptr, w = nullptr, g = nullptr;
    check(SNESLineSearchGetSNES(steps, &snes));
    check(SNESLineSearchGetVecs(steps, &x, &f, &y, &w, &g));
    const auto evaluate = [&](double length, Vec at, Vec r) {
      check(VecWAXPY(at, -length, y, x));
      check(SNESComputeFunction(snes, at, r));
      PetscReal norm = 0;
      check(VecNorm(r, NORM_2, &norm));
      return solve.usable && std::isfinite(norm) ? norm : -1.0;
    };
    double length = 1, norm = evaluate(length, w, f);
    for (int i = 0; i < most_halvings && norm < 0; ++i) norm = evaluate(length *= 0.5, w, f);
    if (length < 1 && norm >= 0) {
      const double nearer = evaluate(0.5 * length, w, g);
      if (nearer >= 0 && nearer < norm) length *= 0.5;
    }
    check(VecWAXPY(w, -length, y, x));
    if (length < 1) check(SNESComputeFunction(snes, w, f));
    check(VecCopy(w, x));
    check(VecScale(y, length));
    check(SNESLineSearchSetLambda(steps, length));
    check(SNESLineSearchComputeNorms(steps));
    check(SNESLineSearchSetReason(steps, SNES_LINESEARCH_SUCCEEDED));
  });
}

/// The matrix and the solver, or those of the last solve where the places of the entries are the same.
void PetscSolver::set_up(NonlinearProblem& problem) {
  MatrixPlaces places(problem.first_node(), problem.own_nodes());
  problem.structure(places);
  for (std::int64_t i = 0; i < problem.own_nodes(); ++i) {
    const std::int64_t number = problem.first_node() + i;
    places.add(std::span(&number, 1), nullptr);
  }
  places.exchange(comm_);
  int same = of_ && of_->values->places().same_as(places) ? 1 : 0;
  check(static_cast<PetscErrorCode>(MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, comm_)));
  if (same == 0) {
    of_ = std::make_unique<SetUp>();
    int ranks = 0;
    check(static_cast<PetscErrorCode>(MPI_Comm_size(comm_, &ranks)));
    of_->slender = ranks == 1 && places.widest_level() <= slender_up_to;
    of_->values = std::make_unique<MatrixValues>(comm_, std::move(places), problem.all_nodes());
    check(MatCreateVecs(of_->values->matrix(), &of_->solution, &of_->residual));
    check(SNESCreate(comm_, &of_->snes));
    check(SNESSetFunction(of_->snes, of_->residual, residual, this));
    check(SNESSetConvergenceTest(of_->snes, converged, this, nullptr));
  }
  give_rigid_motions(problem, of_->values->matrix());
}

void PetscSolver::give_rigid_motions(const NonlinearProblem& problem, Mat matrix) {
  OwnedVec coordinates;
  check(MatCreateVecs(matrix, &coordinates, nullptr));
  check(VecSetBlockSize(coordinates, 3));
  PetscScalar* to = nullptr;
  check(VecGetArray(coordinates, &to));
  const std::span<const double> from = problem.coordinates();
  std::copy(from.begin(), from.end(), to);
  check(VecRestoreArray(coordinates, &to));
  OwnedNullSpace rigid;
  check(MatNullSpaceCreateRigidBody(coordinates, &rigid));
  check(MatSetNearNullSpace(matrix, rigid));
}

void PetscSolver::choose_linear_solver(SNES snes, std::int64_t unknowns) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(SNESGetKSP(snes, &ksp));
  check(KSPGetPC(ksp, &pc));
  if (unknowns <= direct_up_to || of_->slender) {
    check(KSPSetType(ksp, KSPPREONLY));
    check(PCSetType(pc, PCLU));
    // A package that the user has named is not changed: in a later solution PETSc refuses that.
    PetscBool named = PETSC_FALSE;
    check(PetscOptionsHasName(nullptr, nullptr, "-pc_factor_mat_solver_type", &named));
    if (named == PETSC_FALSE)
      check(PCFactorSetMatSolverType(pc, of_->slender ? MATSOLVERPETSC : MATSOLVERMUMPS));
    if (of_->slender) check(PCFactorSetMatOrderingType(pc, MATORDERINGRCM));
  } else {
    check(KSPSetType(ksp, KSPGMRES));
    check(KSPGMRESSetRestart(ksp, 60));
    check(KSPSetTolerances(ksp, 1e-5, PETSC_DEFAULT, PETSC_DEFAULT, 1000));
    check(PCSetType(pc, PCGAMG));
  }
  // Full steps first: a residual that grows once, as in bending, is no harm to them, but stops a search that
  // lets it fall alone. Where they fail, a search is tried.
  PetscBool chosen = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, nullptr, "-snes_linesearch_type", &chosen));
  SNESLineSearch steps = nullptr;
  check(SNESGetLineSearch(snes, &steps));
  check(SNESLineSearchSetType(steps, SNESLINESEARCHSHELL));
  check(SNESLineSearchShellSetUserFunc(steps, search, this));
  check(SNESSetFromOptions(snes));
  SNESType method = nullptr;
  check(SNESGetType(snes, &method));
  chose_full_steps_ = chosen == PETSC_FALSE && std::string(method) == SNESNEWTONLS;
  describe(snes);
}

void PetscSolver::choose_conjugate_gradients(SNES snes, double tolerance) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(SNESSetType(snes, SNESKSPONLY));
  check(SNESGetKSP(snes, &ksp));
  check(KSPGetPC(ksp, &pc));
  check(KSPSetType(ksp, KSPCG));
  check(KSPSetTolerances(ksp, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, 10000));
  check(PCSetType(pc, PCPBJACOBI));
  check(SNESSetFromOptions(snes));
  describe(snes);
}

/// PETSc's own factorisation does not exchange rows, MUMPS does.
void PetscSolver::prefer_pivots(SNES snes) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  MatSolverType solver = nullptr;
  check(SNESGetKSP(snes, &ksp));
  check(KSPGetPC(ksp, &pc));
  check(PCFactorGetMatSolverType(pc, &solver));
  of_->slender = false;
  if (solver == nullptr || std::string(solver) != MATSOLVERPETSC) return;
  check(PCReset(pc));
  check(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  check(PCFactorSetMatOrderingType(pc, MATORDERINGEXTERNAL));
}

/// Takes another method after a failure: a line search, and pivots, after full steps, GMRES after conjugate
/// gradients that met a matrix that is not positive definite. False: there is none, or the user has chosen.
bool PetscSolver::try_otherwise(SNES snes, const NewtonOptions& options) {
  if (!options.linear) {
    if (!chose_full_steps_) return false;
    SNESLineSearch steps = nullptr;
    check(SNESGetLineSearch(snes, &steps));
    check(SNESLineSearchSetType(steps, SNESLINESEARCHBT));
    if (of_->slender) prefer_pivots(snes);
    return true;
  }
  KSP ksp = nullptr;
  KSPConvergedReason why = KSP_CONVERGED_ITERATING;
  PetscBool chosen = PETSC_FALSE;
  check(PetscOptionsHasName(nullptr, nullptr, "-ksp_type", &chosen));
  check(SNESGetKSP(snes, &ksp));
  check(KSPGetConvergedReason(ksp, &why));
  if (chosen || (why != KSP_DIVERGED_INDEFINITE_MAT && why != KSP_DIVERGED_INDEFINITE_PC &&
                 why != KSP_DIVERGED_BREAKDOWN))
    return false;
  check(KSPSetType(ksp, KSPGMRES));
  return true;
}

/// Keeps the names of the linear solver.
void PetscSolver::describe(SNES snes) {
  KSP ksp = nullptr;
  PC pc = nullptr;
  check(SNESGetKSP(snes, &ksp));
  check(KSPGetPC(ksp, &pc));
  KSPType solver = nullptr;
  PCType preconditioner = nullptr;
  check(KSPGetType(ksp, &solver));
  check(PCGetType(pc, &preconditioner));
  description_ = fmt::format("PETSc {}.{}.{}: {} with {}", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR,
                             PETSC_VERSION_SUBMINOR, solver, preconditioner);
}

/// After the first solve all options that PETSc knows have been read.
void PetscSolver::refuse_unused_options() {
  if (!given_ || looked_) return;
  looked_ = true;
  PetscInt n = 0;
  char **names = nullptr, **values = nullptr;
  check(PetscOptionsLeftGet(nullptr, &n, &names, &values));
  std::string unused;
  for (PetscInt i = 0; i < n; ++i)
    if (std::string(names[i]) != "options_left" && std::string(names[i]) != "no_signal_handler")
      unused += fmt::format("{}-{}", unused.empty() ? "" : ", ", names[i]);
  check(PetscOptionsLeftRestore(nullptr, &n, &names, &values));
  if (!unused.empty()) throw UnknownSolverOptions(unused);
}

NewtonReport PetscSolver::solve(NonlinearProblem& problem, std::span<double> u,
                                const NewtonOptions& options) {
  Solve solve{problem, options, {}, nullptr};
  const double start = MPI_Wtime();
  now_ = &solve;
  set_up(problem);
  const Vec solution = of_->solution, r = of_->residual;
  const SNES snes = of_->snes;
  const Mat matrix = of_->values->matrix();
  const auto start_from_guess = [&] {
    PetscScalar* to = nullptr;
    check(VecGetArray(solution, &to));
    std::copy(u.begin(), u.end(), to);
    check(VecRestoreArray(solution, &to));
  };
  start_from_guess();
  if (options.matrix_free && of_->action.object == nullptr) check(MatCreateSNESMF(snes, &of_->action));
  check(SNESSetJacobian(snes, options.matrix_free ? of_->action.object : matrix, matrix, jacobian, this));
  check(SNESSetTolerances(snes, 0, 0, 0, options.max_iterations, 100 * options.max_iterations));
  if (options.linear)
    choose_conjugate_gradients(snes, options.relative_tolerance);
  else
    choose_linear_solver(snes, 3 * problem.all_nodes());
  solve.report.structure_seconds = MPI_Wtime() - start;

  PetscErrorCode code = SNESSolve(snes, nullptr, solution);
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  check(SNESGetConvergedReason(snes, &reason));
  NewtonReport& report = solve.report;
  PetscInt linear = 0, iterations = 0;
  if (!solve.failure && (code != 0 || reason <= 0) && try_otherwise(snes, options)) {
    first_error.clear();
    check(SNESGetLinearSolveIterations(snes, &linear));
    check(SNESGetIterationNumber(snes, &iterations));
    report.linear_iterations = linear;
    report.iterations = static_cast<int>(iterations);
    report.norms.clear();
    start_from_guess();
    code = SNESSolve(snes, nullptr, solution);
    check(SNESGetConvergedReason(snes, &reason));
  }
  // What the linearisation leaves; and whether the state can be taken at all.
  if (options.linear && code == 0 && reason > 0) code = SNESComputeFunction(snes, solution, r);
  if (solve.failure) {
    first_error.clear();
    std::rethrow_exception(solve.failure);
  }
  check(SNESGetLinearSolveIterations(snes, &linear));
  check(SNESGetIterationNumber(snes, &iterations));
  report.iterations += static_cast<int>(iterations);
  report.linear_iterations += linear;
  report.converged = code == 0 && reason > 0 && (solve.usable || !options.linear);
  if (code != 0) {
    report.reason = first_error;
    first_error.clear();
  } else if (reason <= 0) {
    report.reason = fmt::format("{}: {}", options.linear ? "linear system" : "Newton's method",
                                SNESConvergedReasons[reason]);
    if (reason == SNES_DIVERGED_LINEAR_SOLVE) {
      KSP ksp = nullptr;
      KSPConvergedReason why = KSP_CONVERGED_ITERATING;
      check(SNESGetKSP(snes, &ksp));
      check(KSPGetConvergedReason(ksp, &why));
      report.reason += fmt::format(" ({})", KSPConvergedReasons[why]);
    }
  } else if (!report.converged) {
    report.reason = "a particle inverts";
  }
  const PetscScalar* from = nullptr;
  check(VecGetArrayRead(solution, &from));
  std::copy_n(from, u.size(), u.begin());
  check(VecRestoreArrayRead(solution, &from));
  report.linear_seconds =
      MPI_Wtime() - start - report.structure_seconds - report.residual_seconds - report.jacobian_seconds;
  now_ = nullptr;
  refuse_unused_options();
  return report;
}

}  // namespace

}  // namespace mpm::parallel

extern "C" [[gnu::visibility("default")]] mpm::core::NewtonSolver* mpm_make_newton_solver(
    MPI_Comm comm, const std::vector<std::string>* options) {
  return new mpm::parallel::PetscSolver(comm, *options);
}
