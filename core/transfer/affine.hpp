// Affine transfers: a particle carries a matrix C (1/time) beside its velocity and maps to node i the
// momentum of a linear field, m S_i (v + C (x_i - x)).
//
//   APIC    v = sum S_i v_i,  C = B D^-1,  B = sum S_i v_i (x_i - x)^T,  D = sum S_i (x_i - x)(x_i - x)^T
//           (Jiang et al. 2015, 2017): the transfers keep angular momentum, that of C included
//   TPIC    v = sum S_i v_i,  C = sum v_i grad S_i^T   (Nakamura et al. 2023)
//   AFLIP   v as FLIP's, with a share of PIC that grows with the step; C as APIC's (Fei et al. 2021)
// D is diagonal, because each axis reproduces linear functions; for quadratic and cubic B-splines it is h^2/4
// and h^2/3. Shape functions with which D vanishes somewhere (linear at the nodes) do not go with APIC.
// PIC's velocity damps once per step, so APIC and TPIC lose more energy in smaller steps.
#pragma once

#include "core/transfer/flip.hpp"

namespace mpm::core {

/// Share of PIC in AFLIP's velocity in a step in which a wave crosses a cell.
inline constexpr double aflip_damping = 0.01;

template <Transfer kind>
struct Affine {
  static_assert(kind == Transfer::apic || kind == Transfer::tpic || kind == Transfer::aflip);
  static constexpr std::string_view name = kind == Transfer::apic   ? "APIC"
                                           : kind == Transfer::tpic ? "TPIC"
                                                                    : "AFLIP";
  static ColumnSet columns() {
    ColumnSet set;
    set.add_range(Column::affine_xx, 9);
    return set;
  }
  using Rows = AffineRows;
  explicit Affine(const SolutionInput&) {}

  template <ShapePolicy S>
  [[gnu::always_inline]] static void momentum(const BrickFrame& frame, const typename S::Place& place,
                                              const ColumnLayout& layout, const double* block, Rows& rows) {
    using R = Lanes<8>;
    particle_momentum(layout, block, rows);
    const R m = load<R>(rows.mass);
    for (int a = 0; a < 3; ++a) {
      R at_lowest = load<R>(rows.momentum[a]);
      for (int b = 0; b < 3; ++b) {
        const R c = load<R>(block + layout.offset(next(Column::affine_xx, 3 * a + b)));
        const R increase = m * c * R(1 / frame.inverse_cell[b]);
        store(rows.increase[a][b], increase);
        at_lowest -= increase * S::from_lowest_node(place, b);
      }
      store(rows.momentum[a], at_lowest);
    }
  }

  static double share_of_nodes(const TransferStep& step) {
    return kind == Transfer::aflip ? aflip_damping * step.courant : 1;
  }

  template <ShapePolicy S>
  void update_velocities(const BrickFrame& frame, const typename S::Place& place, const ColumnLayout& layout,
                         const typename S::Field& field, const TransferStep& step, double* block) const {
    using R = Lanes<8>;
    R u[3], c[9];
    if constexpr (kind == Transfer::tpic)
      S::velocity_and_gradient(place, field, u, c);
    else
      S::velocity_and_moments(frame, place, field, u, c);
    for (int i = 0; i < 9; ++i) store(block + layout.offset(next(Column::affine_xx, i)), c[i]);
    double* v[3];
    for (int a = 0; a < 3; ++a) v[a] = block + layout.offset(next(Column::velocity_x, a));
    if constexpr (kind == Transfer::aflip) {
      const typename S::Interpolation dv(place, field.increment());
      const double pic = share_of_nodes(step);
      for (int a = 0; a < 3; ++a) store(v[a], R(1 - pic) * (load<R>(v[a]) + dv.value[a]) + R(pic) * u[a]);
    } else {
      for (int a = 0; a < 3; ++a) store(v[a], u[a]);
    }
  }
};

using Apic = Affine<Transfer::apic>;
using Tpic = Affine<Transfer::tpic>;
using Aflip = Affine<Transfer::aflip>;
static_assert(TransferPolicy<Apic> && TransferPolicy<Tpic> && TransferPolicy<Aflip>);

}  // namespace mpm::core
