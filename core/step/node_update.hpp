// Nodal update of one brick: solves the equation of motion of its nodes with their boundary conditions
// (thesis 2-26, 2-33, 2-41), from the sums of all bricks that share a node (shared_nodes.hpp). All copies of
// a node are updated by the same instructions, so they agree bit for bit on any rank.
#pragma once

#include <functional>

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

/// Forces on nodes other than the particles' internal forces.
struct NodeForces {
  Vec3<double> gravity{};  ///< acceleration
  /// 1/time: force per mass and velocity, against the velocity. It scales the velocities at the start of the
  /// step, on the nodes as on the particles (PassesWith::update_velocities_apart), and is in no increment: so
  /// it also damps what the grid does not resolve of the particles' velocities, which nothing else does.
  double damping = 0;
  /// USL: for nodes lighter than this, only the share m / floor of the velocity increment enters the strain
  /// rate.
  double strain_mass_floor = 0;
};

/// Adds to the forces of records of the first array the masses in records of array `of` times `acceleration`.
void add_weights(const Vec3<double>& acceleration, int nodes, NodeArray of, const double* masses,
                 double* records);

/// A brick's faces that lie on a constrained face of the grid, found once per pass.
///
/// Shape functions wider than a cell also reach nodes outside the grid. At a wall these are no unknowns: each
/// follows from the node on the wall and its mirror image inside,
///   symmetry     u_out =  R u_mirror       R reverses the component normal to the wall
///   fixed        u_out = -u_mirror
///   rigid_wall   u_out = 2 u_wall - u_mirror    (the material may leave the wall)
///   temperature  T_out = T_mirror               (walls are adiabatic)
/// so a linear field stays linear up to the wall. What particles map to outer nodes is added to those two by
/// the adjoint of the same rule, so that no energy is lost in between; mass is mirrored (symmetry, fixed) or
/// extrapolated as momentum is (rigid_wall), where the inner node keeps more than the outer one takes.
class BoundaryFaces {
 public:
  BoundaryFaces(const GridGeometry& geometry, const NodeBlockShape& shape, BrickCoord brick);
  BoundaryFaces(const BrickGrid& grid, Slot slot)
      : BoundaryFaces(grid.geometry(), grid.shape(), grid.brick(slot).coord) {}
  bool none() const { return count_ == 0; }
  /// f(axis, outward sign, boundary, record) for every node on every constrained face of this brick.
  template <class F>
  void for_each_node(double* nodes, F f) const;

  /// Adds the contributions to outer nodes, in the records of what.array, to the inner ones and clears them;
  /// mirrored masses stay in the outer nodes as well, for reverse_weights().
  void fold(NodeFields what, double* contributions) const;
  /// The weight of a mirrored mass is reversed as its momentum is. Subtracts from `forces`, folded
  /// contributions to the first array, what the products of nodal masses and gravity have in excess;
  /// `masses`: folded contributions to array `of` with the masses of the same particles.
  void reverse_weights(const Vec3<double>& gravity, NodeArray of, const double* masses, double* forces) const;
  /// Sets the outer nodes' MotionRecords.
  void fill(double* record) const;
  /// Sets component `i` of the outer nodes' records to that of their mirror image.
  void mirror(int i, double* record) const;
  /// f(outer node, mirror image, whether each component is reversed), in the order of fill(): the mirror
  /// image may be an outer node of another face, passed before. Of fixed and symmetry faces.
  void for_each_tie(const std::function<void(int, int, const bool (&)[3])>& f) const;

 private:
  struct Face {
    int axis, layer, sign;
    Boundary boundary;
  };
  bool has_outer_nodes(const Face& face) const {
    return face.sign < 0 ? face.layer > shape_.lowest() : face.layer < shape_.highest();
  }
  /// f(face, outer, wall, mirror) with the numbers of corresponding nodes.
  template <class F>
  void for_each_outer_node(F f) const {
    for (int i = 0; i < count_; ++i) for_each_outer_node(face_[i], f);
  }
  template <class F>
  void for_each_outer_node(const Face& face, F f) const;
  template <class Part>
  void fold(const Face& face, NodeFields what, double* contributions) const;

  NodeBlockShape shape_;
  Face face_[6];
  int count_ = 0;
};

/// Takes the momentum of the nodes that a rigid wall would hold in a step with these forces: they strain
/// nothing.
void hold_at_rigid_walls(const NodeForces& forces, double dt, double mass_cutoff, const BoundaryFaces& faces,
                         double* record);

/// MappedRecord -> MotionRecord: velocity at the end of the step and its increment. Outer nodes follow those
/// that are updated.
void update_nodes(const NodeForces& forces, double dt, double mass_cutoff, const BoundaryFaces& faces,
                  const NodeSelection& nodes, double* record);

/// A node's motion as stored between MUSL's passes: velocity and mass of its MotionRecord.
inline constexpr int motion_width = 4;
void keep_motion(const NodeSelection& nodes, const double* record, double* motion);
void recall_motion(const NodeSelection& nodes, const double* motion, double* record);

/// One of a Motion's vectors, as Motion::velocity_at.
using MotionVector = int;
/// Copies the vector `from` of Motions to the vector `to` of others, or of the same ones.
void copy_vector(int nodes, const double* source, MotionVector from, MotionVector to, double* motion);
/// Adds a multiple of it.
void add_vector(int nodes, const double* source, MotionVector from, double multiple, MotionVector to,
                double* motion);

/// Sets the strain velocity to `momenta` (0..2 of each record) over `masses` (3 of each record): USF's
/// velocity at the start of the step (both in `record`), or MUSL's re-mapped one (the masses in either).
void second_velocities(double mass_cutoff, const double* momenta, const double* masses,
                       const BoundaryFaces& faces, const NodeSelection& nodes, double* record);

/// A node's sum of velocities in a correction (core/transfer/corrected.hpp), in a Motion: velocity v(l),
/// increment dv(l), and its mass.
///
/// Order 1, from its updated Motion: v(1) = v + dt a; dv(1) is that velocity too or, with `of_start`, the one
/// at the start of the step. What a wall holds is zero in every order.
void begin_correction(bool of_start, const BoundaryFaces& faces, int nodes, const double* motion,
                      double* sum);
/// The next order, from `momenta`, the sums of m S dv(l - 1) over the particles: dv(l) = dv(l - 1) -
/// momenta/m. A rigid wall admits no sum that leads through it: there dv(l) brings the node to rest, and it
/// stays at rest in the orders that follow. Changes `momenta`.
void continue_correction(const BoundaryFaces& faces, double* momenta, int nodes, double* sum);

/// Sets USL's strain velocity: the velocity at the end of the step less the omitted share of the increment,
/// excluding gravity's part `fall`. Called after the particles have taken their increment.
void regularised_velocities(const Vec3<double>& fall, const BoundaryFaces& faces, int nodes, double* record);

template <class F>
void BoundaryFaces::for_each_node(double* nodes, F f) const {
  const int s = shape_.side();
  for (int i = 0; i < count_; ++i) {
    const Face& face = face_[i];
    const int strides[3] = {1, s, s * s};
    const int u = strides[(face.axis + 1) % 3], v = strides[(face.axis + 2) % 3];
    const int first = (face.layer + shape_.below) * strides[face.axis];
    for (int a = 0; a < s; ++a) {
      for (int b = 0; b < s; ++b) {
        f(face.axis, face.sign, face.boundary, nodes + node_doubles * (first + a * u + b * v));
      }
    }
  }
}

}  // namespace mpm::core
