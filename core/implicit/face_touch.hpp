// Whether material touches a point on the face of a rigid body, in an implicit step.
//
// At the point count the functions whose gradients particles feel, N_i: with them the material around it has
// the volume V = sum_i N_i V_i, and V grows along the normal by -(sum_i N_i sum_p V_p grad S_ip).n. Material
// that has its face there, or up to about 0.3 cells away (splines; linear functions and GIMP up to one),
// touches: where V is not much less than its growth over a cell. Across the normal the body may cover any
// part of the cell.
//
// A uniform pressure exerts G_i = -sum_p V_p grad S_ip.n on the nodes by particles, and D_i = sum_s A_s
// N_i(x_s) by the points x_s of the faces, with their areas A_s. Where D_i is larger, as at a node that
// particles hardly reach yet, which would fly off with the difference, the weight is N_i G_i/D_i, and those
// of the other nodes are larger.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/implicit/brick_fields.hpp"
#include "core/implicit/face_points.hpp"
#include "core/implicit/node_unknowns.hpp"

namespace mpm::core {

struct FaceTouch {
  std::size_t point = 0;  ///< of the bodies' points
  std::size_t field = 0;
  Vec3<double> place{};
  /// N_i at the point, by node of the field's brick; those of nodes that are not active count for the others.
  std::vector<std::pair<std::int32_t, double>> weights;
  double modulus = 0;  ///< of the material there
  unsigned held = 0;  ///< components that walls hold at the nodes along the normal next to the point, as bits
};

/// The axis nearest to a direction.
int axis_of(const Vec3<double>& direction);
/// The node nearest to a place along an axis, in the grid.
std::int64_t nearest_node(const GridGeometry& g, const Vec3<double>& x, int axis);

class MaterialAtFaces {
 public:
  MaterialAtFaces(Model& model, const BrickFields& fields, NodeUnknowns& unknowns);

  /// Takes the stiffness at the nodes, once mapped::implicit_motion has been exchanged.
  void take_moduli() { take_sums(moduli_); }
  /// Takes volumes and their gradients, once mapped::implicit_surface has been exchanged.
  void take_surface() { take_sums(surface_); }

  /// Of the material of a field with a point that is now at `place`. `is_known`: it has pressed there, or was
  /// tied; then half the volume is enough.
  std::optional<FaceTouch> touch(const BrickField& field, const FacePoint& point, const Vec3<double>& place,
                                 bool is_known) const;
  /// Fits the weights of all points that touch to the particles, as above. Collective.
  void fit(std::span<FaceTouch> touches, std::span<const FacePoint> points);

 private:
  void take_sums(std::vector<double>& to) const;
  bool is_inside(const FaceTouch& touch, std::int32_t node, const Vec3<double>& normal) const;

  BrickGrid& grid_;
  const BrickFields& fields_;
  NodeUnknowns& unknowns_;
  ShapeFunction shape_;
  std::vector<double> moduli_, surface_;  ///< records of node_doubles of the fields' nodes
};

}  // namespace mpm::core
