// XPIC and FMPM of order m (Hammerquist and Nairn, CMAME 318 (2017) 724; Nairn and Hammerquist, CMAME 379
// (2021) 113748): PIC with a correction of the velocities that its two maps smooth away.
//
// S interpolates nodes to particles; S+ = diag(m_i)^-1 S^T diag(m_p) maps particles to nodes with the lumped
// mass. S+ S has its eigenvalues in [0, 1]. PIC's velocity is S S+ V. What is lost, (1 - S S+) V, is mapped
// again, and so on; after m rounds what remains of it is (1 - S S+)^m V:
//   v(m) = dv(1) + ... + dv(m),   dv(l) = (1 - S+ S) dv(l - 1)
// Order 1 is PIC. As m grows, S v(m) tends to the velocities nearest to V, by mass, that the grid can
// represent: resolved motion is kept, and what the grid cannot see is removed. With S+ S = diag(m_i)^-1 M the
// series is also Neumann's for M^-1, M_ij = sum_p m_p S_i S_j being the consistent mass matrix: hence FMPM.
//
//          dv(1)                        particles take            and move with
//   XPIC   S+ V, at the step's start    S (v(m) + dt a)           S (S+ V + dt a), as FLIP and PIC
//   FMPM   S+ V + dt a, at its end      S v(m)                    S v(m), the same
// with a = f_i/m_i. Written with v(1) = S+ V + dt a, both take S v(m); they differ in dv(1) and in the
// motion. (The authors have velocities at whole steps and move with a mean of two of them; here a step leads
// from one half to the next.) Strain rates, loads and their work use the nodal velocities of lumped mass.
//
// Every dv keeps the boundary conditions: on a fixed or symmetry face it has no such component, and outer
// nodes follow as those of velocities do; a node at rest at a rigid wall stays so, and one whose sum would
// lead through that wall comes to rest (and with FMPM and MUSL strains nothing then). Nodes below the mass
// cutoff take no part. In contact each component has maps of its own; dv(1) follows from the velocities that
// contact leaves, and contact acts on v(m) again: what sticks stays so, what slides is held along the
// normal, and nothing else approaches (core/contact/contact_impulses.cpp). Each order beyond the first is a
// product with M, over the particles or the cells (core/step/mass_products.hpp), and an exchange. With an
// interval n only every n-th step corrects, by its number; the others are FLIP. Shown by
// tests/core/step/correction_test.cpp and oracle_test.cpp.
#pragma once

#include <cstdint>

#include "core/transfer/flip.hpp"

namespace mpm::core {

struct Corrected : Flip {
  static constexpr std::string_view name = "XPIC";
  explicit Corrected(const SolutionInput& solution)
      : Flip(solution), of_end(solution.transfer == Transfer::fmpm), interval(solution.xpic_interval) {}

  /// Whether the step with this number, from 1, corrects.
  bool corrects(std::int64_t step) const { return step % interval == 0; }

  /// Of a step that corrects.
  static double share_of_nodes(const TransferStep&) { return 1; }

  /// v = sum S v(m).
  template <ShapePolicy S>
  void take_velocities(const typename S::Place& place, const ColumnLayout& layout,
                       const typename S::Field& corrected, double* block) const {
    const typename S::Interpolation v(place, corrected.velocity());
    for (int a = 0; a < 3; ++a) store(block + layout.offset(next(Column::velocity_x, a)), v.value[a]);
  }

  bool of_end;  ///< FMPM
  std::int64_t interval;
};
static_assert(TransferPolicy<Corrected>);

/// Whether a transfer has orders beyond the first.
template <class T>
inline constexpr bool corrects_velocities = requires(const T& transfer) {
  transfer.corrects(1);
};

/// The orders of the scene's transfer: 1 without corrections.
inline int orders_of(const SolutionInput& solution) {
  return is_corrected(solution.transfer) ? solution.xpic_order : 1;
}

}  // namespace mpm::core
