#pragma once
// One brick with particles anywhere in it, faces, edges and corners included, and the textbook's shape
// functions at them, for the tests of the transfer kernels.

#include <array>
#include <cmath>
#include <random>
#include <tuple>
#include <type_traits>
#include <vector>

#include "core/particles/block_pool.hpp"
#include "core/shape/list.hpp"
#include "core/transfer/list.hpp"
#include "tests/support/reference_shape.hpp"

namespace mpm::tests {

/// The shapes of this build, for tests of each.
template <class... S>
constexpr auto built_of(std::type_identity<std::tuple<S...>>) {
  return std::tuple_cat(std::conditional_t<core::is_built<S>, std::tuple<S>, std::tuple<>>()...);
}
using BuiltShapes = decltype(built_of(std::type_identity<core::Shapes>()));

/// Along one axis: S and the factor of its gradient on the particle's n-th node, r = (x - x_i)/h away.
struct AlongAxis {
  double value, slope;
};

/// Thesis 2-17.
inline AlongAxis along_axis(const core::Linear&, int n, double r) {
  return {1 - std::abs(r), n == 0 ? -1.0 : 1.0};
}
/// Half the hat functions of the two centres beside the node; the gradient has the same factors on the other
/// axes.
inline AlongAxis along_axis(const core::Sgmp&, int, double r) {
  const double d = std::abs(r);
  const double outside = std::max(1.5 - d, 0.0);
  return {d < 0.5 ? 0.5 : 0.5 * outside, d < 0.5 ? -2 * r : (r > 0 ? -outside : outside)};
}

/// B-splines as convolutions of boxes: second and third differences of truncated powers.
inline AlongAxis along_axis(const core::QuadraticBSpline&, int, double r) {
  double value = 0, slope = 0;
  const double factor[4] = {1, -3, 3, -1};
  for (int k = 0; k < 4; ++k) {
    const double t = std::max(r + 1.5 - k, 0.0);
    value += factor[k] * t * t / 2;
    slope += factor[k] * t;
  }
  return {value, slope};
}
/// Mean of the hat function over the particle's domain, of half-size l.
inline AlongAxis along_axis(const core::Separable<core::GimpAlong>&, int, double r, double l) {
  const auto area = [](double x) {  // of the hat up to x
    x = std::min(std::max(x, -1.0), 1.0);
    return x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
  };
  const auto hat = [](double x) { return std::max(1 - std::abs(x), 0.0); };
  return {(area(r + l) - area(r - l)) / (2 * l), (hat(r + l) - hat(r - l)) / (2 * l)};
}
inline AlongAxis along_axis(const core::CubicBSpline&, int, double r) {
  double value = 0, slope = 0;
  const double factor[5] = {1, -4, 6, -4, 1};
  for (int k = 0; k < 5; ++k) {
    const double t = std::max(r + 2 - k, 0.0);
    value += factor[k] * t * t * t / 6;
    slope += factor[k] * t * t / 2;
  }
  return {value, slope};
}

/// Shape functions through the corners of the particle's domain.
template <class S>
inline constexpr bool through_corners = std::is_same_v<S, core::Cpdi> || std::is_same_v<S, core::Cpdi2>;

/// A sheared domain about the particle, for CPDI2 no parallelepiped; of half-sizes `half`.
template <class S, class F>
DomainCorners any_domain(const Vector& half, F unit) {
  DomainCorners corner = box(half);
  for (Vector& x : corner) {
    const double y = x[1] / half[1];
    x[0] += 0.4 * y * half[0];
    x[2] -= 0.3 * y * half[2];
    if (std::is_same_v<S, core::Cpdi2>)
      for (std::size_t a = 0; a < 3; ++a) x[a] += 0.25 * half[a] * (2 * unit() - 1);
  }
  const Vector centroid = means_over(corner).centroid;
  for (Vector& x : corner)
    for (std::size_t a = 0; a < 3; ++a) x[a] -= centroid[a];
  return corner;
}
/// In a particle's columns, `stride` doubles apart.
template <class S>
void write_domain(const core::ColumnLayout& layout, const DomainCorners& corner, double* columns,
                  std::size_t stride) {
  const auto put = [&](core::Column first, int i, double value) {
    columns[stride * layout.index(next(first, i))] = value;
  };
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    if constexpr (std::is_same_v<S, core::Cpdi>) {
      for (std::size_t k = 0; k < 3; ++k)
        put(core::Column::edge_1x, 3 * static_cast<int>(k) + axis,
            0.5 * (corner[std::size_t{1} << k][a] - corner[0][a]));
    } else {
      for (std::size_t c = 0; c < 8; ++c)
        put(core::Column::corner_0x, 3 * static_cast<int>(c) + axis, corner[c][a]);
    }
  }
}
template <class S>
DomainCorners read_domain(const core::ColumnLayout& layout, const double* columns, std::size_t stride) {
  const auto get = [&](core::Column first, int i) { return columns[stride * layout.index(next(first, i))]; };
  DomainCorners corner{};
  for (std::size_t c = 0; c < 8; ++c) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      if constexpr (std::is_same_v<S, core::Cpdi>) {
        for (int k = 0; k < 3; ++k)
          corner[c][a] += ((c >> k & 1) != 0 ? 1 : -1) * get(core::Column::edge_1x, 3 * k + axis);
      } else {
        corner[c][a] = get(core::Column::corner_0x, 3 * static_cast<int>(c) + axis);
      }
    }
  }
  return corner;
}

/// 10 x 11 x 9 oblong cells, origin negative: the last bricks are partial. The edges are powers of two, so
/// that positions on faces are exact in cells too: where a compiler fuses a multiplication with a subtraction
/// in one place and not in another, particles would be on either side of a face, and gradients jump there.
inline core::GridGeometry transfer_geometry(core::Site site) {
  core::GridGeometry g;
  g.origin = {-7.25, -20, -16.125};
  g.cell = {0.5, 2, 4};
  g.inverse_cell = {2, 0.5, 0.25};
  g.cells = {10, 11, 9};
  g.site = site;
  return g;
}

template <class S, class T = core::Flip>
struct TransferCase {
  static core::ColumnSet columns() {
    core::ColumnSet set = core::ColumnSet::mechanics();
    set.add(S::columns());
    set.add(T::columns());
    return set;
  }
  core::GridGeometry geometry = transfer_geometry(S::site);
  core::NodeBlockShape shape = S::node_block;
  core::BrickCoord brick;
  core::BlockPool pool{core::ColumnLayout(columns())};
  core::ParticleTile tile;
  core::CellsAround cells;
  core::CellWeightsAround weights;
  std::vector<std::vector<double>> particles;  ///< their columns, in the order of ColumnSet::mechanics()

  TransferCase(core::BrickCoord b, int count, unsigned seed) : brick(b) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const core::BrickFrame f = frame();
    for (int n = 0; n < count; ++n) {
      std::vector<double>& p = particles.emplace_back();
      for (int c = 0; c < pool.layout().columns(); ++c) p.push_back(2 * unit(random) - 1);
      for (int a = 0; a < 3; ++a) {
        double s = f.lowest[a] + (f.beyond[a] - f.lowest[a]) * unit(random);
        // On faces of sites and cells, on edges (n % 5 == 3: none), on corners (n % 5 == 4).
        if (n % 5 == a || n % 5 == 4) s = std::max(0.5 * std::floor(2 * s), f.lowest[a]);
        if (n % 11 == 7) s = on_upper_face(a) ? f.beyond[a] : s;
        p[static_cast<std::size_t>(a)] = geometry.origin[a] + geometry.cell[a] * (f.first_site[a] + s);
      }
      p[6] = 0.5 + unit(random);  // mass
      p[7] = 0.5 + unit(random);  // volume
      for (int a = 0; a < 3; ++a) {
        const core::Column half = next(core::Column::half_size_x, a);
        if (pool.layout().has(half))
          p[pool.layout().index(half)] = geometry.cell[a] * (n % 7 == 3 ? 0.5 : 0.15 + 0.35 * unit(random));
      }
      if constexpr (through_corners<S>) {
        Vector half{};  // some reach more than a cell
        for (std::size_t a = 0; a < 3; ++a)
          half[a] = geometry.cell[static_cast<int>(a)] * (n % 7 == 3 ? 1.2 : 0.15 + 0.3 * unit(random));
        write_domain<S>(pool.layout(), any_domain<S>(half, [&] { return unit(random); }), p.data(), 1);
      }
      append(pool, tile, p.data());
    }
    use_cells(count, random);
    if (random() % 2 == 0) weigh_cells(random);
    if (core::needs_lighter_cells<S> && random() % 2 == 0)
      cells.beside_lighter = std::uint64_t{random()} << 32 | random();
  }

  core::BrickFrame frame() const {
    core::BrickFrame f(geometry, brick);
    f.cells = &cells;
    return f;
  }
  typename S::Place block_place(const double* block, int used = core::block_lanes) const {
    return {frame(), pool.layout(), block, used};
  }

  /// Position in cells from node 0 of the brick, and the particle's lowest node. A point that round-off puts
  /// below its brick is in its first site; the grid's upper face belongs to the last one.
  struct Place {
    std::array<int, 3> lowest, cell;
    std::array<double, 3> position;
  };
  Place place(const std::vector<double>& p) const {
    Place at{};
    for (int a = 0; a < 3; ++a) {
      const auto i = static_cast<std::size_t>(a);
      const int first = first_node(a);
      const double s = (p[i] - geometry.origin[a]) * geometry.inverse_cell[a] - first;
      const double shift = geometry.first_site();
      const int last = geometry.last_site(brick, a);
      const int site = std::min(std::max(static_cast<int>(std::floor(s - shift)), 0), last);
      at.position[i] = s;
      at.lowest[i] = site - (S::nodes_per_axis > 2 ? 1 : 0);
      const int last_cell = static_cast<int>(geometry.cells[i]) - 1 - first;
      at.cell[i] = geometry.site == core::Site::cell
                       ? site
                       : std::min(std::max(static_cast<int>(std::floor(s)), -first), last_cell);
    }
    return at;
  }
  /// Inside a cell beside lighter ones.
  Place acting_place(const std::vector<double>& p) const {
    Place at = place(p);
    if (!core::needs_lighter_cells<S>) return at;
    const auto& c = at.cell;  // one of the brick's own, for such shape functions
    if ((cells.beside_lighter >> (c[0] + core::brick_cells * (c[1] + core::brick_cells * c[2])) & 1) != 0) {
      for (std::size_t a = 0; a < 3; ++a)
        at.position[a] = c[a] + std::clamp(at.position[a] - c[a], core::inset, 1 - core::inset);
    }
    return at;
  }
  /// f(node, S, gradient of S) for the nodes of a particle.
  template <class F>
  void for_each_node(const std::vector<double>& p, F f) const {
    if constexpr (through_corners<S>)
      for_each_node_of_corners(p, f);
    else if constexpr (core::needs_cells<S>)
      for_each_node_of_cells(p, f);
    else
      for_each_node_of_axes(p, f);
  }
  template <class F>
  void for_each_node_of_axes(const std::vector<double>& p, F f) const {
    const Place at = acting_place(p);
    constexpr int n = S::nodes_per_axis;
    for (int i = 0; i < n * n * n; ++i) {
      const int d[3] = {i % n, i / n % n, i / (n * n)};
      double w[3], dw[3];
      int node[3];
      for (int a = 0; a < 3; ++a) {
        const auto k = static_cast<std::size_t>(a);
        node[a] = at.lowest[k] + d[a];
        const AlongAxis along = [&] {
          const double r = at.position[k] - node[a];
          const core::Column half = next(core::Column::half_size_x, a);
          if constexpr (requires { along_axis(S(), d[a], r, 0.0); })
            return along_axis(S(), d[a], r, p[pool.layout().index(half)] / geometry.cell[a]);
          else
            return along_axis(S(), d[a], r);
        }();
        w[a] = along.value;
        dw[a] = along.slope / geometry.cell[a];
      }
      f(shape.index(node[0], node[1], node[2]), w[0] * w[1] * w[2],
        core::Vec3<double>{dw[0] * w[1] * w[2], w[0] * dw[1] * w[2], w[0] * w[1] * dw[2]});
    }
  }

  template <class F>
  void for_each_node_of_corners(const std::vector<double>& p, F f) const {
    const Place at = place(p);
    const Vector cell = {geometry.cell.x, geometry.cell.y, geometry.cell.z};
    const DomainCorners domain = scaled_back(read_domain<S>(pool.layout(), p.data(), 1), cell);
    const HexahedronMeans means = means_over(domain);
    for (int i = 0; i < 64; ++i) {
      const int node[3] = {at.lowest[0] + i % 4, at.lowest[1] + i / 4 % 4, at.lowest[2] + i / 16};
      double value = 0;
      core::Vec3<double> slope{};
      for (std::size_t c = 0; c < 8; ++c) {
        double hats = 1;
        for (std::size_t a = 0; a < 3; ++a)
          hats *= std::max(1 - std::abs(at.position[a] + domain[c][a] / cell[a] - node[a]), 0.0);
        value += means.value[c] * hats;
        slope = slope + hats * core::Vec3<double>{means.slope[c][0], means.slope[c][1], means.slope[c][2]};
      }
      f(shape.index(node[0], node[1], node[2]), value, slope);
    }
  }

  /// Those with particles, both where a particle is on a face between two, and some others; or all.
  template <class Random>
  void use_cells(int count, Random& random) {
    const int last = core::brick_cells;
    for (int k = -1; k <= last; ++k)
      for (int j = -1; j <= last; ++j)
        for (int i = -1; i <= last; ++i)
          if (count % 3 == 2 || random() % 2 == 0) cells.add(i, j, k);
    for (const std::vector<double>& p : particles) {
      for (int n = 0; n < 8; ++n) {
        int c[3];
        for (int a = 0; a < 3; ++a) {
          const auto i = static_cast<std::size_t>(a);
          const double s = (p[i] - geometry.origin[a]) / geometry.cell[a] - first_node(a);
          c[a] = std::min(static_cast<int>(std::floor(s + ((n >> a & 1) != 0 ? 1e-9 : -1e-9))), last);
        }
        cells.add(std::max(c[0], -1), std::max(c[1], -1), std::max(c[2], -1));
      }
    }
  }
  /// By weights of any scale that differ up to a hundredfold.
  template <class Random>
  void weigh_cells(Random& random) {
    std::uniform_real_distribution<double> exponent(-2, 0);
    for (auto& row : weights.row)
      for (double& weight : row) weight = 1e-9 * std::pow(10, exponent(random));
    for (int n = 0; n < core::CellsAround::side * core::CellsAround::side; ++n)
      for (int i = 0; i < core::CellWeightsAround::row_doubles; ++i)
        if (i >= core::CellsAround::side ||
            !cells.has(i - 1, n % core::CellsAround::side - 1, n / core::CellsAround::side - 1))
          weights.row[n][i] = 0;
    cells.weights = &weights;
  }
  template <class F>
  void for_each_node_of_cells(const std::vector<double>& p, F f) const {
    constexpr int n = core::CellsAround::side;
    ReferenceGrid grid{.shape = ReferenceShape::ddmp, .cells = {n, n, n}};
    for (int a = 0; a < 3; ++a) {
      grid.cell[static_cast<std::size_t>(a)] = geometry.cell[a];
      grid.origin[static_cast<std::size_t>(a)] = geometry.origin[a] + geometry.cell[a] * (first_node(a) - 1);
    }
    for (int c = 0; c < n * n * n; ++c)
      grid.weight.push_back(cells.weight(c % n - 1, c / n % n - 1, c / (n * n) - 1));
    Vector x = {p[0], p[1], p[2]};
    if (cells.beside_lighter != 0) {
      const Place at = acting_place(p);
      for (std::size_t a = 0; a < 3; ++a)
        x[a] = geometry.origin[static_cast<int>(a)] +
               geometry.cell[static_cast<int>(a)] * (first_node(static_cast<int>(a)) + at.position[a]);
    }
    const WideSupport support = wide_support(grid, x);
    for (std::size_t i = 0; i < support.count; ++i) {
      const WideSupport::Entry& entry = support.entry[i];
      const Vector& g = entry.slope[0];
      if (entry.mass == 0 && g == Vector{}) continue;  // beyond the cells
      const std::array<int, 3>& node = entry.node;
      f(shape.index(node[0] - 1, node[1] - 1, node[2] - 1), entry.mass, core::Vec3<double>{g[0], g[1], g[2]});
    }
  }

  core::Vec3<double> node_position(int node) const {
    const int side = shape.side();
    const int at[3] = {node % side, node / side % side, node / (side * side)};
    core::Vec3<double> x;
    for (int a = 0; a < 3; ++a)
      x[a] = geometry.origin[a] + geometry.cell[a] * (first_node(a) + at[a] + shape.lowest());
    return x;
  }
  int first_node(int axis) const {
    return core::brick_cells * (axis == 0 ? brick.x : axis == 1 ? brick.y : brick.z);
  }
  bool on_upper_face(int axis) const {
    return first_node(axis) + core::brick_cells >= geometry.cells[static_cast<std::size_t>(axis)];
  }
};

}  // namespace mpm::tests
