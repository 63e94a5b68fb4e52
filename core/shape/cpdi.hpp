// Convected particle domain interpolation: shape functions through the corners of domains that deform with
// the particles (corners.hpp).
//   CPDI   parallelepiped of half edges r_k with dr_k/dt = L r_k, so that r_k = F r_k at the start. L is that
//          of cpGIMP (gimp.hpp). s_c = 1/8, w_c = sum_k +-g_k/8, g_k reciprocal to r_k
//          (Sadeghirad, Brannon and Burghardt, IJNME 86 (2011) 1435)
//   CPDI2  hexahedron whose corners move with the grid's velocity, dx_c/dt = sum_i N_i(x_c) v_i: domains that
//          filled a body go on filling it. Weights: the means over the hexahedron (hexahedron.hpp), divided
//          by its own volume. The particle is kept at its centroid, sum_c s_c x_c, where linear fields are
//          reproduced; a body that keeps velocities of its own takes its domains along.
//          (Sadeghirad, Brannon and Guilkey, IJNME 95 (2013) 928)
// The first domain is a cube of the particle's volume, along the axes.
//
// A domain that reaches more than a cell from the particle along an axis is evaluated with its coordinates on
// that axis scaled back to one cell: weights of the same parallelepiped or hexahedron, squeezed. A
// tangled domain, whose Jacobian is not positive at a corner or in the mean, is replaced: a hexahedron by the
// parallelepiped of its mean edges, and where that is tangled too, by a cube of the particle's volume. Both
// are counted. In a fluid, whose shear draws domains out to needles that tell nothing of it, one that reaches
// more than a cell is replaced by such a cube, too: with needles a dam break ends in particles of any speed.
// Shown by tests/core/shape.
#pragma once

#include "core/shape/corners.hpp"
#include "core/shape/domain_counts.hpp"

namespace mpm::core {

namespace cpdi {

inline constexpr double farthest = 1;  ///< of a corner from the particle along an axis, in cells

/// The cube of a particle's volume: half its edge.
inline double half_of_cube(const ColumnLayout& layout, const double* block, int lane) {
  return 0.5 * std::cbrt(std::max(block[layout.offset(Column::volume) + lane], 0.0));
}

/// Lanes of a block whose domains reach, reach(axis), more than `farthest`.
template <class F>
unsigned wide_lanes(const BrickFrame& frame, F reach) {
  using R = Lanes<8>;
  unsigned wide = 0;
  for (int a = 0; a < 3; ++a) wide |= bits(R(farthest) < reach(a) * R(frame.inverse_cell[a]));
  return wide;
}

inline int count(unsigned lanes, int used) { return __builtin_popcount(lanes & ((1u << used) - 1)); }

}  // namespace cpdi

/// r_k in the columns edge_1x ...
struct Parallelepiped {
  using R = Lanes<8>;
  static constexpr Column first_column = Column::edge_1x;
  static constexpr int columns = 9;
  /// Over all corners, and with the signs of each edge.
  static constexpr int sums = 4, values = 1, first_slope = 1;
  static constexpr int corner_value(int) { return 0; }
  template <class T>
  static void reduce(const T (&u)[corners], T (&sum)[sums]) {
    T total[4], difference[4];  // of pairs along the first edge, then of these along the second
    for (int i = 0; i < 4; ++i) {
      total[i] = u[2 * i] + u[2 * i + 1];
      difference[i] = u[2 * i + 1] - u[2 * i];
    }
    const T lower = total[0] + total[1], upper = total[2] + total[3];
    sum[0] = lower + upper;
    sum[1] = (difference[0] + difference[1]) + (difference[2] + difference[3]);
    sum[2] = (total[1] - total[0]) + (total[3] - total[2]);
    sum[3] = upper - lower;
  }
  /// The same for each corner.
  template <class Place>
  [[gnu::always_inline]] static void share(const Place& place, R total, R (&to)[corners]) {
    const R part = total * load<R>(place.value[0]);
    for (R& of_corner : to) of_corner = part;
  }
  template <class Place>
  [[gnu::always_inline]] static void share_flow(const Place& place, const R (&flow)[3], R (&to)[corners]) {
    R along[3];
    for (int k = 0; k < 3; ++k) {
      along[k] = flow[0] * load<R>(place.slope[k][0]);
      for (int a = 1; a < 3; ++a) along[k] += flow[a] * load<R>(place.slope[k][a]);
    }
    parallelepiped_corners(R(0.0), along[0], along[1], along[2], to);
  }
  static void load_edges(const ColumnLayout& layout, const double* block, Vec3<R> (&r)[3]) {
    const double* edge = block + layout.offset(Column::edge_1x);
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a) r[k][a] = load<R>(edge + block_lanes * (3 * k + a));
  }
  static void set_cube(const ColumnLayout& layout, double* block, int lane) {
    double* edge = block + layout.offset(Column::edge_1x) + lane;
    const double half = cpdi::half_of_cube(layout, block, lane);
    for (int i = 0; i < 9; ++i) edge[block_lanes * i] = i % 4 == 0 ? half : 0;
  }
  static unsigned wide_lanes(const BrickFrame& frame, const Vec3<R> (&r)[3]) {
    return cpdi::wide_lanes(frame, [&](int a) { return abs(r[0][a]) + abs(r[1][a]) + abs(r[2][a]); });
  }
  static void evaluate(const BrickFrame& frame, const ColumnLayout& layout, const double* block,
                       const R (&middle)[3], R (&at)[3][corners], R (&reach)[3],
                       SumWeights<R, Parallelepiped>& w) {
    Vec3<R> r[3];
    load_edges(layout, block, r);
#pragma GCC unroll 3  // or the corners pass through memory
    for (int a = 0; a < 3; ++a) {
      const R inverse(frame.inverse_cell[a]);
      for (Vec3<R>& edge : r) edge[a] *= inverse;
      reach[a] = abs(r[0][a]) + abs(r[1][a]) + abs(r[2][a]);
      if (bits(R(cpdi::farthest) < reach[a]) != 0) [[unlikely]] {
        const R scale = R(cpdi::farthest) / max(reach[a], R(cpdi::farthest));
        for (Vec3<R>& edge : r) edge[a] *= scale;
        reach[a] *= scale;
      }
      parallelepiped_corners(middle[a], r[0][a], r[1][a], r[2][a], at[a]);
    }
    const Vec3<R> g[3] = {cross(r[1], r[2]), cross(r[2], r[0]), cross(r[0], r[1])};
    const R eighth = R(0.125) / dot(r[0], g[0]);
    w.value[0] = R(0.125);
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a) w.slope[k][a] = eighth * g[k][a];
  }
};

struct Cpdi : CornerShape<Parallelepiped> {
  static constexpr std::string_view name = "CPDI";

  /// Deforms the domains of a block by the velocity gradient in rows 0..8, columns `at` .. at + 7.
  template <class Rows>
  static DomainCounts deform(const BrickFrame& frame, const ColumnLayout& layout, const Rows& rows, int at,
                             double dt, double* block, int used) {
    using R = Lanes<8>;
    Vec3<R> r[3];
    Parallelepiped::load_edges(layout, block, r);
    double* edge = block + layout.offset(Column::edge_1x);
    for (int k = 0; k < 3; ++k) {
      const Vec3<R> old = r[k];
      for (int a = 0; a < 3; ++a) {
        R rate(0.0);
        for (int b = 0; b < 3; ++b) rate += load<R>(rows[3 * a + b] + at) * old[b];
        r[k][a] += R(dt) * rate;
        store(edge + block_lanes * (3 * k + a), r[k][a]);
      }
    }
    const unsigned wide = Parallelepiped::wide_lanes(frame, r);
    const unsigned tangled = bits(!(R(0.0) < dot(r[0], cross(r[1], r[2])))) & ((1u << used) - 1);
    for (unsigned left = tangled; left != 0; left &= left - 1)
      Parallelepiped::set_cube(layout, block, __builtin_ctz(left));
    return {cpdi::count(wide & ~tangled, used), cpdi::count(tangled, used)};
  }
  /// Replaces domains that reach more than a cell by cubes.
  static void replace_wide(const BrickFrame& frame, const ColumnLayout& layout, double* block);
};
static_assert(ShapePolicy<Cpdi>);

/// Corners relative to the particle in the columns corner_0x ..., so that they are as precise anywhere.
struct HexahedronDomain {
  using R = Lanes<8>;
  static constexpr Column first_column = Column::corner_0x;
  static constexpr int columns = 3 * corners;
  /// Every corner has weights of its own.
  static constexpr int sums = corners, values = corners, first_slope = 0;
  static constexpr int corner_value(int c) { return c; }
  template <class T>
  static void reduce(const T (&u)[corners], T (&sum)[corners]) {
    for (int c = 0; c < corners; ++c) sum[c] = u[c];
  }
  template <class Place>
  [[gnu::always_inline]] static void share(const Place& place, R total, R (&to)[corners]) {
    for (int c = 0; c < corners; ++c) to[c] = total * load<R>(place.value[c]);
  }
  template <class Place>
  [[gnu::always_inline]] static void share_flow(const Place& place, const R (&flow)[3], R (&to)[corners]) {
    for (int c = 0; c < corners; ++c) {
      to[c] = flow[0] * load<R>(place.slope[c][0]);
      for (int a = 1; a < 3; ++a) to[c] += flow[a] * load<R>(place.slope[c][a]);
    }
  }
  static double* of(const ColumnLayout& layout, double* block) {
    return block + layout.offset(Column::corner_0x);
  }
  static void load_corners(const ColumnLayout& layout, const double* block, R (&x)[3][corners]) {
    const double* from = block + layout.offset(Column::corner_0x);
    for (int c = 0; c < corners; ++c)
      for (int a = 0; a < 3; ++a) x[a][c] = load<R>(from + block_lanes * (3 * c + a));
  }
  static R reach_of(const R (&x)[corners]) {
    R most = abs(x[0]);
    for (int c = 1; c < corners; ++c) most = max(abs(x[c]), most);
    return most;
  }
  static void evaluate(const BrickFrame& frame, const ColumnLayout& layout, const double* block,
                       const R (&middle)[3], R (&at)[3][corners], R (&reach)[3],
                       SumWeights<R, HexahedronDomain>& w) {
    load_corners(layout, block, at);
    for (int a = 0; a < 3; ++a) {
      const R inverse(frame.inverse_cell[a]);
      const R farthest = reach_of(at[a]) * inverse;
      const R scale = R(cpdi::farthest) / max(farthest, R(cpdi::farthest));
      for (R& x : at[a]) x *= inverse * scale;
      reach[a] = farthest * scale;
    }
    const CornerWeights<R> means = Hexahedron<R>(at).weights();
    for (int c = 0; c < corners; ++c) {
      w.value[c] = means.value[c];
      for (int a = 0; a < 3; ++a) {
        w.slope[c][a] = means.slope[a][c];
        at[a][c] += middle[a];
      }
    }
  }
};

struct Cpdi2 : CornerShape<HexahedronDomain> {
  static constexpr std::string_view name = "CPDI2";

  struct Sample : CornerSample<HexahedronDomain> {
    using CornerSample<HexahedronDomain>::CornerSample;
    /// Moves the corners relative to a particle that takes the mean velocity.
    void carry(const ColumnLayout& layout, double dt, double* block) const {
      double* x = HexahedronDomain::of(layout, block);
      for (int a = 0; a < 3; ++a) {
        const R mean = mean_velocity(a);
        for (int c = 0; c < corners; ++c) {
          double* at = x + block_lanes * (3 * c + a);
          store(at, load<R>(at) + R(dt) * (velocity[c][a] - mean));
        }
      }
    }
  };

  /// Replaces tangled domains, and shifts the particles of a body that is `free` to move with the grid to
  /// their domains' centroids, the domains of another body to their particles.
  static DomainCounts settle(const BrickFrame& frame, const ColumnLayout& layout, bool free, double* block,
                             int used);
  /// As Cpdi.
  static void replace_wide(const BrickFrame& frame, const ColumnLayout& layout, double* block);
};
static_assert(ShapePolicy<Cpdi2>);

}  // namespace mpm::core
