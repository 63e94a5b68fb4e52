// FLIP with the consistent mass matrix M_ij = sum_p m_p S_i S_j (D. Burgess, D. Sulsky, J. U. Brackbill,
// J. Comput. Phys. 103 (1992) 1) in the place of the lumped one, D = diag(m_i), m_i = sum_j M_ij.
//
// With M a = f and M v = p particles gain exactly the kinetic energy dt f.(v + dt a/2); lumped masses lose
// dt^2/2 a.(D - M) a of it, and turn part of a body's angular momentum into none. But M is singular where
// particles are fewer than nodes, and nearly so where a node has light particles only: there a force has no
// finite acceleration. Hence both are taken together,
//   M_b = (1 - b) M + b D,   b = mass_blend,
// whose D^-1 M_b has its eigenvalues in [b, 1]. In the mean by mass, accelerations are at most 1/b times
// those with lumped mass, and what is lost is b dt^2/2 a.(D - M) a: never less than zero.
//
// With these bounds known, Chebyshev's iteration (Y. Saad, Iterative Methods for Sparse Linear Systems, 2003,
// alg. 12.1) needs no reductions. Conjugate gradients need two sums over all ranks in each iteration; for the
// same bits on any ranks these would have to be exact. The iteration starts from the lumped solution, and the
// number K of its products with M follows from the tolerance alone:
//   u = P_K g,   |1 - mu p_K(mu)| <= tolerance (1 - mu)   for every eigenvalue mu of D^-1 M_b, P_K = p_K(D^-1
//   M_b) D^-1
// P_K is the same symmetric matrix for every right-hand side g. So the balance of energy above holds to
// round-off at any K, with P_K^-1 in the place of M_b; and as the error vanishes at mu = 1, particles gain
// the momentum of the nodes' forces to round-off.
//
// What is solved in a step, each with K products, passes over the particles or the cells
// (core/shape/cell_mass.hpp), and as many exchanges:
//   USF    velocities at the start, P_K p, for the strain; increments, once the forces are there
//   MUSL   increments; and the velocities P_K p' from the particles' new momentum p', with which they strain
//          and move. With loads also those at the end of the step, P_K (p + dt f), for their work
//   USL    does not go with it: its strain would take dv as it is, which at light nodes is larger by up to
//   1/b
//          (a drifting block of quadratic splines doubles its energy at 0.3 of a wave's crossing time)
// Particles take S dv and move with S v. Walls hold in the solution what they hold with lumped mass; a node
// whose solution would lead through a rigid wall comes to rest. With contact each component has its own M,
// and impulses of contact that balance forces are among these (core/step/solve_mass.hpp). Shown by
// tests/core/step/consistent_mass_test.cpp and oracle_test.cpp.
#pragma once

#include <vector>

#include "core/transfer/flip.hpp"

namespace mpm::core {

/// Share of the lumped mass: 1/b bounds the accelerations, sqrt(1/b) the number of iterations.
inline constexpr double mass_blend = 0.2;

/// The steps of Chebyshev's iteration for D^-1 M_b: u += d_k, d_k = last d_(k-1) + residual D^-1 r_(k-1).
class MassIteration {
 public:
  struct Step {
    double last, residual;
  };
  explicit MassIteration(double tolerance) {
    constexpr double centre = (1 + mass_blend) / 2, half = (1 - mass_blend) / 2;
    double rho = half / centre, error = rho;
    steps_.push_back({0, 1 / centre});
    while (error > tolerance) {
      const double next = 1 / (2 * centre / half - rho);
      steps_.push_back({next * rho, 2 * next / half});
      rho = next;
      error *= rho;
    }
  }
  const std::vector<Step>& steps() const { return steps_; }

 private:
  std::vector<Step> steps_;
};

struct Consistent : Flip {
  static constexpr std::string_view name = "FLIP, consistent mass";
  explicit Consistent(const SolutionInput& solution) : Flip(solution), iteration(solution.mass_tolerance) {}

  MassIteration iteration;
};
static_assert(TransferPolicy<Consistent>);

/// Whether a transfer solves with the consistent mass matrix.
template <class T>
inline constexpr bool solves_mass = requires(const T& transfer) {
  transfer.iteration;
};

}  // namespace mpm::core
