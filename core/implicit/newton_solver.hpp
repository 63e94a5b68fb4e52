// Interface between an implicit step and the solver of its nonlinear equations R(u) = 0: three unknowns per
// node, each node on one rank, numbered consecutively from rank to rank. parallel/implicit implements the
// solver over PETSc; the step itself knows nothing of it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mpm::core {

/// Where a Jacobian's entries go.
class BlockMatrix {
 public:
  virtual ~BlockMatrix() = default;
  /// Adds a dense matrix over these nodes, any rank's: rows of 3 nodes.size() values, three rows per node.
  virtual void add(std::span<const std::int64_t> nodes, const double* values) = 0;
  /// Whether add_product() is called; else products are given to add() with all else.
  virtual bool keeps_products() const { return false; }
  /// Adds stiffness e e^T over these nodes; e has three components per node. It may be far stiffer than what
  /// is added otherwise, and solvers may treat it apart. `e` is empty where places alone are asked for.
  virtual void add_product(std::span<const std::int64_t> nodes, std::span<const double> e, double stiffness) {
    static_cast<void>(nodes), static_cast<void>(e), static_cast<void>(stiffness);
  }
};

/// The equations of a step. All functions are collective; `u` and `r` hold this rank's unknowns.
class NonlinearProblem {
 public:
  virtual ~NonlinearProblem() = default;

  virtual std::int64_t own_nodes() const = 0;   ///< of this rank
  virtual std::int64_t first_node() const = 0;  ///< their first number
  virtual std::int64_t all_nodes() const = 0;   ///< of all ranks
  /// Of this rank's nodes, three per node; for the rigid motions that a multigrid method needs to know.
  virtual std::span<const double> coordinates() const = 0;
  /// Of this rank's nodes: where they are in the lattice of the grid's nodes, three integers per node, and
  /// three bits per node, of components that are given; for a hierarchy of coarser grids.
  virtual std::span<const std::int32_t> lattice() const = 0;
  virtual std::span<const std::uint8_t> held() const = 0;
  /// Of this rank's nodes: the field that each belongs to; nodes of several fields may be at one place.
  virtual std::span<const std::int32_t> fields() const = 0;
  /// Whether stiff springs couple nodes that move (contact), which smoothers of single nodes do not reach.
  /// The same on all ranks.
  virtual bool has_springs() const = 0;

  /// Residual forces. False, on all ranks, where the state cannot be evaluated (a particle inverts).
  virtual bool residual(std::span<const double> u, std::span<double> r) = 0;
  /// The size of the forces that balance in the last residual, in the norm of `r`: what a small residual is
  /// compared with.
  virtual double force_scale() const = 0;
  /// The entries' places alone, for allocation: the values passed to `add` are null.
  virtual void structure(BlockMatrix& matrix) = 0;
  /// d r / d u at the last residual.
  virtual void jacobian(std::span<const double> u, BlockMatrix& matrix) = 0;
};

struct NewtonOptions {
  double relative_tolerance = 1e-6;  ///< |r| over the force scale
  double absolute_tolerance = 0;     ///< |r|, force
  int max_iterations = 20;
  bool matrix_free = false;  ///< Jacobian times vector by differences of residuals; the matrix preconditions
  /// One system, linearised at the first guess, by conjugate gradients to the relative tolerance; then no
  /// residual is asked for.
  bool linear = false;
};

/// How a step was solved.
struct NewtonReport {
  bool converged = false;
  std::string reason;  ///< why not
  int iterations = 0;
  std::int64_t linear_iterations = 0;
  std::vector<double> norms;  ///< |r| over the force scale, from the first guess on
  /// Wall-clock time for the matrix's structure, for residuals, for the Jacobian, for the preconditioner or
  /// the factors made from it, and for what solves the linear systems with these.
  double structure_seconds = 0, residual_seconds = 0, jacobian_seconds = 0, setup_seconds = 0,
         linear_seconds = 0;
};

class NewtonSolver {
 public:
  virtual ~NewtonSolver() = default;
  /// Improves the first guess `u`. Collective; the same report on all ranks.
  virtual NewtonReport solve(NonlinearProblem& problem, std::span<double> u,
                             const NewtonOptions& options) = 0;
  /// Describes the linear solver, for the log.
  virtual std::string description() const = 0;
};

}  // namespace mpm::core
