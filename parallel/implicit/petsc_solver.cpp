// Newton's method by PETSc's SNES (core/implicit/newton_solver.hpp), in a library of its own that is loaded
// when a scene is implicit: explicit runs neither load nor start PETSc. Here PETSc is started, a solve is set
// up, run and reported; petsc_newton.hpp has the functions that it calls, petsc_linear.hpp the linear
// solvers. All methods can be replaced by PETSc's own options, after -- on the command line.
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <mpi.h>
#include <petscsnes.h>

#include "core/implicit/newton_solver.hpp"
#include "core/scene/solution.hpp"
#include "parallel/implicit/petsc_augmented.hpp"
#include "parallel/implicit/petsc_errors.hpp"
#include "parallel/implicit/petsc_hierarchy.hpp"
#include "parallel/implicit/petsc_linear.hpp"
#include "parallel/implicit/petsc_matrix.hpp"
#include "parallel/implicit/petsc_newton.hpp"
#include "parallel/implicit/petsc_options.hpp"
#include "parallel/implicit/solver_library.hpp"

namespace mpm::parallel {

namespace {

using core::NewtonOptions;
using core::NewtonReport;
using core::NonlinearProblem;

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

/// For algebraic multigrid.
void give_rigid_motions(const NonlinearProblem& problem, Mat matrix) {
  OwnedVec coordinates;
  check_petsc(MatCreateVecs(matrix, &coordinates, nullptr));
  check_petsc(VecSetBlockSize(coordinates, 3));
  PetscScalar* to = nullptr;
  check_petsc(VecGetArray(coordinates, &to));
  const std::span<const double> from = problem.coordinates();
  std::copy(from.begin(), from.end(), to);
  check_petsc(VecRestoreArray(coordinates, &to));
  OwnedNullSpace rigid;
  check_petsc(MatNullSpaceCreateRigidBody(coordinates, &rigid));
  check_petsc(MatSetNearNullSpace(matrix, rigid));
}

/// PETSc from its start, with the user's options, to its end.
class Session {
 public:
  Session(MPI_Comm comm, const std::vector<std::string>& words) : options_(comm, words) {
    check_mpi(MPI_Comm_dup(comm, &comm_));
    PETSC_COMM_WORLD = comm_;
    words_.insert(words_.end(), words.begin(), words.end());
    for (std::string& w : words_) pointers_.push_back(w.data());
    pointers_.push_back(nullptr);
    int argc = static_cast<int>(words_.size());
    char** argv = pointers_.data();
    PetscOptionsSetValue(nullptr, "-no_signal_handler", nullptr);
    PetscOptionsSetValue(nullptr, "-options_left", "no");
    PetscOptionsSetValue(nullptr, null_pivots_of_mumps, "1");
    check_petsc(PetscInitialize(&argc, &argv, nullptr, nullptr));
    keep_petsc_errors();
  }
  ~Session() {
    PetscPopErrorHandler();
    PetscFinalize();
    MPI_Comm_free(&comm_);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  MPI_Comm comm() const { return comm_; }
  const UserOptions& options() const { return options_; }

 private:
  UserOptions options_;
  MPI_Comm comm_ = MPI_COMM_NULL;
  std::vector<std::string> words_{"mpm"};
  std::vector<char*> pointers_;  ///< to these, for PETSc
};

class PetscSolver final : public core::NewtonSolver {
 public:
  PetscSolver(MPI_Comm comm, const core::ImplicitInput& steps, const std::vector<std::string>& options)
      : session_(comm, options), comm_(session_.comm()), given_(session_.options().any()) {
    session_.options().refuse_unsuitable(steps.linearised(), steps.matrix_free);
  }
  PetscSolver(const PetscSolver&) = delete;
  PetscSolver& operator=(const PetscSolver&) = delete;

  NewtonReport solve(NonlinearProblem& problem, std::span<double> u, const NewtonOptions& options) override;
  std::string description() const override { return description_; }

 private:
  NewtonReport solve_with_options(NonlinearProblem& problem, std::span<double> u,
                                  const NewtonOptions& options);
  void set_up(NonlinearProblem& problem, const NewtonOptions& options);
  bool try_otherwise(SNES snes, bool linear);
  bool meets_tolerance(SNES snes, SNESConvergedReason reason);

  /// What solves with the same places of entries share: PETSc keeps the symbolic part of a factorisation.
  struct SetUp {
    std::unique_ptr<MatrixValues> values;
    bool slender = false;                        ///< as is a bar of few nodes across, on one rank
    std::unique_ptr<GridHierarchy> grids;        ///< null for systems that are solved without
    std::unique_ptr<AugmentedSystem> augmented;  ///< null for systems that are solved as they are
    OwnedVec solution, residual;
    OwnedMat action;
    OwnedSnes snes;
  };

  const Session session_;  ///< ends after what follows
  const MPI_Comm comm_;
  const bool given_;  ///< there are options of the user
  bool looked_ = false;
  std::unique_ptr<SetUp> of_;
  NewtonSolve now_;  ///< the latest solve
  std::string description_;
};

/// The matrix and the solver, or those of the last solve where the places of the entries are the same.
void PetscSolver::set_up(NonlinearProblem& problem, const NewtonOptions& options) {
  MatrixPlaces places(problem.first_node(), problem.own_nodes());
  problem.structure(places);
  for (std::int64_t i = 0; i < problem.own_nodes(); ++i) {
    const std::int64_t number = problem.first_node() + i;
    places.add(std::span(&number, 1), nullptr);
  }
  places.exchange(comm_);
  int has_products = places.has_products() ? 1 : 0;
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, &has_products, 1, MPI_INT, MPI_MAX, comm_));
  int same = of_ && of_->values->places().same_as(places) ? 1 : 0;
  if (same == 1 && of_->grids && !of_->grids->is_of(problem)) same = 0;
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, comm_));
  if (same == 0) {
    of_ = std::make_unique<SetUp>();
    int ranks = 0;
    check_mpi(MPI_Comm_size(comm_, &ranks));
    of_->slender = ranks == 1 && places.widest_level() <= slender_up_to;
    of_->values = std::make_unique<MatrixValues>(comm_, std::move(places), problem.all_nodes());
    check_petsc(MatCreateVecs(of_->values->matrix(), &of_->solution, &of_->residual));
    check_petsc(SNESCreate(comm_, &of_->snes));
    set_functions(of_->snes, of_->residual, now_);
    if (takes_multigrid(3 * problem.all_nodes(), problem.has_springs(), of_->slender) && !options.linear)
      of_->grids = std::make_unique<GridHierarchy>(comm_, problem);
    if (of_->grids && has_products == 1 && takes_augmented_system() && !options.matrix_free) {
      of_->augmented = std::make_unique<AugmentedSystem>(comm_);
      of_->values->keep_products(true);
    }
  }
  give_rigid_motions(problem, of_->values->matrix());
}

/// Takes another method after a failure: a line search, and pivots, after full steps, GMRES after conjugate
/// gradients. False: there is none, or the user has chosen.
bool PetscSolver::try_otherwise(SNES snes, bool linear) {
  if (linear) return choose_gmres(snes);
  if (!choose_line_search(snes)) return false;
  if (of_->slender) prefer_pivots(snes);
  of_->slender = false;
  return true;
}

/// An error that no shorter step changes: the options ask for what PETSc cannot do.
bool is_of_options(PetscErrorCode code) {
  switch (code) {
    case PETSC_ERR_SUP:
    case PETSC_ERR_USER:
    case PETSC_ERR_ARG_WRONG:
    case PETSC_ERR_ARG_OUTOFRANGE:
    case PETSC_ERR_ARG_INCOMP:
    case PETSC_ERR_ARG_WRONGSTATE:
    case PETSC_ERR_ARG_UNKNOWN_TYPE:
    case PETSC_ERR_MISSING_FACTOR:
    case PETSC_ERR_USER_INPUT: return true;
    default: return false;
  }
}

std::string why_not_converged(SNES snes, PetscErrorCode code, SNESConvergedReason reason, bool linear) {
  if (code != 0) return take_petsc_error();
  if (reason > 0 && linear) return "a particle inverts";
  if (reason > 0) return "Newton's method stops above the tolerance";
  std::string why =
      fmt::format("{}: {}", linear ? "linear system" : "Newton's method", SNESConvergedReasons[reason]);
  if (reason == SNES_DIVERGED_LINEAR_SOLVE) {
    KSP ksp = nullptr;
    KSPConvergedReason of_system = KSP_CONVERGED_ITERATING;
    check_petsc(SNESGetKSP(snes, &ksp));
    check_petsc(KSPGetConvergedReason(ksp, &of_system));
    why += fmt::format(" ({})", KSPConvergedReasons[of_system]);
  }
  return why;
}

/// Whether the residual of the solution is as small as it has to be, whatever ended the iteration.
bool PetscSolver::meets_tolerance(SNES snes, SNESConvergedReason reason) {
  // The last residual of full steps, which our own test has seen, is that of the solution.
  if (takes_full_steps(snes))
    return reason == SNES_CONVERGED_FNORM_RELATIVE || reason == SNES_CONVERGED_FNORM_ABS;
  PetscReal norm = 0;
  if (SNESComputeFunction(snes, of_->solution, of_->residual) != 0) return false;
  check_petsc(VecNorm(of_->residual, NORM_2, &norm));
  return now_.usable && is_small(norm, now_);
}

NewtonReport PetscSolver::solve(NonlinearProblem& problem, std::span<double> u,
                                const NewtonOptions& options) {
  try {
    return solve_with_options(problem, u, options);
  } catch (const PetscFailure& error) {
    if (!given_ || looked_ || !is_of_options(error.code())) throw;
    session_.options().refuse(error.what());
  }
}

NewtonReport PetscSolver::solve_with_options(NonlinearProblem& problem, std::span<double> u,
                                             const NewtonOptions& options) {
  const double start = MPI_Wtime();
  set_up(problem, options);
  now_ = {&problem, &options, of_->values.get(), of_->grids.get(), of_->augmented.get(), {}, nullptr};
  NewtonReport& report = now_.report;
  const Vec solution = of_->solution, r = of_->residual;
  const SNES snes = of_->snes;
  const Mat matrix = of_->values->matrix();
  const auto start_from_guess = [&] {
    PetscScalar* to = nullptr;
    check_petsc(VecGetArray(solution, &to));
    std::copy(u.begin(), u.end(), to);
    check_petsc(VecRestoreArray(solution, &to));
  };
  start_from_guess();
  if (options.matrix_free && of_->action.object == nullptr) check_petsc(MatCreateSNESMF(snes, &of_->action));
  set_jacobian(snes, options.matrix_free ? of_->action.object : matrix, matrix, now_);
  check_petsc(SNESSetTolerances(snes, 0, 0, 0, options.max_iterations, 100 * options.max_iterations));
  if (options.linear) {
    choose_conjugate_gradients(snes, options.relative_tolerance);
  } else {
    if (of_->augmented)
      of_->augmented->choose(snes);
    else
      choose_linear_solver(snes, 3 * problem.all_nodes(), problem.has_springs(), of_->slender,
                           of_->grids.get());
    choose_full_steps(snes, now_);
  }
  const PetscErrorCode misread = SNESSetFromOptions(snes);
  if (given_ && misread != 0) session_.options().refuse(take_petsc_error());
  check_petsc(misread);
  description_ = description_of(snes);
  report.structure_seconds = MPI_Wtime() - start;

  PetscErrorCode code = SNESSolve(snes, nullptr, solution);
  if (given_ && !looked_ && !now_.failure && is_of_options(code))
    session_.options().refuse(take_petsc_error());
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
  check_petsc(SNESGetConvergedReason(snes, &reason));
  const auto count_iterations = [&] {
    PetscInt linear = 0, iterations = 0;
    check_petsc(SNESGetLinearSolveIterations(snes, &linear));
    check_petsc(SNESGetIterationNumber(snes, &iterations));
    report.iterations += static_cast<int>(iterations);
    report.linear_iterations += of_->augmented ? of_->augmented->take_iterations() : linear;
  };
  if (!now_.failure && (code != 0 || reason <= 0) && try_otherwise(snes, options.linear)) {
    take_petsc_error();
    count_iterations();
    report.norms.clear();
    start_from_guess();
    code = SNESSolve(snes, nullptr, solution);
    check_petsc(SNESGetConvergedReason(snes, &reason));
  }
  // What the linearisation leaves; and whether the state can be taken at all.
  if (options.linear && code == 0 && reason > 0) code = SNESComputeFunction(snes, solution, r);
  const bool met = code == 0 && reason > 0 && (options.linear ? now_.usable : meets_tolerance(snes, reason));
  if (now_.failure) {
    take_petsc_error();
    std::rethrow_exception(now_.failure);
  }
  count_iterations();
  report.converged = met;
  if (!report.converged) report.reason = why_not_converged(snes, code, reason, options.linear);
  const PetscScalar* from = nullptr;
  check_petsc(VecGetArrayRead(solution, &from));
  std::copy_n(from, u.size(), u.begin());
  check_petsc(VecRestoreArrayRead(solution, &from));
  report.linear_seconds = MPI_Wtime() - start - report.structure_seconds - report.residual_seconds -
                          report.jacobian_seconds - report.setup_seconds;
  if (given_ && !looked_) session_.options().refuse_unused();
  looked_ = true;
  // An error leaves solvers in the middle of something, and each later solution would fail.
  if (code != 0) of_ = nullptr;
  return report;
}

}  // namespace

}  // namespace mpm::parallel

extern "C" [[gnu::visibility("default")]] mpm::core::NewtonSolver* mpm_make_newton_solver(
    MPI_Comm comm, const mpm::core::ImplicitInput* steps, const std::vector<std::string>* options) {
  return new mpm::parallel::PetscSolver(comm, *steps, *options);
}
