// Nodes of one brick: summing the contributions of all bricks that share them, and the equation of motion on
// them with its boundary conditions (thesis 2-26, 2-33, 2-41).
//
// Every brick works on its own copy of shared nodes. The copies are summed in one order, that of the neighbours'
// coordinates, and updated by the same instructions, so they stay equal to the last bit on any rank.
#pragma once

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

/// Component range of a node record that is summed.
enum class Summed { all, momentum_and_mass, force };

/// sums = contributions of the brick and its 26 neighbours; sums: shape().nodes() x node_doubles.
void sum_contributions(const BrickGrid& grid, Slot slot, double* sums);

/// What acts on nodes beside the particles' stress.
struct NodeForces {
  Vec3<double> gravity{};         ///< acceleration
  double damping = 0;             ///< 1/time: force per mass and velocity, against the velocity
  /// USL: nodes lighter than this take only the share m / floor of their velocity increment into the strain rate.
  double strain_mass_floor = 0;
};

/// A brick's faces that lie on a constrained face of the grid, found once per pass.
class BoundaryFaces {
 public:
  BoundaryFaces(const GridGeometry& geometry, const NodeBlockShape& shape, BrickCoord brick);
  bool none() const { return count_ == 0; }
  /// f(axis, outward sign, boundary, record) for every node on every constrained face of this brick.
  template <class F>
  void for_each_node(double* nodes, F f) const;

 private:
  struct Face {
    int axis, layer, sign;
    Boundary boundary;
  };
  NodeBlockShape shape_;
  Face face_[6];
  int count_ = 0;
};

/// [p, m, f] -> [v^{k+1}, m, dv, share left out]: velocity at the end of the step and its increment.
void update_nodes(const NodeForces& forces, double dt, double mass_cutoff, const BoundaryFaces& faces, int nodes,
                  double* record);

/// [p, m, *] -> [p, m, v^k]: USF's velocity at the start of the step.
void velocities_from_momenta(double mass_cutoff, const BoundaryFaces& faces, int nodes, double* record);

/// MUSL: components 4..6 become the velocity of the re-mapped momenta `sums` (0..2), over the mass in 3.
void velocities_from_remapped(const double* sums, const BoundaryFaces& faces, int nodes, double* record);

template <class F>
void BoundaryFaces::for_each_node(double* nodes, F f) const {
  const int s = shape_.side();
  for (int i = 0; i < count_; ++i) {
    const Face& face = face_[i];
    const int strides[3] = {1, s, s * s};
    const int u = strides[(face.axis + 1) % 3], v = strides[(face.axis + 2) % 3];
    const int first = (face.layer + shape_.halo) * strides[face.axis];
    for (int a = 0; a < s; ++a) {
      for (int b = 0; b < s; ++b) {
        f(face.axis, face.sign, face.boundary, nodes + node_doubles * (first + a * u + b * v));
      }
    }
  }
}

}  // namespace mpm::core
