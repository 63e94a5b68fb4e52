#include "core/step/node_update.hpp"

#include <algorithm>

namespace mpm::core {

namespace {

using Record = Lanes<8>;
using Half = Lanes<4>;

/// Nodes first .. last along one axis that the brick shares with its neighbour at `offset`.
struct Overlap {
  int first, last;
  Overlap(const NodeBlockShape& shape, int offset)
      : first(std::max(-shape.halo, brick_cells * offset - shape.halo)),
        last(std::min(brick_cells + shape.halo, brick_cells * (offset + 1) + shape.halo)) {}
};

}  // namespace

void sum_contributions(const BrickGrid& grid, Slot slot, double* sums) {
  const NodeBlockShape& shape = grid.shape();
  std::fill_n(sums, node_doubles * shape.nodes(), 0.0);
  const Brick& brick = grid.brick(slot);
  for (int n = 0; n < neighbourhood; ++n) {
    const Slot other = brick.neighbour[static_cast<std::size_t>(n)];
    if (other == no_slot) continue;
    const BrickCoord d = neighbour_offset(n);
    const Overlap x(shape, d.x), y(shape, d.y), z(shape, d.z);
    // The same node counts 4 d less from the neighbour's lowest node.
    const double* theirs = grid.contributions(other) - node_doubles * brick_cells * (d.x + shape.side() * (d.y + shape.side() * d.z));
    for (int k = z.first; k <= z.last; ++k) {
      for (int j = y.first; j <= y.last; ++j) {
        for (int i = x.first; i <= x.last; ++i) {
          const int at = node_doubles * shape.index(i, j, k);
          store(sums + at, load<Record>(sums + at) + load<Record>(theirs + at));
        }
      }
    }
  }
}

BoundaryFaces::BoundaryFaces(const GridGeometry& geometry, const NodeBlockShape& shape, BrickCoord brick)
    : shape_(shape) {
  const int first[3] = {brick_cells * brick.x, brick_cells * brick.y, brick_cells * brick.z};
  for (int axis = 0; axis < 3; ++axis) {
    const Boundary lower = geometry.boundary[static_cast<std::size_t>(2 * axis)];
    const Boundary upper = geometry.boundary[static_cast<std::size_t>(2 * axis + 1)];
    const std::int64_t last = geometry.cells[static_cast<std::size_t>(axis)] - first[axis];
    if (lower != Boundary::free && first[axis] <= shape.halo) face_[count_++] = {axis, -first[axis], -1, lower};
    if (upper != Boundary::free && last <= brick_cells + shape.halo) {
      face_[count_++] = {axis, static_cast<int>(last), 1, upper};
    }
  }
}

void update_nodes(const NodeForces& forces, double dt, double mass_cutoff, const BoundaryFaces& faces, int nodes,
                  double* record) {
  const Half gravity(Half::vector{forces.gravity.x, forces.gravity.y, forces.gravity.z, 0});
  const double floor = forces.strain_mass_floor;
  for (int n = 0; n < nodes; ++n) {
    double* at = record + node_doubles * n;
    const double m = at[3];
    if (!(m > mass_cutoff)) {
      store(at, Record(0.0));
      continue;
    }
    const double inverse = 1 / m;
    const Half v = load<Half>(at) * Half(inverse);
    const Half a = load<Half>(at + 4) * Half(inverse) + gravity - Half(forces.damping) * v;
    const Half dv = Half(dt) * a;
    store(at, v + dv);
    store(at + 4, dv);
    at[3] = m;
    at[7] = m < floor ? 1 - m / floor : 0;
  }
  // Constrained nodes keep neither momentum nor force (thesis, below 2-41), so particles feel them through the
  // stress alone. A rigid wall holds a node only while it would leave the grid.
  faces.for_each_node(record, [](int axis, int sign, Boundary boundary, double* at) {
    if (boundary == Boundary::fixed) {
      for (int a = 0; a < 3; ++a) at[a] = at[4 + a] = 0;
    } else if (boundary == Boundary::symmetry || (boundary == Boundary::rigid_wall && sign * at[axis] > 0)) {
      at[axis] = at[4 + axis] = 0;
    }
  });
}

namespace {
/// Components 4..6 obey the walls.
void constrain_second_velocity(const BoundaryFaces& faces, double* record) {
  faces.for_each_node(record, [](int axis, int sign, Boundary boundary, double* at) {
    if (boundary == Boundary::fixed) {
      for (int a = 0; a < 3; ++a) at[4 + a] = 0;
    } else if (boundary == Boundary::symmetry || (boundary == Boundary::rigid_wall && sign * at[4 + axis] > 0)) {
      at[4 + axis] = 0;
    }
  });
}
}  // namespace

void velocities_from_momenta(double mass_cutoff, const BoundaryFaces& faces, int nodes, double* record) {
  for (int n = 0; n < nodes; ++n) {
    double* at = record + node_doubles * n;
    const double m = at[3];
    const Half v = m > mass_cutoff ? load<Half>(at) * Half(1 / m) : Half(0.0);
    store(at + 4, v);
  }
  constrain_second_velocity(faces, record);
}

void velocities_from_remapped(const double* sums, const BoundaryFaces& faces, int nodes, double* record) {
  for (int n = 0; n < nodes; ++n) {
    double* at = record + node_doubles * n;
    const double m = at[3];  // zero where the node update left the node out
    const Half v = m > 0 ? load<Half>(sums + node_doubles * n) * Half(1 / m) : Half(0.0);
    store(at + 4, v);
  }
  constrain_second_velocity(faces, record);
}

}  // namespace mpm::core
