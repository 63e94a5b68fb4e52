// Patches of a rigid body's face, which each touch one component: of a body that is tied the points around
// one node, or two, and in contact each point alone.
//
// The displacement of the material at a patch and the forces on its nodes have the same weights,
//   W_i = sum_s A_s N_i(x_s) / sum_s A_s   u = sum_i W_i u_i   f_i = W_i f
// with the areas A_s of its points and the N_i there (face_touch.hpp).
//
// Of what is tied there are then as many patches as nodes that reach half of one or more. Tied point by
// point, nodes that reach the face by a hundredth of their function would be held, too, and points beside the
// edge would pull: strip footings bore 20 to 40 % too much. With patches that are cells forces may alternate
// from one to the next, which the nodes between do not feel: they grew from step to step to hundreds of times
// the stress. In contact points do not pull, and press as far as the material reaches.
//
// Where bricks take particles by cell, those of different bricks, and ranks, may share a patch: then each has
// a part, and all ranks with a part know the whole.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/implicit/brick_fields.hpp"
#include "core/implicit/contact_spring.hpp"
#include "core/implicit/face_points.hpp"
#include "core/implicit/face_touch.hpp"
#include "core/implicit/node_unknowns.hpp"

namespace mpm::core {

/// Sums over the points of a patch. Those of the last step are of points that touched.
struct PatchSums {
  double area = 0;
  double stiffness = 0;  ///< of the material, times area over the smallest edge of a cell
  Vec3<double> place{};  ///< times area, as is the normal
  Vec3<double> normal{};
  double known = 0;      ///< area of those that touched in the last step
  double stuck = 0;      ///< and of those of them that stuck
  double pressure = 0;   ///< a force
  Vec3<double> force{};  ///< on the material
  Vec3<double> gap{};    ///< times area
  PatchSums& operator+=(const PatchSums& more);
};

struct FacePatch {
  /// Body, component, and a point alone; or many_points, twice the axis of the normal, and 1 if it is along
  /// it, and, by axis, the node, or the cell along the normal.
  using Key = std::array<std::int64_t, 7>;
  static constexpr std::int64_t many_points = -1;
  Key key{};
  PatchSums sums;
  bool counts = true;               ///< of the ranks that have it, on one
  std::vector<std::size_t> points;  ///< of this rank
  ContactSpring spring;
  unsigned on_walls = 7;  ///< components that walls hold at its node, as bits: no springs
  int body() const { return static_cast<int>(key[0]); }
  std::int32_t component() const { return static_cast<std::int32_t>(key[1]); }
  Vec3<double> place() const { return (1 / sums.area) * sums.place; }

  /// Of this rank, by node of a field's brick, times area.
  struct Part {
    std::size_t field;
    std::vector<std::pair<std::int32_t, double>> weights;
  };
  std::vector<Part> parts;
  /// Of all ranks where it counts: unknowns, and their factors in the displacement by component, 0 where
  /// held.
  std::vector<std::int64_t> unknowns;
  std::vector<Vec3<double>> factors;
};

class FacePatches {
 public:
  FacePatches(const Model& model, Reductions& ranks, const BrickFields& fields, const NodeUnknowns& unknowns)
      : model_(model), ranks_(ranks), fields_(fields), unknowns_(unknowns) {}

  void clear();
  /// Adds a point that touches.
  void add(const FacePatch::Key& key, const FaceTouch& touch, const PatchSums& sums);
  /// Once all points are there. Collective.
  void complete();
  std::span<FacePatch> all() { return patches_; }
  std::span<const FacePatch> all() const { return patches_; }

  /// Of the material, by patch. Collective.
  std::vector<Vec3<double>> displacements(const AlignedDoubles& of_nodes) const;
  /// Adds this rank's part of the force on a patch to the contributions.
  void add_force(const FacePatch& patch, const Vec3<double>& force);

 private:
  bool is_shared(const FacePatch::Key& key) const;
  void share_sums();
  void find_unknowns();
  void share_unknowns();

  const Model& model_;
  Reductions& ranks_;
  const BrickFields& fields_;
  const NodeUnknowns& unknowns_;
  std::vector<FacePatch> patches_;
  std::map<FacePatch::Key, std::size_t> number_;
  bool are_shared_ = false;  ///< whether any are, the same on all ranks
};

}  // namespace mpm::core
