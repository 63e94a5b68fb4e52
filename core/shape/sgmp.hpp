// Staggered grid (SGMP; Liang, Zhang and Liu, CMAME 352 (2019) 85): particles and nodes meet at the cells'
// centres. A centre has the mean of its cell's eight nodes and, as its gradient, the differences of the means
// over opposite faces; particles interpolate both linearly between the eight centres around them:
//   u(x) = sum_c N_c(x) sum_i u_i/8,   grad u(x) = sum_c N_c(x) sum_i G_ci u_i,   G_ci = +-1/(4 h) per axis.
// Particles to grid is the adjoint, for mass, momentum and force alike. A particle thus reaches 27 nodes with
// weights that are continuous, as is the gradient: no noise from crossing cells, at the price of eight-point
// kernels over the particles and two small sums per brick.
//
// Bricks take their particles by nearest node, so that the centres around a brick's sites are those of
// 5 x 5 x 5 cells, with 6 x 6 x 6 nodes. The sums along the axes are in the order z, y, x.
#pragma once

#include "core/shape/linear.hpp"

namespace mpm::core {

namespace sgmp {

inline constexpr int centres = lattice_points.side(), nodes = centres + 1;  ///< of a brick, along an axis
/// The centres' sums: (p m | V sigma_xx xy xz yy) of all of them, then (V sigma_yz zz 0 0).
inline constexpr int sum_doubles = 12;
inline constexpr int rest_of_sums = node_doubles * lattice_points.nodes();
/// A centre's velocity gradient: d v / dx_j in doubles 4 j .. 4 j + 2.
inline constexpr int gradient_doubles = 12;

template <NodeFields what>
struct CentreStore {
  static constexpr int width = maps_force(what) ? sum_doubles : 4;
  [[gnu::always_inline]] static void add(const CellSums<what>& s, const BrickFrame&, double* records,
                                         int centre) {
    using N = linear::Nodes;
    if constexpr (maps_force(what)) {
      N first[8] = {s.px, s.py, s.pz, s.m, s.xx, s.xy, s.xz, s.yy};
      add_to_corners<node_doubles>(first, records + node_doubles * centre);
      N rest[4] = {s.yz, s.zz, N(0.0), N(0.0)};
      add_half_to_corners(rest, records + rest_of_sums + 4 * centre);
    } else {
      N momentum[4] = {s.px, s.py, s.pz, s.m};
      add_half_to_corners(momentum, records + 4 * centre);
    }
  }
};

/// To the nodes m_i = sum_c m_c / 8, p_i = sum_c p_c / 8 and f_i = -sum_c G_ci (V sigma)_c. `centre`: sums;
/// `node`: contributions to the first array.
template <Onto onto>
void centres_to_nodes(const Vec3<double>& inverse_cell, const double* centre, double* node);
/// Momentum and mass only: records of four doubles.
template <Onto onto>
void centres_to_nodes(const double* centre, double* node);
/// The same for `some` nodes alone, which have no contributions yet.
void centres_to_nodes(const NodeMask& some, const Vec3<double>& inverse_cell, const double* centre,
                      double* node);
void centres_to_nodes(const NodeMask& some, const double* centre, double* node);
/// Means of the nodes' records; if not null, of cells with `some` nodes alone.
void nodes_to_centres(const NodeMask* some, const double* node, double* centre);
/// Velocities of centres between records of these numbers of doubles.
void copy_velocities(const NodeMask* some, const double* from, int from_doubles, double* to, int to_doubles);
/// Gradients of the nodes' strain velocities.
void gradients_at_centres(const NodeMask* some, const Vec3<double>& inverse_cell, const double* node,
                          double* gradient);

}  // namespace sgmp

struct Sgmp {
  static constexpr std::string_view name = "SGMP";
  static constexpr Site site = Site::node;
  static constexpr NodeBlockShape node_block{1, 0};
  static constexpr int nodes_per_axis = 3;
  static ColumnSet columns() { return {}; }
  using Place = LinearPlace;
  using Interpolation = LinearInterpolation;
  template <NodeFields what>
  using Scatter = CellScatter<CellSums<what>, sgmp::CentreStore<what>>;

  /// Sums at the centres.
  template <NodeFields what>
  class Sums {
   public:
    explicit Sums(double* contributions) : records(centre_), contributions_(contributions) {}
    void finish(const BrickFrame& frame, const NodeMask* some = nullptr) {
      if (some == nullptr) return to_nodes<Onto::contributions>(frame);
      if constexpr (maps_force(what))
        sgmp::centres_to_nodes(*some, frame.inverse_cell, centre_, contributions_);
      else
        sgmp::centres_to_nodes(*some, centre_, contributions_);
    }
    void replace(const BrickFrame& frame) { to_nodes<Onto::nothing>(frame); }
    double* records;

   private:
    template <Onto onto>
    void to_nodes(const BrickFrame& frame) {
      if constexpr (maps_force(what))
        sgmp::centres_to_nodes<onto>(frame.inverse_cell, centre_, contributions_);
      else
        sgmp::centres_to_nodes<onto>(centre_, contributions_);
    }

    alignas(64) double centre_[sgmp::CentreStore<what>::width * lattice_points.nodes()] = {};
    double* contributions_;
  };

  /// Motion and its gradient at the centres.
  class Field {
   public:
    void take_motion(const double* nodes, const NodeMask* some = nullptr) {
      sgmp::nodes_to_centres(some, nodes, motion_);
    }
    void take_strain(const BrickFrame& frame, const double* nodes, const NodeMask* some = nullptr) {
      sgmp::gradients_at_centres(some, frame.inverse_cell, nodes, gradient_);
    }
    /// The velocities alone, which MUSL keeps between its passes.
    static constexpr int kept_doubles = 4 * lattice_points.nodes();
    void keep_velocity(const NodeMask* some, double* kept) const {
      sgmp::copy_velocities(some, velocity(), node_doubles, kept, 4);
    }
    void recall_velocity(const NodeMask* some, const double* kept) {
      sgmp::copy_velocities(some, kept, 4, motion_ + Motion::velocity_at, node_doubles);
    }
    const double* velocity() const { return motion_ + Motion::velocity_at; }
    const double* increment() const { return motion_ + Motion::increment_at; }
    const double* gradient() const { return gradient_; }

   private:
    alignas(64) double motion_[node_doubles * lattice_points.nodes()];
    alignas(64) double gradient_[sgmp::gradient_doubles * lattice_points.nodes()];
  };

  template <class Rows>
  static void gradient(const BrickFrame&, const Place& place, const Field& field, Rows& rows, int at) {
    using R = Lanes<8>;
    R gradient[9] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    const LinearWeights weight(place);
    for_each_cell(place, [&](int centre, auto here) {
      const double* lowest = field.gradient() + sgmp::gradient_doubles * centre;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          R sum = weight[0] * R(lowest[4 * j + i]);
          for (int n = 1; n < 8; ++n)
            sum += weight[n] * R(lowest[sgmp::gradient_doubles * corner_node(n) + 4 * j + i]);
          gradient[3 * i + j] = select(here, sum, gradient[3 * i + j]);
        }
      }
    });
    for (int i = 0; i < 9; ++i) store(rows[i] + at, gradient[i]);
  }

  /// The gradient at the centre of the particle's cell is its mean over the cell.
  static void cell_divergence(const BrickFrame&, const Place& place, const Field& field, double factor,
                              double* row, int at) {
    for (int l = 0; l < block_lanes; ++l) {
      const int corner = (place.f[0][l] >= 0.5) + 2 * (place.f[1][l] >= 0.5) + 4 * (place.f[2][l] >= 0.5);
      const double* g = field.gradient() + sgmp::gradient_doubles * (place.node[l] + corner_node(corner));
      row[at + l] = factor * (g[0] + g[5] + g[10]);
    }
  }

  static int lowest_of(const Place& place, int lane) {
    const auto [i, j, k] = lattice_points.node(place.node[lane]);
    return node_block.index(i - 1, j - 1, k - 1);
  }
  template <class F>
  static void for_each_node(const Place& place, int lane, const Vec3<double>& inverse_cell, F f) {
    // Along an axis: half the weights of the two centres on their nodes, and their differences.
    double w[3][nodes_per_axis], slope[3][nodes_per_axis];
    for (int a = 0; a < 3; ++a) {
      const double upper = place.f[a][lane], lower = 1 - upper;
      const double weights[3] = {0.5 * lower, 0.5, 0.5 * upper};
      const double slopes[3] = {-lower, lower - upper, upper};
      for (int i = 0; i < nodes_per_axis; ++i) {
        w[a][i] = weights[i];
        slope[a][i] = slopes[i] * inverse_cell[a];
      }
    }
    const int lowest = lowest_of(place, lane), side_of_nodes = node_block.side();
    for (int k = 0; k < nodes_per_axis; ++k) {
      for (int j = 0; j < nodes_per_axis; ++j) {
        for (int i = 0; i < nodes_per_axis; ++i) {
          f(lowest + i + side_of_nodes * (j + side_of_nodes * k), w[0][i] * w[1][j] * w[2][k],
            Vec3<double>{slope[0][i] * w[1][j] * w[2][k], w[0][i] * slope[1][j] * w[2][k],
                         w[0][i] * w[1][j] * slope[2][k]});
        }
      }
    }
  }
};
static_assert(ShapePolicy<Sgmp>);

}  // namespace mpm::core
