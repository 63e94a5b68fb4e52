// Where the corners of a block's particles are (corners.hpp), and S_i on the nodes around them.
//
// Domain supplies its columns, first_column and their number, and
//   sums, reduce(u, sum)  the sums over the corners of a quantity u on which S_i and grad S_i depend: S_i on
//                         the first `values` of them, grad S_i on those from first_slope on
//   share, share_flow     the converse: what each corner takes of the particles' quantities, shared out by
//                         S_i and by grad S_i
//   corner_value(c)       which of the weights S_i gives corner c
//   evaluate(frame, layout, block, middle, at, reach, weights)
//                         the corners of a block's particles about `middle`, all in cells; how far they reach
//                         from there along each axis; and the weights of the sums
// (cpdi.hpp). The corners are at most a cell from the particle along each axis, so a particle reaches the
// 4 x 4 x 4 nodes around its cell, but seldom more than 3 x 3 x 3 of them.
#pragma once

#include <type_traits>

#include "core/shape/hexahedron.hpp"
#include "core/shape/linear.hpp"

namespace mpm::core {

inline constexpr NodeBlockShape corner_nodes{1, 1};
inline constexpr int most_along = 4;  ///< nodes of a particle along an axis

/// Domains that fill the cells of a lattice have corners on its faces, but for round-off: one so close to a
/// face of its particle's cell, in cells, counts as inside, so that round-off does not lead to further cells.
inline constexpr double face_round_off = 1e-12, below_one = 1 - 0x1p-53;

/// Of the sums over the corners.
template <class T, class Domain>
struct SumWeights {
  T value[Domain::values];
  T slope[Domain::sums - Domain::first_slope][3];
};

/// The nodes on which a block's particles are evaluated.
struct CornerNodes {
  int along;                ///< their number along each axis, 3 or 4
  int lowest[block_lanes];  ///< the first of them
  bool shared;              ///< by all particles
  /// f(along) with a constant.
  template <class F>
  [[gnu::always_inline]] void with_along(F f) const {
    if (along == most_along - 1) [[likely]]
      f(std::integral_constant<int, most_along - 1>());
    else
      f(std::integral_constant<int, most_along>());
  }
};

template <class Domain>
struct CornerPlace {
  using R = Lanes<8>;
  typedef int Ints __attribute__((vector_size(block_lanes * sizeof(int))));
  static constexpr int side = corner_nodes.side();
  alignas(64) double corner[3][corners][block_lanes];  ///< in cells from the lower end of the particle's cell
  alignas(64) double value[Domain::values][block_lanes];
  alignas(64) double slope[Domain::sums - Domain::first_slope][3][block_lanes];
  alignas(64) double first[3][block_lanes];  ///< of three nodes that the corners reach, from there: -1 or 0
  unsigned far;                              ///< lanes in which they reach a fourth
  int lowest[block_lanes];                   ///< of the 4 x 4 x 4 nodes around the particle's cell
  int used;                                  ///< lanes; the others may hold anything

  CornerPlace() = default;
  CornerPlace(const BrickFrame& frame, const ColumnLayout& layout, const double* block, int used_lanes) {
    find(frame, layout, block, used_lanes);
  }
  void find(const BrickFrame& frame, const ColumnLayout& layout, const double* block, int used_lanes) {
    used = used_lanes;
    const unsigned counts = (1u << used) - 1;
    const double* x = block + layout.offset(Column::position_x);
    const auto p = locate_in_sites<R, side>(frame, x, x + block_lanes, x + 2 * block_lanes);
    const R within[3] = {p.fx, p.fy, p.fz};
    std::memcpy(lowest, p.node, sizeof lowest);
    R at[3][corners], reach[3];
    SumWeights<R, Domain> weights;
    Domain::evaluate(frame, layout, block, within, at, reach, weights);
    far = 0;
#pragma GCC unroll 3
    for (int a = 0; a < 3; ++a) {
      // Unused lanes may hold anything.
      const auto below = within[a] - reach[a] < R(-face_round_off),
                 beyond = R(1.0 + face_round_off) < within[a] + reach[a];
      const R from = select(below, R(-2.0), R(0.0)), to = select(beyond, R(3.0), R(below_one));
#pragma GCC unroll 8
      for (int c = 0; c < corners; ++c) store(corner[a][c], max(min(at[a][c], to), from));
      // As far as a particle has the choice, a block's have the same nodes. What unused lanes hold from
      // earlier steps must not choose: which nodes are shared decides how sums are rounded.
      const bool any_below = (bits(below) & counts) != 0;
      store(first[a], select(beyond, R(0.0), R(any_below ? -1.0 : 0.0)));
      far |= bits(below & beyond) & counts;
      for (int s = 0; s < Domain::sums - Domain::first_slope; ++s)
        store(slope[s][a], weights.slope[s][a] * R(frame.inverse_cell[a]));
    }
    for (int s = 0; s < Domain::values; ++s) store(value[s], weights.value[s]);
    values_known_ = false;
  }

  /// Of the particle's cell.
  int lowest_of_cell(int lane) const { return lowest[lane] + corner_nodes.index(0, 0, 0); }
  /// Node of each particle that is this far from its 4 x 4 x 4 nodes' lowest one.
  Ints nodes(R x, R y, R z) const {
    Ints number;
    std::memcpy(&number, lowest, sizeof number);
    return number + __builtin_convertvector((x + R(double(side)) * (y + R(double(side)) * z)).v, Ints);
  }

  struct Values : CornerNodes {
    alignas(64) double value[most_along * most_along * most_along][block_lanes];  ///< the first axis fastest
  };
  /// S_i, found when asked for: not all passes need them.
  const Values& values() const {
    if (!values_known_) find_values();
    return values_;
  }

 private:
  void find_values() const;
  mutable bool values_known_ = false;
  mutable Values values_;
};

/// The hat functions of the nodes at the corners, axis by axis; N_i at a corner is the product of three.
template <class Domain>
struct CornerHats : CornerNodes {
  using R = Lanes<8>;
  alignas(64) double hat[3][most_along][corners][block_lanes];

  explicit CornerHats(const CornerPlace<Domain>& place) {
    along = place.far != 0 ? most_along : most_along - 1;
    R first[3];
    for (int a = 0; a < 3; ++a) first[a] = along == most_along ? R(-1.0) : load<R>(place.first[a]);
    const auto nodes = place.nodes(first[0] + R(1.0), first[1] + R(1.0), first[2] + R(1.0));
    std::memcpy(lowest, &nodes, sizeof lowest);
    shared = std::equal(lowest + 1, lowest + place.used, lowest);
    with_along([&](auto n) {
      for (int a = 0; a < 3; ++a)
        for (int c = 0; c < corners; ++c) evaluate<n>(load<R>(place.corner[a][c]), first[a], c, hat[a]);
    });
  }

  /// f(number of the node, N_i at the corners times their `weight`).
  template <int n, class F>
  [[gnu::always_inline]] void for_each_node(const R (&weight)[corners], F f) const {
    for (int k = 0; k < n; ++k) {
      R plane[corners];
      for (int c = 0; c < corners; ++c) plane[c] = weight[c] * load<R>(hat[2][k][c]);
      for (int j = 0; j < n; ++j) {
        R row[corners];
        for (int c = 0; c < corners; ++c) row[c] = plane[c] * load<R>(hat[1][j][c]);
        for (int i = 0; i < n; ++i) {
          R at[corners];
          for (int c = 0; c < corners; ++c) at[c] = row[c] * load<R>(hat[0][i][c]);
          f(i + n * (j + n * k), at);
        }
      }
    }
  }

 private:
  /// On n nodes: each is the smaller of what rises from the node before and falls to the next. A particle's
  /// have the same bits, whether or not another one of the block asks for a fourth node.
  template <int n>
  static void evaluate(R x, R first, int c, double (&hats)[most_along][corners][block_lanes]) {
    R after[n];  // the nodes
    for (int i = 0; i < n; ++i) after[i] = x - (first + R(double(i)));
    store(hats[0][c], max(-after[1], R(0.0)));
    for (int i = 1; i < n - 1; ++i) store(hats[i][c], max(min(after[i - 1], -after[i + 1]), R(0.0)));
    store(hats[n - 1][c], max(after[n - 2], R(0.0)));
  }
};

template <class Domain>
[[gnu::noinline]] void CornerPlace<Domain>::find_values() const {
  const CornerHats<Domain> hats(*this);
  static_cast<CornerNodes&>(values_) = hats;
  R weight[corners];
  for (int c = 0; c < corners; ++c) weight[c] = load<R>(value[Domain::corner_value(c)]);
  hats.with_along([&](auto n) {
    hats.template for_each_node<n>(weight, [&](int node, const R(&at)[corners]) {
      R even = at[0], odd = at[1];
      for (int c = 2; c < corners; c += 2) even += at[c], odd += at[c + 1];
      store(values_.value[node], even + odd);
    });
  });
  values_known_ = true;
}

}  // namespace mpm::core
