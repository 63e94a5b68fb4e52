#include "parallel/implicit/petsc_hierarchy.hpp"

#include <algorithm>
#include <array>

#include "parallel/implicit/coarse_lattice.hpp"
#include "parallel/implicit/petsc_errors.hpp"

namespace mpm::parallel {

namespace {

/// Grids with no more nodes than `coarsest` are made no coarser; with more than `direct` it takes too long to
/// solve directly on them in each iteration.
constexpr std::int64_t coarsest = 300, direct = 3000;

Mat matrix_of(MPI_Comm comm, const LatticeNodes& fine, const LatticeNodes& coarse,
              const Interpolation& from) {
  std::vector<PetscInt> inside(3 * fine.own()), outside(3 * fine.own());
  const std::int64_t beyond = coarse.first + static_cast<std::int64_t>(coarse.own());
  for (std::size_t i = 0; i < fine.own(); ++i)
    for (const Interpolation::Source& s : from.of(i))
      for (std::size_t a = 0; a < 3; ++a)
        ++(s.number >= coarse.first && s.number < beyond ? inside : outside)[3 * i + a];
  Mat matrix = nullptr;
  check_petsc(MatCreateAIJ(comm, static_cast<PetscInt>(inside.size()),
                           static_cast<PetscInt>(3 * coarse.own()), PETSC_DETERMINE, PETSC_DETERMINE, 0,
                           inside.data(), 0, outside.data(), &matrix));
  check_petsc(MatSetBlockSizes(matrix, 3, 3));
  for (std::size_t i = 0; i < fine.own(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto row =
          static_cast<PetscInt>(3 * (fine.first + static_cast<std::int64_t>(i))) + static_cast<PetscInt>(a);
      std::array<PetscInt, 8> at{};
      std::array<PetscScalar, 8> weights{};
      PetscInt n = 0;
      for (const Interpolation::Source& s : from.of(i)) {
        at[static_cast<std::size_t>(n)] = static_cast<PetscInt>(3 * s.number) + static_cast<PetscInt>(a);
        weights[static_cast<std::size_t>(n++)] = s.weight[a];
      }
      // Zeros too: the three rows of a node have the same columns in all products.
      check_petsc(MatSetValues(matrix, 1, &row, n, at.data(), weights.data(), INSERT_VALUES));
    }
  }
  check_petsc(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  return matrix;
}

}  // namespace

GridHierarchy::GridHierarchy(MPI_Comm comm, const core::NonlinearProblem& problem)
    : places_(problem.lattice().begin(), problem.lattice().end()),
      fields_(problem.fields().begin(), problem.fields().end()),
      held_(problem.held().begin(), problem.held().end()) {
  LatticeNodes fine{places_, fields_, held_, problem.first_node(), problem.all_nodes()};
  int all = has_keys(fine) ? 1 : 0;
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, comm));
  if (all == 0) return;
  Interpolation from;
  while (fine.all > coarsest) {
    LatticeNodes coarse = coarsen(comm, fine, from);
    if (coarse.all >= fine.all) break;
    interpolations_.push_back(matrix_of(comm, fine, coarse, from));
    fine = std::move(coarse);
  }
  usable_ = !interpolations_.empty() && fine.all <= direct;
}

GridHierarchy::~GridHierarchy() {
  for (std::vector<Mat>* list : {&interpolations_, &coarse_})
    for (Mat& m : *list) MatDestroy(&m);
  MatDestroy(&rows_);
}

bool GridHierarchy::is_of(const core::NonlinearProblem& problem) const {
  return std::ranges::equal(places_, problem.lattice()) && std::ranges::equal(fields_, problem.fields()) &&
         std::ranges::equal(held_, problem.held());
}

void GridHierarchy::choose(PC pc) const {
  if (!usable_) {
    check_petsc(PCSetType(pc, PCGAMG));
    return;
  }
  PetscBool chosen = PETSC_FALSE;
  check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCMG, &chosen));
  if (chosen == PETSC_TRUE) return;
  const std::size_t levels = interpolations_.size() + 1;
  check_petsc(PCSetType(pc, PCMG));
  check_petsc(PCMGSetLevels(pc, static_cast<PetscInt>(levels), nullptr));
  check_petsc(PCSetUseAmat(pc, PETSC_FALSE));  // there is no product with differences of residuals
  for (std::size_t l = 0; l < levels; ++l) {   // from the coarsest grid on
    KSP smoother = nullptr;
    PC of = nullptr;
    check_petsc(PCMGGetSmoother(pc, static_cast<PetscInt>(l), &smoother));
    check_petsc(KSPGetPC(smoother, &of));
    if (l == 0) {
      check_petsc(KSPSetType(smoother, KSPPREONLY));
      check_petsc(PCSetType(of, PCLU));
      check_petsc(PCFactorSetMatSolverType(of, MATSOLVERMUMPS));
    } else {
      check_petsc(PCMGSetInterpolation(pc, static_cast<PetscInt>(l), interpolations_[levels - 1 - l]));
      check_petsc(KSPSetType(smoother, KSPCHEBYSHEV));
      check_petsc(PCSetType(of, PCPBJACOBI));
    }
  }
}

void GridHierarchy::take(PC pc, Mat finest) {
  PetscBool chosen = PETSC_FALSE, one = PETSC_FALSE, several = PETSC_FALSE;
  check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCMG, &chosen));
  if (chosen == PETSC_FALSE) return;
  check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(finest), MATSEQAIJ, &one));
  check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(finest), MATMPIAIJ, &several));
  const std::size_t grids = interpolations_.size();
  const MatReuse reuse = coarse_.empty() ? MAT_INITIAL_MATRIX : MAT_REUSE_MATRIX;
  coarse_.resize(grids);
  Mat from = finest;
  if (one == PETSC_FALSE && several == PETSC_FALSE) {
    check_petsc(MatConvert(finest, MATAIJ, reuse, &rows_));
    from = rows_;
  }
  for (std::size_t i = 0; i < grids; ++i) {
    check_petsc(MatPtAP(from, interpolations_[i], reuse, PETSC_DEFAULT, &coarse_[i]));
    from = coarse_[i];
    KSP smoother = nullptr;
    check_petsc(PCMGGetSmoother(pc, static_cast<PetscInt>(grids - 1 - i), &smoother));
    check_petsc(KSPSetOperators(smoother, from, from));
  }
}

}  // namespace mpm::parallel
