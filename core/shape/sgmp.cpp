// Sums between a brick's nodes and the centres of its cells, plane by plane along x.
#include "core/shape/sgmp.hpp"

#include <utility>

namespace mpm::core::sgmp {

namespace {

using Record = Lanes<8>;
using Half = Lanes<4>;

constexpr int centre_index(int i, int j, int k) { return i + centres * (j + centres * k); }
constexpr int node_index(int i, int j, int k) { return i + nodes * (j + nodes * k); }

inline Half lower_half(const Record& r) { return half_of(r, 0); }
inline Half upper_half(const Record& r) { return half_of(r, 1); }

template <Onto onto, class Part>
[[gnu::always_inline]] inline void put(double* at, const Part& sum) {
  store(at, onto == Onto::nothing ? sum : load<Part>(at) + sum);
}

}  // namespace

template <Onto onto>
void centres_to_nodes(const Vec3<double>& inverse_cell, const double* centre, double* node) {
  const Half mean(0.125), y(0.25 * inverse_cell.y), z(0.25 * inverse_cell.z);
  Half x(0.25 * inverse_cell.x);
  x.set(3, 0);  // where yy is
  const Record first_scale = join(mean, x), second_scale = join(y, z);
  const Record sum_and_difference = join(Half(1.0), Half(-1.0));
  Record below[nodes][nodes];  // what the previous plane of centres adds to this plane of nodes
  for (auto& row : below) {
    for (Record& r : row) r = Record(0.0);
  }
  for (int i = 0; i < centres; ++i) {
    Record first[centres][nodes], second[centres][nodes];  // sums along z: (p m | X), (Y | Z)
    for (int j = 0; j < centres; ++j) {
      Record first_below(0.0), second_below(0.0);
      for (int k = 0; k < centres; ++k) {
        const int c = centre_index(i, j, k);
        const Record all = load<Record>(centre + node_doubles * c);
        const Record rest = join(load<Half>(centre + rest_of_sums + 4 * c), Half(0.0));
        const Record yz = __builtin_shufflevector(all.v, rest.v, 5, 7, 8, 10, 6, 8, 9, 10);  // (Y | Z)
        const Record a = first_scale * all, b = second_scale * yz;
        first[j][k] = a + first_below;
        second[j][k] = b + sum_and_difference * second_below;
        first_below = a;
        second_below = b;
      }
      first[j][centres] = first_below;
      second[j][centres] = sum_and_difference * second_below;
    }
    for (int k = 0; k < nodes; ++k) {
      Record mean_below(0.0);
      Half force_below(0.0);
      for (int j = 0; j < nodes; ++j) {
        Record mean_here(0.0);
        Half force(0.0), next(0.0);
        if (j < centres) {
          mean_here = first[j][k];
          force = upper_half(second[j][k]) + lower_half(second[j][k]);
          next = upper_half(second[j][k]) - lower_half(second[j][k]);
        }
        const Record means = mean_here + mean_below;  // (p m | X) summed along y and z
        const Half yz = force + force_below;          // differences of Y along y and of Z along z
        mean_below = mean_here;
        force_below = next;
        const Half momentum = lower_half(means), xx = upper_half(means);
        put<onto>(node + node_doubles * node_index(i, j, k), join(momentum, yz + xx) + below[k][j]);
        below[k][j] = join(momentum, yz - xx);
      }
    }
  }
  for (int k = 0; k < nodes; ++k)
    for (int j = 0; j < nodes; ++j) put<onto>(node + node_doubles * node_index(centres, j, k), below[k][j]);
}

template <Onto onto>
void centres_to_nodes(const double* centre, double* node) {
  Half below[nodes][nodes];
  for (auto& row : below) {
    for (Half& r : row) r = Half(0.0);
  }
  for (int i = 0; i < centres; ++i) {
    Half along_z[centres][nodes];
    for (int j = 0; j < centres; ++j) {
      Half last(0.0);
      for (int k = 0; k < centres; ++k) {
        const Half a = Half(0.125) * load<Half>(centre + 4 * centre_index(i, j, k));
        along_z[j][k] = a + last;
        last = a;
      }
      along_z[j][centres] = last;
    }
    for (int k = 0; k < nodes; ++k) {
      Half last(0.0);
      for (int j = 0; j < nodes; ++j) {
        const Half here = j < centres ? along_z[j][k] : Half(0.0);
        const Half sum = here + last;
        last = here;
        put<onto>(node + 4 * node_index(i, j, k), sum + below[k][j]);
        below[k][j] = sum;
      }
    }
  }
  for (int k = 0; k < nodes; ++k)
    for (int j = 0; j < nodes; ++j) put<onto>(node + 4 * node_index(centres, j, k), below[k][j]);
}

template void centres_to_nodes<Onto::nothing>(const Vec3<double>&, const double*, double*);
template void centres_to_nodes<Onto::contributions>(const Vec3<double>&, const double*, double*);
template void centres_to_nodes<Onto::nothing>(const double*, double*);
template void centres_to_nodes<Onto::contributions>(const double*, double*);

namespace {

/// Of the eight cells around a node those of a brick: f(0 or 1 along each axis, centre), the upper ones last.
template <class F>
void for_each_centre(int node, F f) {
  const int at[3] = {node % nodes, node / nodes % nodes, node / (nodes * nodes)};
  const auto has = [&](int a, int upper) { return 0 <= at[a] - 1 + upper && at[a] - 1 + upper < centres; };
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 2; ++k)
        if (has(0, i) && has(1, j) && has(2, k))
          f(i, j, k, centre_index(at[0] - 1 + i, at[1] - 1 + j, at[2] - 1 + k));
}

/// f(node) for nodes of a mask.
template <class F>
void for_each_node(const NodeMask& some, F f) {
  some.for_each(Sgmp::node_block, [&](int first, int count) {
    for (int n = first; n < first + count; ++n) f(n);
  });
}

/// f(lowest node, centre) for cells of which a mask has all nodes.
template <class F>
void for_each_centre(const NodeMask& some, F f) {
  some.for_each_cell(Sgmp::node_block, [&](int i, int j, int k) {
    f(Sgmp::node_block.index(i, j, k), centre_index(i + 1, j + 1, k + 1));
  });
}

}  // namespace

// The sums are those above, in their order.
void centres_to_nodes(const NodeMask& some, const Vec3<double>& inverse_cell, const double* centre,
                      double* node) {
  const Half mean(0.125), y(0.25 * inverse_cell.y), z(0.25 * inverse_cell.z);
  Half x(0.25 * inverse_cell.x);
  x.set(3, 0);  // where yy is
  const Record first_scale = join(mean, x), second_scale = join(y, z);
  for_each_node(some, [&](int n) {
    Record first[2][2][2] = {}, second[2][2][2] = {};  // (p m | X), (Y | Z)
    for_each_centre(n, [&](int i, int j, int k, int c) {
      const Record all = load<Record>(centre + node_doubles * c);
      const Record rest = join(load<Half>(centre + rest_of_sums + 4 * c), Half(0.0));
      const Record yz = __builtin_shufflevector(all.v, rest.v, 5, 7, 8, 10, 6, 8, 9, 10);
      first[i][j][k] = first_scale * all;
      second[i][j][k] = second_scale * yz;
    });
    Record plane[2];
    for (int i = 0; i < 2; ++i) {
      Record means(0.0);
      Half force(0.0);
      for (int j = 0; j < 2; ++j) {
        means += first[i][j][1] + first[i][j][0];
        const Half y_sum = lower_half(second[i][j][1]) + lower_half(second[i][j][0]);
        const Half z_difference = upper_half(second[i][j][1]) - upper_half(second[i][j][0]);
        force += j == 1 ? z_difference + y_sum : z_difference - y_sum;
      }
      const Half xx = upper_half(means);
      plane[i] = join(lower_half(means), i == 1 ? force + xx : force - xx);
    }
    store(node + node_doubles * n, plane[1] + plane[0]);
  });
}

void centres_to_nodes(const NodeMask& some, const double* centre, double* node) {
  for_each_node(some, [&](int n) {
    Half at[2][2][2] = {};
    for_each_centre(
        n, [&](int i, int j, int k, int c) { at[i][j][k] = Half(0.125) * load<Half>(centre + 4 * c); });
    Half plane[2];
    for (int i = 0; i < 2; ++i) plane[i] = (at[i][1][1] + at[i][1][0]) + (at[i][0][1] + at[i][0][0]);
    store(node + 4 * n, plane[1] + plane[0]);
  });
}

void nodes_to_centres(const NodeMask* some, const double* node, double* centre) {
  if (some != nullptr) {
    return for_each_centre(*some, [&](int lowest, int c) {
      Record plane[2];
      for (int i = 0; i < 2; ++i) {
        const auto sum = [&](int j) {
          const double* at = node + node_doubles * (lowest + node_index(i, j, 0));
          return load<Record>(at) + load<Record>(at + node_doubles * node_index(0, 0, 1));
        };
        plane[i] = sum(0) + sum(1);
      }
      store(centre + node_doubles * c, Record(0.125) * (plane[0] + plane[1]));
    });
  }
  Record planes[2][centres][centres];  // of sums along z and y: of this plane of nodes and the last one
  for (int i = 0; i < nodes; ++i) {
    Record(&here)[centres][centres] = planes[i % 2];
    const Record(&last)[centres][centres] = planes[1 - i % 2];
    Record row[centres] = {};
    for (int j = 0; j < nodes; ++j) {
      Record below = load<Record>(node + node_doubles * node_index(i, j, 0));
      for (int k = 0; k < centres; ++k) {
        const Record above = load<Record>(node + node_doubles * node_index(i, j, k + 1));
        const Record sum = below + above;
        below = above;
        if (j > 0) {
          here[j - 1][k] = row[k] + sum;
          if (i > 0)
            store(centre + node_doubles * centre_index(i - 1, j - 1, k),
                  Record(0.125) * (last[j - 1][k] + here[j - 1][k]));
        }
        row[k] = sum;
      }
    }
  }
}

void copy_velocities(const NodeMask* some, const double* from, int from_doubles, double* to, int to_doubles) {
  const auto copy = [&](int c) { store(to + to_doubles * c, load<Half>(from + from_doubles * c)); };
  if (some != nullptr) return for_each_centre(*some, [&](int, int c) { copy(c); });
  for (int c = 0; c < lattice_points.nodes(); ++c) copy(c);
}

void gradients_at_centres(const NodeMask* some, const Vec3<double>& inverse_cell, const double* node,
                          double* gradient) {
  struct Plane {
    Half x[centres][centres];  // sums along y and z: their difference along x is the derivative
    Half y[centres][centres];  // differences along y of sums along z
    Half z[centres][centres];  // sums along y of differences along z
  };
  const Half scale_x(0.25 * inverse_cell.x), scale_y(0.25 * inverse_cell.y), scale_z(0.25 * inverse_cell.z);
  if (some != nullptr) {
    return for_each_centre(*some, [&](int lowest, int c) {
      Half x[2], y[2], z[2];
      for (int i = 0; i < 2; ++i) {
        Half sum[2], difference[2];
        for (int j = 0; j < 2; ++j) {
          const double* at =
              node + node_doubles * (lowest + node_index(i, j, 0)) + Motion::strain_velocity_at;
          const Half below = load<Half>(at), above = load<Half>(at + node_doubles * node_index(0, 0, 1));
          sum[j] = below + above;
          difference[j] = above - below;
        }
        x[i] = sum[0] + sum[1];
        y[i] = sum[1] - sum[0];
        z[i] = difference[0] + difference[1];
      }
      double* at = gradient + gradient_doubles * c;
      store(at, scale_x * (x[1] - x[0]));
      store(at + 4, scale_y * (y[1] + y[0]));
      store(at + 8, scale_z * (z[1] + z[0]));
    });
  }
  Plane planes[2];
  const auto velocity = [&](int i, int j, int k) {
    return load<Half>(node + node_doubles * node_index(i, j, k) + Motion::strain_velocity_at);
  };
  for (int i = 0; i < nodes; ++i) {
    Plane& here = planes[i % 2];
    const Plane& last = planes[1 - i % 2];
    Half sums[centres] = {}, differences[centres] = {};  // of the last row
    for (int j = 0; j < nodes; ++j) {
      Half below = velocity(i, j, 0);
      for (int k = 0; k < centres; ++k) {
        const Half above = velocity(i, j, k + 1);
        const Half sum = below + above, difference = above - below;
        below = above;
        if (j > 0) {
          const Half x = sums[k] + sum, y = sum - sums[k], z = differences[k] + difference;
          here.x[j - 1][k] = x;
          here.y[j - 1][k] = y;
          here.z[j - 1][k] = z;
          if (i > 0) {
            double* at = gradient + gradient_doubles * centre_index(i - 1, j - 1, k);
            store(at, scale_x * (x - last.x[j - 1][k]));
            store(at + 4, scale_y * (y + last.y[j - 1][k]));
            store(at + 8, scale_z * (z + last.z[j - 1][k]));
          }
        }
        sums[k] = sum;
        differences[k] = difference;
      }
    }
  }
}

}  // namespace mpm::core::sgmp
