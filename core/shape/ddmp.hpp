// Dual domain material point method (DDMP; Zhang, Ma and Giguere, J. Comput. Phys. 230 (2011) 6379): values
// with the trilinear S_i, gradients with a blend of two,
//   grad w_i(x) = alpha grad S_i(x) + (1 - alpha) sum_j S_j(x) G_ji,   alpha = product of 4 f (1 - f) over
// the axes, f the position in the cell. alpha vanishes on the cells' faces, so that forces are continuous
// (but beside much lighter material, where particles act from inside their cells: linear.hpp).
// G_ji is the mean gradient of S_i at node j. Here it is a mean over the cells around j that are in use,
//   G_ji = sum_c w_c int_c S_j grad S_i dV / (sum_c w_c V/8),   V the volume of a cell,
// so that no force reaches a node without mass at a free surface, and linear fields stay exact there. The
// weight w_c is 1 or, beside material more than ten times as dense, follows the density in the cell
// (core/step/cells_in_use.hpp). Else the stresses of a heavy body would act, through nodes at its surface, on
// nodes that have their mass of light particles alone, whose accelerations would take steps shorter by the
// root of the ratio of densities.
// Particles to grid is the adjoint: f_i = -sum_p V_p alpha sigma_p grad S_i - sum_j G_ji T_j, with T_j =
// sum_p (1 - alpha) S_j V_p sigma_p.
//
// A cell is in use where it holds particles, in contact those of the component. Beyond a free or
// nonreflecting face of the grid none is. Beyond a fixed, symmetry or rigid face the mirror images of cells
// in use are, and the outer nodes follow the rules of BoundaryFaces: half a body at a symmetry face moves as
// half of the whole.
//
// Limits: a particle exactly on the face of a cell that holds no other one maps force to nodes that get no
// mass of it, as with trilinear functions.
#pragma once

#include <type_traits>

#include "core/shape/linear.hpp"

namespace mpm::core {

namespace ddmp {

/// Rows of nodes along x, in lanes; nodes -1 .. brick_cells + 1 along each axis, lane 7 out of use. A cell
/// has the lane of its lower node.
using Row = Lanes<8>;
inline constexpr NodeBlockShape node_block{1, 1};
inline constexpr int row_doubles = 8;
static_assert(node_block.side() < row_doubles);

/// One component of all nodes, row by row along y and z; x_0 in lane 1.
struct NodeRows {
  static constexpr int side = node_block.side(), doubles = row_doubles * side * side;
  /// Of a point of lattice_points.
  static constexpr int index(int point) {
    const auto [i, j, k] = lattice_points.node(point);
    return i + 1 + row_doubles * (j + 1 + side * (k + 1));
  }
  /// Corner number `n` = i + 2 j + 4 k of a cell, relative to its lowest one.
  static constexpr int corner(int n) { return (n & 1) + row_doubles * ((n >> 1 & 1) + side * (n >> 2)); }
};

/// Of a component of a gradient at the lattice's points: room for whole rows of vectors.
inline constexpr int gradient_doubles = lattice_points.nodes() + row_doubles - lattice_points.side();

/// A point's sums: momentum, mass and the force of the direct gradients, as a node's record; T_j.
inline constexpr int sum_doubles = 16;

}  // namespace ddmp

struct DdmpPlace : InsetPlace {
  const CellsAround* cells = nullptr;

  DdmpPlace() = default;
  DdmpPlace(const BrickFrame& frame, const ColumnLayout& layout, const double* block, int used) {
    find(frame, layout, block, used);
  }
  void find(const BrickFrame& frame, const ColumnLayout& layout, const double* block, int used) {
    InsetPlace::find(frame, layout, block, used);
    cells = frame.cells;
  }
  Lanes<8> alpha() const {
    using R = Lanes<8>;
    R product(64.0);
    for (const auto& fraction : f) product *= load<R>(fraction) * (R(1.0) - load<R>(fraction));
    return product;
  }
};

namespace ddmp {

/// A block's particles with alpha, for forces.
struct BlendedPlace {
  const DdmpPlace& place;
  const int (&node)[block_lanes];
  alignas(64) double alpha[block_lanes];
  explicit BlendedPlace(const DdmpPlace& of) : place(of), node(of.node) { store(alpha, of.alpha()); }
};

/// Sums over the particles of one cell: V sigma times S alpha and S (1 - alpha), xx yy zz xy yz xz.
template <NodeFields what>
struct CellSums : MomentumSums<what> {
  linear::Nodes direct[6], averaged[6];

  void clear() {
    MomentumSums<what>::clear();
    for (int i = 0; i < 6; ++i) direct[i] = averaged[i] = linear::Nodes(0.0);
  }
  [[gnu::always_inline]] void add(const DdmpPlace& place, int i, const MappedRows& rows) {
    MomentumSums<what>::add(linear::weights(place, i), i, rows);
  }
  [[gnu::always_inline]] void add(const BlendedPlace& blended, int i, const MappedRows& rows) {
    using N = linear::Nodes;
    const N w = linear::weights(blended.place, i);
    MomentumSums<what>::add(w, i, rows);
    const N with_alpha = N(blended.alpha[i]) * w, rest = w - with_alpha;
    for (int c = 0; c < 6; ++c) {
      const N stress(rows.stress[c][i]);
      direct[c] += with_alpha * stress;
      averaged[c] += rest * stress;
    }
  }
};

/// The sums to the records of the lattice's points; without forces to those of the nodes.
template <NodeFields what>
struct PointStore {
  static constexpr int width = maps_force(what) ? sum_doubles : 4;
  [[gnu::always_inline]] static void add(const CellSums<what>& s, const BrickFrame& frame, double* records,
                                         int node) {
    using N = linear::Nodes;
    if constexpr (maps_force(what)) {
      double* const lowest = records + width * node;
      const N(&d)[6] = s.direct;
      N point[8] = {s.px, s.py, s.pz, s.m, N(0.0), N(0.0), N(0.0), N(0.0)};
      linear::forces(frame, d[0], d[1], d[2], d[3], d[4], d[5], point + 4);
      add_to_corners<width>(point, lowest);
      N stress[8] = {s.averaged[0], s.averaged[1], s.averaged[2], s.averaged[3],
                     s.averaged[4], s.averaged[5], N(0.0),        N(0.0)};
      add_to_corners<width>(stress, lowest + 8);
    } else {
      N momentum[4] = {s.px, s.py, s.pz, s.m};
      const auto [i, j, k] = lattice_points.node(node);
      add_half_to_corners<node_block>(momentum, records + width * node_block.index(i, j, k));
    }
  }
};

template <NodeFields what>
struct Scatter : CellScatter<CellSums<what>, PointStore<what>> {
  /// Adds the first `used` particles of a block.
  [[gnu::always_inline]] void add_block(const BrickFrame& frame, const DdmpPlace& place, int used,
                                        const MappedRows& rows, double* records) {
    if constexpr (maps_force(what)) {
      const BlendedPlace blended(place);
      for (int i = 0; i < used; ++i) this->add(frame, blended, i, rows, records);
    } else {
      for (int i = 0; i < used; ++i) this->add(frame, place, i, rows, records);
    }
  }
};

/// To the nodes of a brick the momentum, mass and direct forces of the lattice's points, and -sum_j G_ji T_j.
/// `sums`: records of sum_doubles; `nodes`: contributions to the first array.
template <Onto onto>
void sums_to_nodes(const BrickFrame& frame, const double* sums, double* nodes);
/// Sums at the lattice's points. Momentum and mass alone go to the nodes themselves.
class PointSums {
 public:
  explicit PointSums(double* contributions) : records(lattice_), contributions_(contributions) {}
  void finish(const BrickFrame& frame, const NodeMask* = nullptr) {
    sums_to_nodes<Onto::contributions>(frame, lattice_, contributions_);
  }
  void replace(const BrickFrame& frame) { sums_to_nodes<Onto::nothing>(frame, lattice_, contributions_); }
  double* records;

 private:
  alignas(64) double lattice_[sum_doubles * lattice_points.nodes()] = {};
  double* contributions_;
};

/// The records of the lattice's points among those of the nodes.
void nodes_to_lattice(const double* nodes, double* lattice);
/// The strain velocities of nodes' records in rows, three components; or those of their momenta and masses,
/// zero where there is no more mass than `cutoff`.
void velocity_rows(const double* nodes, double* velocity);
void velocity_rows(double cutoff, const double* momenta, double* velocity);
/// Gradients of them, nine components in the order of Mat3, each of all points of the lattice: along the
/// edges from a point to the next ones, and D_j = sum_i v_i (x) G_ji.
void edge_gradients(const Vec3<double>& inverse_cell, const double* velocity, double* gradient);
void averaged_gradients(const BrickFrame& frame, const double* velocity, double* gradient);

}  // namespace ddmp

struct Ddmp {
  static constexpr std::string_view name = "DDMP";
  static constexpr Site site = Site::cell;
  static constexpr NodeBlockShape node_block = ddmp::node_block;
  static constexpr NodeBlockShape momentum_block = lattice_points;
  static constexpr int nodes_per_axis = 4;
  static constexpr bool needs_cells = true, needs_lighter_cells = true;
  static ColumnSet columns() { return {}; }
  using NodeRows = ddmp::NodeRows;
  using Place = DdmpPlace;
  using Interpolation = LinearInterpolation;
  template <NodeFields what>
  using Scatter = ddmp::Scatter<what>;

  template <NodeFields what>
  using Sums = std::conditional_t<maps_force(what), ddmp::PointSums, Linear::Sums<what>>;

  /// Motion of the lattice's points; strain velocities of all nodes, their derivatives along edges and their
  /// averaged gradients.
  class Field {
   public:
    void take_motion(const double* nodes, const NodeMask* = nullptr) {
      ddmp::nodes_to_lattice(nodes, motion_);
    }
    void take_strain(const BrickFrame& frame, const double* nodes, const NodeMask* = nullptr) {
      ddmp::velocity_rows(nodes, velocity_);
      find_gradients(frame);
    }
    /// The same from records of momentum and mass.
    void take_strain(const BrickFrame& frame, double mass_cutoff, const double* momenta) {
      ddmp::velocity_rows(mass_cutoff, momenta, velocity_);
      find_gradients(frame);
    }
    const double* velocity() const { return motion_ + Motion::velocity_at; }
    const double* increment() const { return motion_ + Motion::increment_at; }
    /// In rows.
    const double* strain_velocity() const { return velocity_; }
    const double* edge_gradient() const { return edge_; }
    const double* averaged_gradient() const { return gradient_; }

   private:
    void find_gradients(const BrickFrame& frame) {
      ddmp::edge_gradients(frame.inverse_cell, velocity_, edge_);
      ddmp::averaged_gradients(frame, velocity_, gradient_);
    }
    alignas(64) double motion_[node_doubles * lattice_points.nodes()];
    alignas(64) double velocity_[3 * ddmp::NodeRows::doubles];
    alignas(64) double edge_[9 * ddmp::gradient_doubles], gradient_[9 * ddmp::gradient_doubles];
  };

  /// A derivative of the trilinear functions is a mean of those along the cell's four edges.
  template <class Rows>
  static void gradient(const BrickFrame&, const Place& place, const Field& field, Rows& rows, int at) {
    using R = Lanes<8>;
    const R alpha = place.alpha(), rest = R(1.0) - alpha;
    const LinearWeights weight(place);
    R of_corner[8], of_edge[3][8];  // the latter at the edge's lower corner
    for (int n = 0; n < 8; ++n) {
      of_corner[n] = rest * weight[n];
      for (int a = 0; a < 3; ++a)
        if ((n >> a & 1) == 0) of_edge[a][n] = alpha * (weight[n] + weight[n + (1 << a)]);
    }
    R gradient[9] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for_each_cell(place, [&](int lowest, auto here) {
#pragma GCC unroll 9
      for (int i = 0; i < 9; ++i) {
        const double* averaged = field.averaged_gradient() + ddmp::gradient_doubles * i + lowest;
        const double* edge = field.edge_gradient() + ddmp::gradient_doubles * i + lowest;
        R sum(0.0);
#pragma GCC unroll 8
        for (int n = 0; n < 8; ++n) {
          sum += of_corner[n] * R(averaged[corner_node(n)]);
          if ((n >> i % 3 & 1) == 0) sum += of_edge[i % 3][n] * R(edge[corner_node(n)]);
        }
        gradient[i] = select(here, sum, gradient[i]);
      }
    });
    for (int i = 0; i < 9; ++i) store(rows[i] + at, gradient[i]);
  }

  /// Of the trilinear functions.
  static void cell_divergence(const BrickFrame& frame, const Place& place, const Field& field, double factor,
                              double* row, int at) {
    for_each_cell(place, [&](int point, auto here) {
      const double* lowest = field.strain_velocity() + NodeRows::index(point);
      const double divergence = mean_divergence(
          frame, [&](int n, int a) { return lowest[NodeRows::doubles * a + NodeRows::corner(n)]; });
      store(row + at, select(here, Lanes<8>(divergence * factor), load<Lanes<8>>(row + at)));
    });
  }

  template <class F>
  static void for_each_weight(const Place& place, int lane, F f) {
    Linear::for_each_node(place, lane, {1, 1, 1}, [&](int node, double shape, const Vec3<double>&) {
      const auto [i, j, k] = lattice_points.node(node);
      f(node_block.index(i, j, k), shape);
    });
  }
  template <class F>
  static void for_each_node(const Place& place, int lane, const Vec3<double>& inverse_cell, F f) {
    double shape[64];
    Vec3<double> gradient[64];
    shape_and_gradient(place, lane, inverse_cell, shape, gradient);
    const int lowest = lowest_of_cell(place, lane) - node_block.index(0, 0, 0);
    for (int n = 0; n < 64; ++n) {
      const int i = n % 4, j = n / 4 % 4, k = n / 16;
      f(lowest + node_block.index(i - 1, j - 1, k - 1), shape[n], gradient[n]);
    }
  }

 private:
  /// Of the lowest node of a particle's cell.
  static int lowest_of_cell(const Place& place, int lane) {
    const auto [i, j, k] = lattice_points.node(place.node[lane]);
    return node_block.index(i, j, k);
  }
  /// On the nodes i + 4 j + 16 k around the particle's cell.
  static void shape_and_gradient(const Place& place, int lane, const Vec3<double>& inverse_cell,
                                 double (&shape)[64], Vec3<double> (&gradient)[64]);
};
static_assert(ShapePolicy<Ddmp>);

}  // namespace mpm::core
