// Trilinear shape functions (thesis 2-17, 2-20): S_i = product over the axes of 1 - |x - x_i|/h on the eight
// nodes of the particle's cell.
//
// Grid to particles: particles in the vector lanes; each distinct cell among the eight particles is visited
// once. Particles to grid: the eight nodes of a cell in the lanes; each particle adds to ten vectors
// (momentum, mass, V sigma), which are converted to node records and written only when the cell changes.
// Particles are stored in approximate cell order, so this happens about once in eight. Shown against a plain
// loop by tests/core/step.
//
// Beside much lighter material a particle acts from the nearest point that is `inset` of an edge or more from
// the faces of its cell: S_i and their gradients are those of this point. A heavy particle that comes into a
// cell else brings its whole stress to nodes that have their mass of light particles, before it brings mass,
// and a step would have to be shorter by (rho_light/rho_heavy)^(1/2) (docs/stability.md). DDMP does the same.
//
// These kernels also serve shape functions that pass through values at other points of a lattice of cells of
// this size, such as the cells' centres (sgmp.hpp): the points around a brick's sites take the nodes' place.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/shape/shape.hpp"
#include "core/simd/transpose.hpp"

namespace mpm::core {

/// The points of the lattice around a brick's sites: the corners of 4 x 4 x 4 cells.
inline constexpr NodeBlockShape lattice_points{};

/// Particles in lanes: position within the site as fractions of its edges, and its lowest point.
template <class T>
struct LocatedInSites {
  T fx, fy, fz;
  int node[LaneTraits<T>::width];
};

/// `x`, `y`, `z`: columns of a block from the lane on. Unused lanes are clamped into the brick. Points are
/// numbered in a block of side^3.
template <class T, int side = lattice_points.side()>
inline LocatedInSites<T> locate_in_sites(const BrickFrame& f, const double* x, const double* y,
                                         const double* z) {
  const T sx = GridGeometry::scaled(load<T>(x), f.origin.x, f.inverse_cell.x) - T(f.first_site.x);
  const T sy = GridGeometry::scaled(load<T>(y), f.origin.y, f.inverse_cell.y) - T(f.first_site.y);
  const T sz = GridGeometry::scaled(load<T>(z), f.origin.z, f.inverse_cell.z) - T(f.first_site.z);
  // max(s, 0) maps NaN to 0, so that the index is always valid.
  const T cx = min(max(floor(sx), T(0.0)), T(f.last_site.x));
  const T cy = min(max(floor(sy), T(0.0)), T(f.last_site.y));
  const T cz = min(max(floor(sz), T(0.0)), T(f.last_site.z));
  LocatedInSites<T> p{sx - cx, sy - cy, sz - cz, {}};
  constexpr int width = LaneTraits<T>::width;
  double node[width];
  store(node, cx + T(double(side)) * (cy + T(double(side)) * cz));
  for (int i = 0; i < width; ++i) p.node[i] = static_cast<int>(node[i]);
  return p;
}

/// Position of a block's particles within their sites.
struct LinearPlace {
  alignas(64) double f[3][block_lanes];  ///< fractions of the site's edges
  int node[block_lanes];

  LinearPlace() = default;
  LinearPlace(const BrickFrame& frame, const ColumnLayout& layout, const double* block, int used) {
    find(frame, layout, block, used);
  }
  void find(const BrickFrame& frame, const ColumnLayout& layout, const double* block, int) {
    const double* x = block + layout.offset(Column::position_x);
    for (int l = 0; l < block_lanes; l += real_width) {
      const auto p = locate_in_sites<Real>(frame, x + l, x + block_lanes + l, x + 2 * block_lanes + l);
      store(f[0] + l, p.fx);
      store(f[1] + l, p.fy);
      store(f[2] + l, p.fz);
      for (int i = 0; i < real_width; ++i) node[l + i] = p.node[i];
    }
  }
};

/// The number i + 4 j + 16 k of a brick's cell, by its lowest point.
constexpr int cell_at(int point) {
  const auto [i, j, k] = lattice_points.node(point);
  return i + brick_cells * (j + brick_cells * k);
}

/// Least distance from the faces of a cell beside lighter ones, over the edge.
inline constexpr double inset = 0.15;

/// Of particles that act from inside some of the cells, CellsAround::beside_lighter.
struct InsetPlace : LinearPlace {
  InsetPlace() = default;
  InsetPlace(const BrickFrame& frame, const ColumnLayout& layout, const double* block, int used) {
    find(frame, layout, block, used);
  }
  void find(const BrickFrame& frame, const ColumnLayout& layout, const double* block, int used) {
    LinearPlace::find(frame, layout, block, used);
    if (frame.cells != nullptr && frame.cells->beside_lighter != 0)
      move_inside(frame.cells->beside_lighter, used);
  }

 private:
  void move_inside(std::uint64_t cells, int used) {
    for (int l = 0; l < used; ++l) {
      if ((cells >> cell_at(node[l]) & 1) == 0) continue;
      for (auto& along : f) along[l] = std::clamp(along[l], inset, 1 - inset);
    }
  }
};

/// Point number `n` = i + 2 j + 4 k of a site, relative to its lowest one.
template <NodeBlockShape shape = lattice_points>
constexpr int corner_node(int n) {
  return (n & 1) + shape.side() * ((n >> 1 & 1) + shape.side() * (n >> 2));
}

/// f(lowest node, lanes) for each cell that holds particles of the block, with their lanes.
template <class Place, class F>
inline void for_each_cell(const Place& place, F f) {
  using Mask = LaneMask<block_lanes>;
  typedef int Nodes __attribute__((vector_size(block_lanes * sizeof(int))));
  Nodes nodes;
  std::memcpy(&nodes, place.node, sizeof nodes);
  const auto wide = __builtin_convertvector(nodes, Mask::vector);
  for (unsigned left = (1u << block_lanes) - 1; left != 0;) {
    const int node = place.node[__builtin_ctz(left)];
    const Mask here{wide == std::int64_t{node}};
    left &= ~bits(here);
    f(node, here);
  }
}

namespace linear {
using Nodes = Lanes<8>;

/// A node's weight along an axis is 1 - f or f; this is its slope.
inline Nodes sign_x() { return Nodes::vector{-1, 1, -1, 1, -1, 1, -1, 1}; }
inline Nodes sign_y() { return Nodes::vector{-1, -1, 1, 1, -1, -1, 1, 1}; }
inline Nodes sign_z() { return Nodes::vector{-1, -1, -1, -1, 1, 1, 1, 1}; }

/// The weight of the upper node is f, of the lower 1 - f.
inline Nodes one_x() { return Nodes::vector{1, 0, 1, 0, 1, 0, 1, 0}; }
inline Nodes one_y() { return Nodes::vector{1, 1, 0, 0, 1, 1, 0, 0}; }
inline Nodes one_z() { return Nodes::vector{1, 1, 1, 1, 0, 0, 0, 0}; }

/// Each node of an edge along an axis gets the sum of the two.
inline Nodes along_x(Nodes a) { return a.v + __builtin_shufflevector(a.v, a.v, 1, 0, 3, 2, 5, 4, 7, 6); }
inline Nodes along_y(Nodes a) { return a.v + __builtin_shufflevector(a.v, a.v, 2, 3, 0, 1, 6, 7, 4, 5); }
inline Nodes along_z(Nodes a) { return a.v + __builtin_shufflevector(a.v, a.v, 4, 5, 6, 7, 0, 1, 2, 3); }

/// Of a point at these fractions of the cell's edges, and of particle `i` of a block.
[[gnu::always_inline]] inline Nodes weights_at(double x, double y, double z) {
  const Nodes wx = one_x() + sign_x() * Nodes(x), wy = one_y() + sign_y() * Nodes(y),
              wz = one_z() + sign_z() * Nodes(z);
  return wx * wy * wz;
}
[[gnu::always_inline]] inline Nodes weights(const LinearPlace& place, int i) {
  return weights_at(place.f[0][i], place.f[1][i], place.f[2][i]);
}

/// The force on a node is minus the sum of V sigma times the weight's gradient. A gradient component is a
/// sign over the cell's edge times the weights along the other two axes, and that product is the sum of the
/// weights of the edge's two nodes. So V sigma is summed with the weights themselves and converted once per
/// cell: `r`, three components, from the sums.
[[gnu::always_inline]] inline void forces(const BrickFrame& frame, Nodes xx, Nodes yy, Nodes zz, Nodes xy,
                                          Nodes yz, Nodes xz, Nodes* r) {
  const Nodes gx = sign_x() * Nodes(-frame.inverse_cell.x), gy = sign_y() * Nodes(-frame.inverse_cell.y),
              gz = sign_z() * Nodes(-frame.inverse_cell.z);
  r[0] = gx * along_x(xx) + gy * along_y(xy) + gz * along_z(xz);
  r[1] = gx * along_x(xy) + gy * along_y(yy) + gz * along_z(yz);
  r[2] = gx * along_x(xz) + gy * along_y(yz) + gz * along_z(zz);
}
}  // namespace linear

/// Sums of momentum and mass over the particles of one cell, point i + 2 j + 4 k in lane i + 2 j + 4 k.
template <NodeFields what>
struct MomentumSums {
  linear::Nodes px, py, pz, m;

  void clear() { px = py = pz = m = linear::Nodes(0.0); }
  /// Particle `i` of the block, with the weights `w`.
  [[gnu::always_inline]] void add(linear::Nodes w, int i, const MappedRows& rows) {
    using N = linear::Nodes;
    if constexpr (!maps_momentum(what)) return;
    if constexpr (maps_mass(what)) m += w * N(rows.mass[i]);
    px += w * N(rows.momentum[0][i]);
    py += w * N(rows.momentum[1][i]);
    pz += w * N(rows.momentum[2][i]);
  }
};

/// The same and of V sigma times the weights.
template <NodeFields what>
struct CellSums : MomentumSums<what> {
  linear::Nodes xx, yy, zz, xy, yz, xz;

  void clear() {
    MomentumSums<what>::clear();
    xx = yy = zz = xy = yz = xz = linear::Nodes(0.0);
  }
  /// Particle `i` of the block.
  [[gnu::always_inline]] void add(const LinearPlace& place, int i, const MappedRows& rows) {
    using N = linear::Nodes;
    const N w = linear::weights(place, i);
    MomentumSums<what>::add(w, i, rows);
    if constexpr (maps_force(what)) {
      xx += w * N(rows.stress[0][i]);
      yy += w * N(rows.stress[1][i]);
      zz += w * N(rows.stress[2][i]);
      xy += w * N(rows.stress[3][i]);
      yz += w * N(rows.stress[4][i]);
      xz += w * N(rows.stress[5][i]);
    }
  }
};

/// Adds eight components of eight points, r[component], to the first eight doubles of the points' records of
/// `width` doubles.
template <int width, NodeBlockShape shape = lattice_points>
[[gnu::always_inline]] inline void add_to_corners(linear::Nodes r[8], double* lowest) {
  using Record = Lanes<8>;
  transpose(r);
  for (int n = 0; n < 8; ++n) {
    double* at = lowest + width * corner_node<shape>(n);
    store(at, load<Record>(at) + r[n]);
  }
}
/// Adds four components, r[component], to records of four doubles.
template <NodeBlockShape shape = lattice_points>
[[gnu::always_inline]] inline void add_half_to_corners(linear::Nodes r[4], double* lowest) {
  using Record = Lanes<4>;
  transpose_half(r);
  for (int n = 0; n < 8; ++n) {
    double* at = lowest + 4 * corner_node<shape>(n);
    store(at, load<Record>(at) + half_of(r[n / 2], n % 2));
  }
}

/// Adds a block's particles to the sums of the current cell; when the cell changes, Store::add(sums, frame,
/// records, its lowest point) adds these to the records, of `Store::width` doubles, of the brick's points.
template <class Sums, class Store>
struct CellScatter {
  static constexpr int width = Store::width;
  Sums sums;
  int node = -1;

  void clear() { sums.clear(); }

  template <class Place>
  [[gnu::always_inline]] void add(const BrickFrame& frame, const Place& place, int i, const MappedRows& rows,
                                  double* records) {
    if (place.node[i] != node) {
      flush(frame, records);
      clear();
      node = place.node[i];
    }
    sums.add(place, i, rows);
  }
  [[gnu::always_inline]] void flush(const BrickFrame& frame, double* records) {
    if (node >= 0) Store::add(sums, frame, records, node);
  }
};

/// Momentum, mass and forces to the nodes' records.
template <NodeFields what>
struct NodeStore {
  static constexpr int width = record_doubles(what.array);
  [[gnu::always_inline]] static void add(const CellSums<what>& s, const BrickFrame& frame, double* records,
                                         int node) {
    using N = linear::Nodes;
    double* const lowest = records + width * node;
    N r[8] = {s.px, s.py, s.pz, s.m, N(0.0), N(0.0), N(0.0), N(0.0)};
    if constexpr (maps_force(what)) linear::forces(frame, s.xx, s.yy, s.zz, s.xy, s.yz, s.xz, r + 4);
    if constexpr (width == 8) {
      add_to_corners<width>(r, lowest);
    } else {
      add_half_to_corners(r, lowest);
    }
  }
};

/// Mean divergence in a cell from the mean differences along its edges; component(n, a): component `a` at
/// corner n = i + 2 j + 4 k.
template <class F>
inline double mean_divergence(const BrickFrame& frame, F component) {
  double divergence = 0;
  for (int a = 0; a < 3; ++a) {
    double difference = 0;
    for (int n = 0; n < 8; ++n) {
      const double v = component(n, a);
      difference += (n >> a & 1) != 0 ? v : -v;
    }
    divergence += 0.25 * frame.inverse_cell[a] * difference;
  }
  return divergence;
}
/// Of three components of the records of a cell's nodes, from those of the lowest on, in a node block of this
/// shape.
template <NodeBlockShape shape>
inline double mean_divergence(const BrickFrame& frame, const double* lowest) {
  constexpr int strides[3] = {1, shape.side(), shape.side() * shape.side()};
  return mean_divergence(frame, [&](int n, int a) {
    const int node = (n & 1) * strides[0] + (n >> 1 & 1) * strides[1] + (n >> 2) * strides[2];
    return lowest[node_doubles * node + a];
  });
}

/// Derivatives of the trilinear interpolation along the axes, times the edges: at(n) is the value at corner
/// n = i + 2 j + 4 k, and x, y, z are the fractions of the edges.
template <class F>
[[gnu::always_inline]] inline void trilinear_differences(F at, Lanes<8> x, Lanes<8> y, Lanes<8> z,
                                                         Lanes<8> (&result)[3]) {
  using R = Lanes<8>;
  // Differences along x on the four edges, and the values at x; then the same along y and z.
  R d[4], u[4];
  for (int e = 0; e < 4; ++e) {
    d[e] = at(2 * e + 1) - at(2 * e);
    u[e] = at(2 * e) + x * d[e];
  }
  const R lower = u[1] - u[0], upper = u[3] - u[2];
  const R d_lower = d[0] + y * (d[1] - d[0]), d_upper = d[2] + y * (d[3] - d[2]);
  result[0] = d_lower + z * (d_upper - d_lower);
  result[1] = lower + z * (upper - lower);
  result[2] = (u[2] + y * upper) - (u[0] + y * lower);
}

/// Weights of the eight points for a block's particles.
struct LinearWeights {
  using R = Lanes<8>;
  R weight[8];
  explicit LinearWeights(const LinearPlace& place) {
    const R x = load<R>(place.f[0]), y = load<R>(place.f[1]), z = load<R>(place.f[2]);
    const R one(1.0), xy = x * y, low = one - z;
    const R face[4] = {one - x - y + xy, x - xy, y - xy, xy};
    for (int i = 0; i < 4; ++i) weight[i] = face[i] * low, weight[4 + i] = face[i] * z;
  }
  const R& operator[](int n) const { return weight[n]; }
};

/// Interpolates three consecutive components of the node records, from `nodes` on, to the block's particles.
struct LinearInterpolation {
  using R = Lanes<8>;
  R value[3];
  LinearInterpolation(const LinearPlace& place, const double* nodes) : value{0.0, 0.0, 0.0} {
    const LinearWeights weight(place);
    for_each_cell(place, [&](int node, auto here) {
      const double* lowest = nodes + node_doubles * node;
      for (int i = 0; i < 3; ++i) {
        R sum = weight[0] * R(lowest[i]);
        for (int n = 1; n < 8; ++n) sum += weight[n] * R(lowest[node_doubles * corner_node(n) + i]);
        value[i] = select(here, sum, value[i]);
      }
    });
  }
};

struct Linear {
  static constexpr std::string_view name = "linear";
  static constexpr Site site = Site::cell;
  static constexpr NodeBlockShape node_block = lattice_points;
  static constexpr int nodes_per_axis = 2;
  static ColumnSet columns() { return {}; }
  static constexpr bool needs_lighter_cells = true;
  using Place = InsetPlace;
  using Interpolation = LinearInterpolation;
  template <NodeFields what>
  using Scatter = CellScatter<CellSums<what>, NodeStore<what>>;

  /// Particles add to the nodes' records themselves ...
  template <NodeFields what>
  struct Sums {
    double* records;
    explicit Sums(double* contributions) : records(contributions) {}
    void finish(const BrickFrame&, const NodeMask* = nullptr) {}
  };
  /// ... and read them.
  struct Field {
    const double* nodes = nullptr;
    void take_motion(const double* records, const NodeMask* = nullptr) { nodes = records; }
    void take_strain(const BrickFrame&, const double* records, const NodeMask* = nullptr) { nodes = records; }
    const double* velocity() const { return nodes + Motion::velocity_at; }
    const double* increment() const { return nodes + Motion::increment_at; }
  };

  template <class Rows>
  static void gradient(const BrickFrame& frame, const LinearPlace& place, const Field& field, Rows& rows,
                       int at) {
    const double* nodes = field.nodes + Motion::strain_velocity_at;
    using R = Lanes<8>;
    const R x = load<R>(place.f[0]), y = load<R>(place.f[1]), z = load<R>(place.f[2]);
    R gradient[9] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for_each_cell(place, [&](int node, auto here) {
      const double* lowest = nodes + node_doubles * node;
      for (int i = 0; i < 3; ++i) {
        R d[3];
        trilinear_differences([&](int n) { return R(lowest[node_doubles * corner_node(n) + i]); }, x, y, z,
                              d);
        for (int j = 0; j < 3; ++j) gradient[3 * i + j] = select(here, d[j], gradient[3 * i + j]);
      }
    });
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) store(rows[3 * i + j] + at, gradient[3 * i + j] * R(frame.inverse_cell[j]));
    }
  }

  static void cell_divergence(const BrickFrame& frame, const LinearPlace& place, const Field& field,
                              double factor, double* row, int at) {
    const double* nodes = field.nodes + Motion::strain_velocity_at;
    for_each_cell(place, [&](int node, auto here) {
      const double divergence = mean_divergence<node_block>(frame, nodes + node_doubles * node);
      store(row + at, select(here, Lanes<8>(divergence * factor), load<Lanes<8>>(row + at)));
    });
  }

  /// In the brick's node block, of the particle of a lane.
  static int lowest_of(const LinearPlace& place, int lane) { return place.node[lane]; }
  /// f(node, S, gradient of S) for the nodes of the cell that holds the particle of a lane: for terms
  /// too infrequent to vectorise.
  template <class F>
  static void for_each_node(const LinearPlace& place, int lane, const Vec3<double>& inverse_cell, F f) {
    const double fraction[3] = {place.f[0][lane], place.f[1][lane], place.f[2][lane]};
    for (int n = 0; n < 8; ++n) {
      const int offset[3] = {n & 1, n >> 1 & 1, n >> 2};
      double w[3], slope[3];
      for (int a = 0; a < 3; ++a) {
        w[a] = offset[a] == 1 ? fraction[a] : 1 - fraction[a];
        slope[a] = (offset[a] == 1 ? 1 : -1) * inverse_cell[a];
      }
      f(place.node[lane] + corner_node(n), w[0] * w[1] * w[2],
        Vec3<double>{slope[0] * w[1] * w[2], w[0] * slope[1] * w[2], w[0] * w[1] * slope[2]});
    }
  }
};
static_assert(ShapePolicy<Linear>);

}  // namespace mpm::core
