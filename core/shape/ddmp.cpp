// Averages over the cells of a brick, a row of nodes or cells in the lanes. Over a cell of edges h,
//   int S_j dS_i/dx dV / (V/8) = sign_i/(9 h) (2 or 1 along y) (2 or 1 along z),   2 where i and j agree;
// where all cells are in use, the sums over the eight cells become products over the axes of (1, 4, 1)/6 and
// (-1, 0, 1)/(2 h).
#include "core/shape/ddmp.hpp"

#include <limits>

namespace mpm::core {

namespace ddmp {

namespace {

constexpr int side = node_block.side();  // rows of nodes along an axis; the lattice's are 1 .. side - 2
constexpr int cells = side - 1;          // rows of cells: cell c between the nodes c and c + 1
static_assert(cells == CellsAround::side);
constexpr int points = lattice_points.side();

/// What the next lane holds, or the previous one.
inline Row next(Row a) { return __builtin_shufflevector(a.v, a.v, 1, 2, 3, 4, 5, 6, 7, 7); }
inline Row previous(Row a) {
  const Row::vector zero{};
  return __builtin_shufflevector(a.v, zero, 8, 0, 1, 2, 3, 4, 5, 6);
}

/// To the lattice's points of a row, which come in the order of their numbers: what is stored beyond the row
/// is overwritten by the next one.
inline void store_points(double* at, Row a) { store(at, next(a)); }

/// Rows of zeros and ones by the bits of a row of cells.
struct BitRows {
  alignas(64) double row[1 << cells][row_doubles];
};
constexpr BitRows bit_rows = [] {
  BitRows r{};
  for (int bits = 0; bits < 1 << cells; ++bits) {
    for (int i = 0; i < cells; ++i) r.row[bits][i] = bits >> i & 1;
  }
  return r;
}();

/// Weights of the cells, and the reciprocals of their sums around the points.
struct CellWeights {
  Row cell[cells * cells];  ///< row j + 6 k
  Row share[points * points];

  explicit CellWeights(const CellsAround& around) {
    Row both[cells * cells];
    for (int k = 0; k < cells; ++k) {
      for (int j = 0; j < cells; ++j) {
        const int n = j + cells * k;
        cell[n] =
            load<Row>(around.weights == nullptr ? bit_rows.row[around.row(j - 1, k - 1)]
                                                : around.weights->row[CellsAround::index(j - 1, k - 1)]);
        both[n] = cell[n] + previous(cell[n]);
      }
    }
    for (int k = 0; k < points; ++k) {
      for (int j = 0; j < points; ++j) {
        const Row* at = both + j + cells * k;
        share[j + points * k] =
            Row(1.0) / max(at[0] + at[1] + at[cells] + at[cells + 1],
                           Row(std::numeric_limits<double>::min()));  // unread where there are none
      }
    }
  }
};

/// f(cell row, the other row of nodes beside it) for the rows of cells beside row `r` of nodes.
template <class F>
[[gnu::always_inline]] inline void beside(int r, F f) {
  if (r > 0) f(r - 1, r - 1);
  if (r < cells) f(r, r + 1);
}

/// put(j, k, sum) for the rows first .. last along y and z: over the four cells beside row (j, k), weighted,
/// the sum of (2 or 1 along y) (2 or 1 along z) a, a given on the cells' edges along x. In the cells' lanes.
template <class F>
[[gnu::always_inline]] inline void across(const Row* a, const CellWeights& weights, int first, int last,
                                          F put) {
  for (int k = first; k <= last; ++k) {
    Row along_z[2][side];  // for the cells below and above
    beside(k, [&](int cell_k, int other_k) {
      for (int j = 0; j < side; ++j)
        along_z[cell_k == k][j] = Row(2.0) * a[j + side * k] + a[j + side * other_k];
    });
#pragma GCC unroll 7
    for (int j = first; j <= last; ++j) {
      Row sum(0.0);
      beside(k, [&](int cell_k, int) {
        const Row* m = along_z[cell_k == k];
        beside(j, [&](int cell_j, int other_j) {
          sum += weights.cell[cell_j + cells * cell_k] * (Row(2.0) * m[j] + m[other_j]);
        });
      });
      put(j, k, sum);
    }
  }
}

/// A plane of cells between two rows' planes of nodes, `a` on its edges across the plane, by the row r of the
/// edge: weighted sum over the cells beside row `r` of (2 or 1 along x) (2 or 1 along the rows) a, in the
/// nodes' lanes. `cell`: number of the plane's first row of cells, `stride` to the next.
[[gnu::always_inline]] inline Row along(const Row* a, const CellWeights& weights, int r, int cell,
                                        int stride) {
  Row lower(0.0), upper(0.0);  // of the cells' lower and upper nodes, in the cells' lanes
  beside(r, [&](int cell_r, int other) {
    const Row weight = weights.cell[cell + stride * cell_r];
    const Row m = Row(2.0) * a[r] + a[other], n = ddmp::next(m);
    lower += weight * (Row(2.0) * m + n);
    upper += weight * (Row(2.0) * n + m);
  });
  return lower + previous(upper);
}

/// v: rows of a component; d: of its derivatives along the axes at the lattice's points.
void derivatives(const CellWeights& weights, const Vec3<double>& inverse_cell, const double* velocity,
                 double* const (&d)[3]) {
  Row v[side * side], edges[side * side];
  for (int n = 0; n < side * side; ++n) {
    v[n] = load<Row>(velocity + row_doubles * n);
    edges[n] = ddmp::next(v[n]) - v[n];
  }
  const auto put = [&](int axis, int j, int k, Row sum) {
    const int n = j - 1 + points * (k - 1);
    store_points(d[axis] + points * n, Row(inverse_cell[axis] * (1.0 / 9)) * (weights.share[n] * sum));
  };
  across(edges, weights, 1, points, [&](int j, int k, Row sum) { put(0, j, k, sum + previous(sum)); });
  // Along y and z: planes of cells across the axis, and what their edges give the nodes on both sides.
  for (int axis = 1; axis < 3; ++axis) {
    const int stride = axis == 1 ? 1 : side, row_stride = axis == 1 ? side : 1;
    const int cell_stride = axis == 1 ? 1 : cells, cell_row_stride = axis == 1 ? cells : 1;
    Row sums[cells][side];
    for (int plane = 0; plane < cells; ++plane) {
      Row difference[side];
      for (int r = 0; r < side; ++r) {
        const Row* at = v + stride * plane + row_stride * r;
        difference[r] = at[stride] - at[0];
      }
#pragma GCC unroll 5
      for (int r = 1; r <= points; ++r)
        sums[plane][r] = along(difference, weights, r, cell_stride * plane, cell_row_stride);
    }
    for (int k = 1; k <= points; ++k) {
      for (int j = 1; j <= points; ++j) {
        const int plane = axis == 1 ? j : k, r = axis == 1 ? k : j;
        put(axis, j, k, sums[plane - 1][r] + sums[plane][r]);
      }
    }
  }
}

/// The same where all cells are in use.
void derivatives(const Vec3<double>& inverse_cell, const double* velocity, double* const (&d)[3]) {
  Row slope[side * side], mean[side * side];
  for (int n = 0; n < side * side; ++n) {
    const Row v = load<Row>(velocity + row_doubles * n), up = ddmp::next(v), down = previous(v);
    slope[n] = up - down;
    mean[n] = Row(4.0) * v + (up + down);
  }
  const Row scale[3] = {Row(inverse_cell.x / 72), Row(inverse_cell.y / 72), Row(inverse_cell.z / 72)};
  for (int k = 1; k <= points; ++k) {
    Row x[side], y[side], z[side];  // means along z of the slopes, means and slopes along z of the means
    for (int j = 0; j < side; ++j) {
      const int n = j + side * k;
      x[j] = Row(4.0) * slope[n] + (slope[n + side] + slope[n - side]);
      y[j] = Row(4.0) * mean[n] + (mean[n + side] + mean[n - side]);
      z[j] = mean[n + side] - mean[n - side];
    }
    for (int j = 1; j <= points; ++j) {
      const int at = points * (j - 1 + points * (k - 1));
      store_points(d[0] + at, scale[0] * (Row(4.0) * x[j] + (x[j + 1] + x[j - 1])));
      store_points(d[1] + at, scale[1] * (y[j + 1] - y[j - 1]));
      store_points(d[2] + at, scale[2] * (Row(4.0) * z[j] + (z[j + 1] + z[j - 1])));
    }
  }
}

/// The adjoint: forces of a component from t[axis], rows of a column of T_j at all nodes, zero but at the
/// lattice's points.
void forces(const CellWeights& weights, const Vec3<double>& inverse_cell, const Row* const (&t)[3],
            Row* force) {
  const Row scale[3] = {Row(inverse_cell.x / 9), Row(inverse_cell.y / 9), Row(inverse_cell.z / 9)};
  Row edges[side * side];
  for (int n = 0; n < side * side; ++n) edges[n] = t[0][n] + ddmp::next(t[0][n]);
  across(edges, weights, 0, side - 1,
         [&](int j, int k, Row sum) { force[j + side * k] = scale[0] * (sum - previous(sum)); });
  for (int axis = 1; axis < 3; ++axis) {
    const int stride = axis == 1 ? 1 : side, row_stride = axis == 1 ? side : 1;
    const int cell_stride = axis == 1 ? 1 : cells, cell_row_stride = axis == 1 ? cells : 1;
    for (int plane = 0; plane < cells; ++plane) {
      Row both[side];
      for (int r = 0; r < side; ++r) {
        const Row* at = t[axis] + stride * plane + row_stride * r;
        both[r] = at[0] + at[stride];
      }
#pragma GCC unroll 7
      for (int r = 0; r < side; ++r) {
        const Row sum = scale[axis] * along(both, weights, r, cell_stride * plane, cell_row_stride);
        Row* at = force + stride * plane + row_stride * r;
        at[0] += sum;
        at[stride] -= sum;
      }
    }
  }
}

/// The same where all cells are in use.
void forces(const Vec3<double>& inverse_cell, const Row* const (&t)[3], Row* force) {
  const Row scale[3] = {Row(inverse_cell.x / 72), Row(inverse_cell.y / 72), Row(inverse_cell.z / 72)};
  // Rows -1 .. side around each row, as far as they are not zero.
  constexpr int beyond[4] = {0, 1, side, side + 1};
  Row sums[side][side + 2], slopes[side][side + 2], x[side + 2], y[side + 2], z[side + 2];
  for (const int r : beyond) {
    x[r] = y[r] = z[r] = Row(0.0);
    for (int j = 0; j < side; ++j) sums[j][r] = slopes[j][r] = Row(0.0);
  }
  for (int k = 1; k <= points; ++k) {
    for (int j = 1; j <= points; ++j) {
      const int n = j + side * k;
      x[j + 1] = scale[0] * (ddmp::next(t[0][n]) - previous(t[0][n]));
      y[j + 1] = scale[1] * (Row(4.0) * t[1][n] + (ddmp::next(t[1][n]) + previous(t[1][n])));
      z[j + 1] = scale[2] * (Row(4.0) * t[2][n] + (ddmp::next(t[2][n]) + previous(t[2][n])));
    }
    for (int j = 0; j < side; ++j) {
      sums[j][k + 1] = Row(4.0) * x[j + 1] + (x[j + 2] + x[j]) + (y[j + 2] - y[j]);
      slopes[j][k + 1] = Row(4.0) * z[j + 1] + (z[j + 2] + z[j]);
    }
  }
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j)
      force[j + side * k] =
          Row(4.0) * sums[j][k + 1] + (sums[j][k + 2] + sums[j][k]) + (slopes[j][k + 2] - slopes[j][k]);
  }
}

/// f(number of the node, of the point) for the nodes that are points of the lattice.
template <class F>
inline void for_each_point(F f) {
  for (int k = 0; k < points; ++k) {
    for (int j = 0; j < points; ++j) {
      for (int i = 0; i < points; ++i) f(node_block.index(i, j, k), lattice_points.index(i, j, k));
    }
  }
}

}  // namespace

namespace {

/// f(row of nodes, number of its first point) for all rows; that number is negative where no point of the
/// lattice is in the row, whose point i is else node i + 1.
template <class F>
[[gnu::always_inline]] inline void for_each_row(F f) {
  for (int k = 0; k < side; ++k) {
    for (int j = 0; j < side; ++j) {
      const bool on_lattice = k > 0 && k <= points && j > 0 && j <= points;
      f(j + side * k, on_lattice ? points * (j - 1 + points * (k - 1)) : -1);
    }
  }
}

template <Onto onto, class Part>
[[gnu::always_inline]] inline void put(double* at, const Part& sum) {
  store(at, onto == Onto::nothing ? sum : load<Part>(at) + sum);
}

}  // namespace

template <Onto onto>
void sums_to_nodes(const BrickFrame& frame, const double* sums, double* nodes) {
  using Half = Lanes<4>;
  constexpr int components = 6;
  static_assert(points + 1 < row_doubles);
  // T_j by components, rows of nodes; zero beyond the lattice.
  Row t[components][side * side];
  for (int n = 0; n < side * side; ++n) {
    const int j = n % side, k = n / side;
    if (j > 0 && j <= points && k > 0 && k <= points) continue;
    for (Row(&component)[side * side] : t) component[n] = Row(0.0);
  }
  for (int k = 0; k < points; ++k) {
    for (int j = 0; j < points; ++j) {
      Row r[row_doubles] = {};
      for (int i = 0; i < points; ++i)
        r[i + 1] = load<Row>(sums + sum_doubles * lattice_points.index(i, j, k) + node_doubles);
      transpose(r);
      for (int c = 0; c < components; ++c) t[c][j + 1 + side * (k + 1)] = r[c];
    }
  }
  Row force[3][side * side];
  const Row* const column[3][3] = {{t[0], t[3], t[5]}, {t[3], t[1], t[4]}, {t[5], t[4], t[2]}};
  if (frame.cells->full()) {
    for (int a = 0; a < 3; ++a) forces(frame.inverse_cell, column[a], force[a]);
  } else {
    const CellWeights weights(*frame.cells);
    for (int c = 0; c < components; ++c) {
      for (int k = 0; k < points; ++k) {
        for (int j = 0; j < points; ++j) t[c][j + 1 + side * (k + 1)] *= weights.share[j + points * k];
      }
    }
    for (int a = 0; a < 3; ++a) forces(weights, frame.inverse_cell, column[a], force[a]);
  }
  for_each_row([&](int row, int point) {
    Row r[4] = {force[0][row], force[1][row], force[2][row], Row(0.0)};
    transpose_half(r);
    double* at = nodes + node_doubles * side * row;
#pragma GCC unroll 8
    for (int i = 0; i < side; ++i) {
      Row sum = join(Half(0.0), half_of(r[i / 2], i % 2));
      if (point >= 0 && i > 0 && i <= points) sum += load<Row>(sums + sum_doubles * (point + i - 1));
      put<onto>(at + node_doubles * i, sum);
    }
  });
}

template void sums_to_nodes<Onto::nothing>(const BrickFrame&, const double*, double*);
template void sums_to_nodes<Onto::contributions>(const BrickFrame&, const double*, double*);

void nodes_to_lattice(const double* nodes, double* lattice) {
  using Record = Lanes<node_doubles>;
  for_each_point([&](int node, int point) {
    store(lattice + node_doubles * point, load<Record>(nodes + node_doubles * node));
  });
}

namespace {
/// f(row of nodes, four of their components from `first` on).
template <class F>
[[gnu::always_inline]] inline void for_each_row_of(const double* nodes, int first, F f) {
  using Half = Lanes<4>;
  for (int n = 0; n < side * side; ++n) {
    const auto at = [&](int i) {
      return i < side ? load<Half>(nodes + node_doubles * (side * n + i) + first) : Half(0.0);
    };
    Row r[4];
    for (int i = 0; i < 4; ++i) r[i] = join(at(i), at(i + 4));
    transpose_pairs(r);
    f(n, r);
  }
}

inline void store_rows(double* velocity, int n, const Row (&v)[4]) {
  for (int c = 0; c < 3; ++c) store(velocity + NodeRows::doubles * c + row_doubles * n, v[c]);
}
}  // namespace

void velocity_rows(const double* nodes, double* velocity) {
  for_each_row_of(nodes, Motion::strain_velocity_at,
                  [&](int n, const Row(&v)[4]) { store_rows(velocity, n, v); });
}

void velocity_rows(double cutoff, const double* momenta, double* velocity) {
  static_assert(Motion::mass_at == 3);
  const Row least(cutoff), none(0.0);
  for_each_row_of(momenta, 0, [&](int n, const Row(&p)[4]) {
    const auto has_mass = least < p[3];
    const Row inverse = Row(1.0) / max(p[3], least);
    Row v[4];
    for (int c = 0; c < 3; ++c) v[c] = select(has_mass, p[c] * inverse, none);
    store_rows(velocity, n, v);
  });
}

void edge_gradients(const Vec3<double>& inverse_cell, const double* velocity, double* gradient) {
  const Row scale[3] = {Row(inverse_cell.x), Row(inverse_cell.y), Row(inverse_cell.z)};
  for (int c = 0; c < 3; ++c) {
    for (int k = 0; k < points; ++k) {
      for (int j = 0; j < points; ++j) {
        const double* at = velocity + NodeRows::doubles * c + row_doubles * (j + 1 + side * (k + 1));
        double* to = gradient + 3 * gradient_doubles * c + lattice_points.index(0, j, k);
        const Row v = load<Row>(at);
        store_points(to, scale[0] * (ddmp::next(v) - v));
        store_points(to + gradient_doubles, scale[1] * (load<Row>(at + row_doubles) - v));
        store_points(to + 2 * gradient_doubles, scale[2] * (load<Row>(at + row_doubles * side) - v));
      }
    }
  }
}

void averaged_gradients(const BrickFrame& frame, const double* velocity, double* gradient) {
  const auto each = [&](auto derive) {
    for (int c = 0; c < 3; ++c) {
      double* const to = gradient + 3 * gradient_doubles * c;
      double* const d[3] = {to, to + gradient_doubles, to + 2 * gradient_doubles};
      derive(velocity + NodeRows::doubles * c, d);
    }
  };
  if (frame.cells->full()) {
    each([&](const double* v, double* const(&d)[3]) { derivatives(frame.inverse_cell, v, d); });
    return;
  }
  const CellWeights weights(*frame.cells);
  each([&](const double* v, double* const(&d)[3]) { derivatives(weights, frame.inverse_cell, v, d); });
}

}  // namespace ddmp

void Ddmp::shape_and_gradient(const Place& place, int lane, const Vec3<double>& inverse_cell,
                              double (&shape)[64], Vec3<double> (&gradient)[64]) {
  const auto number = [](int i, int j, int k) { return i + 1 + 4 * (j + 1 + 4 * (k + 1)); };
  std::fill_n(shape, 64, 0.0);
  std::fill_n(gradient, 64, Vec3<double>{});
  const std::array<int, 3> cell = lattice_points.node(place.node[lane]);
  double alpha = 64;
  for (const auto& fraction : place.f) alpha *= fraction[lane] * (1 - fraction[lane]);
  const auto of_corner = [&](int node, double s, const Vec3<double>& direct) {
    const std::array<int, 3> point = lattice_points.node(node);
    const int c[3] = {point[0] - cell[0], point[1] - cell[1], point[2] - cell[2]};
    const int at = number(c[0], c[1], c[2]);
    shape[at] = s;
    gradient[at] = gradient[at] + alpha * direct;
    // The node's share of the averaged gradients, from the cells around it.
    const double beside = place.cells->weight_beside(cell[0] + c[0], cell[1] + c[1], cell[2] + c[2]);
    const double share = beside > 0 ? (1 - alpha) * s / (9 * beside) : 0;
    for (int m = 0; m < 8; ++m) {  // the node is corner m of the cell m around it
      const int lowest[3] = {c[0] - (m & 1), c[1] - (m >> 1 & 1), c[2] - (m >> 2)};
      const double weight =
          place.cells->weight(cell[0] + lowest[0], cell[1] + lowest[1], cell[2] + lowest[2]);
      if (weight == 0) continue;
      for (int i = 0; i < 8; ++i) {
        const double agree[3] = {(i & 1) == (m & 1) ? 2.0 : 1.0, (i >> 1 & 1) == (m >> 1 & 1) ? 2.0 : 1.0,
                                 i >> 2 == m >> 2 ? 2.0 : 1.0};
        const double g[3] = {agree[1] * agree[2], agree[0] * agree[2], agree[0] * agree[1]};
        Vec3<double>& to =
            gradient[number(lowest[0] + (i & 1), lowest[1] + (i >> 1 & 1), lowest[2] + (i >> 2))];
        for (int a = 0; a < 3; ++a)
          to[a] += ((i >> a & 1) != 0 ? share : -share) * weight * inverse_cell[a] * g[a];
      }
    }
  };
  Linear::for_each_node(place, lane, inverse_cell, of_corner);
}

}  // namespace mpm::core
