// Generalised interpolation (GIMP; Bardenhagen and Kober, CMES 5 (2004) 477; review 2.2.2): the linear
// functions averaged over the particle's domain, a box of half-sizes l along the axes.
//   uGIMP    the box keeps its first size
//   cpGIMP   it is stretched with the particle, dl_a/dt = l_a L_aa: without rotation, boxes that filled
//            a body go on filling it. L is that of the strain (MUSL, USL) or of the motion (USF, whose
//            forces follow the strain in the same step and must act on the nodes that have mass).
// The first box is a cube of the particle's volume. A box wider than a cell would reach a fourth node: it
// counts as one cell wide, and the run says how often that happened.
#pragma once

#include "core/shape/domain_counts.hpp"
#include "core/shape/separable.hpp"

namespace mpm::core {

/// Around a node, t = s - 1/2 from it, l in cells. With g(t) the average of max(t, 0) over [t - l, t + l],
/// the nodes' values are g(-t), 1 - g(t) - g(-t) and g(t).
struct GimpAlong {
  static constexpr int nodes = 3;
  static constexpr bool has_size = true;
  static constexpr double widest = 0.5, narrowest = 1e-6;
  template <class T>
  static void evaluate(T s, T half_size, T* value, T* slope) {
    const T l = min(max(half_size, T(narrowest)), T(widest)), inverse_width = T(0.5) / l, t = s - T(0.5);
    const auto average = [&](T x, T& gradient) {
      gradient = min(max((x + l) * inverse_width, T(0.0)), T(1.0));
      return select(x < l, l * gradient * gradient, x);
    };
    T lower_slope, upper_slope;
    value[0] = average(-t, lower_slope);
    value[2] = average(t, upper_slope);
    value[1] = T(1.0) - value[0] - value[2];
    slope[0] = -lower_slope;
    slope[2] = upper_slope;
    slope[1] = lower_slope - upper_slope;
  }
};

struct UniformGimp : Separable<GimpAlong> {
  static constexpr std::string_view name = "uGIMP";
};
static_assert(ShapePolicy<UniformGimp>);

struct ContiguousGimp : Separable<GimpAlong> {
  static constexpr std::string_view name = "cpGIMP";

  /// Stretches the boxes of a block by the velocity gradient in rows 0..8, columns `at` .. at + 7. Counts
  /// the boxes of the first `used` particles that are wider than a cell.
  template <class Rows>
  static DomainCounts deform(const BrickFrame& frame, const ColumnLayout& layout, const Rows& rows, int at,
                             double dt, double* block, int used) {
    unsigned wide = 0;
    for (int a = 0; a < 3; ++a) {
      double* half = block + layout.offset(next(Column::half_size_x, a));
      for (int l = 0; l < block_lanes; ++l) {
        half[l] *= 1 + dt * rows[4 * a][at + l];
        wide |= static_cast<unsigned>(half[l] * frame.inverse_cell[a] > GimpAlong::widest) << l;
      }
    }
    return {.wide = __builtin_popcount(wide & ((1u << used) - 1))};
  }
};
static_assert(ShapePolicy<ContiguousGimp>);

}  // namespace mpm::core
