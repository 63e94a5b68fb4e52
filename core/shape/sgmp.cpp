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

void nodes_to_centres(const double* node, double* centre) {
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

void gradients_at_centres(const Vec3<double>& inverse_cell, const double* node, double* gradient) {
  struct Plane {
    Half x[centres][centres];  // sums along y and z: their difference along x is the derivative
    Half y[centres][centres];  // differences along y of sums along z
    Half z[centres][centres];  // sums along y of differences along z
  };
  Plane planes[2];
  const Half scale_x(0.25 * inverse_cell.x), scale_y(0.25 * inverse_cell.y), scale_z(0.25 * inverse_cell.z);
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
