// Rigid bodies of prescribed motion in quasi-static steps: they act on other bodies at their faces.
//
// A face lies anywhere between nodes. It has points (face_points.hpp), which form patches (face_patches.hpp).
// The displacement u of the material at a patch is that of its nodes, with the weights of the functions whose
// gradients particles feel. There a spring acts between the material and the body (contact_spring.hpp), with
// the force
//   f = f(u - u_b)
// of their displacements, that of the body given: tied without contact, and pressed or sliding with it. The
// force acts on the nodes by the same weights. A uniform stress with its pressure on the face is thus in
// equilibrium wherever the face cuts the cells, which it is not with forces at nodes inside the body alone.
// (Penalties at points of boundaries that do not follow the grid: B. Chandra et al., Acta Geotechnica 16
// (2021) 2315.)
//
// The stiffness of the patches on the face of a cell together is `rigidity` times that of the cell, which
// multigrid bears. What is left of the displacement, the violation, is made good: a step is solved again from
// the forces found, until it is less than most_violation. The force of a point, its part of that of the
// patch, and the violation go on from step to step, also through a restart.
//
// A point belongs to the brick of its place. Where that has no field of the other body, whose outermost
// particles then are in the next brick towards it, the point belongs to that one.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/implicit/brick_fields.hpp"
#include "core/implicit/contact_spring.hpp"
#include "core/implicit/face_cover.hpp"
#include "core/implicit/face_patches.hpp"
#include "core/implicit/face_points.hpp"
#include "core/implicit/face_touch.hpp"
#include "core/implicit/implicit_contact.hpp"
#include "core/implicit/implicit_passes.hpp"
#include "core/implicit/node_unknowns.hpp"

namespace mpm::core {

class BodyFaces {
 public:
  static constexpr double rigidity = 100;
  static constexpr double most_violation = 1e-5;  ///< of a cell, of a solution

  /// `points`: of the bodies that act at their faces. `contact`: null without.
  BodyFaces(Model& model, Reductions& ranks, const BrickFields& fields, NodeUnknowns& unknowns,
            std::vector<FacePoint> points, ImplicitContact* contact);

  /// Begins a step, or begins it anew with another length.
  void begin_step(const Loads& loads, double dt);
  /// Takes the stiffness of the material, once mapped::implicit_motion has been exchanged.
  void take_moduli() { material_.take_moduli(); }
  /// Finds where faces touch other bodies, once the nodes are numbered, after take_moduli(). Collective.
  void find_patches(ImplicitPasses& passes);

  /// Adds forces to the contributions, in the components of node_field::force. Collective.
  void add_forces(const AlignedDoubles& displacements);
  /// The same with those at the start of the step.
  void add_start_forces();
  /// Adds the derivative of minus these forces; its structure alone without `displacements`. Collective.
  void add_tangent(const AlignedDoubles* displacements, BlockMatrix& matrix) const;

  /// By how much of a cell a solution lets bodies enter each other, or part where they are tied: the most on
  /// all ranks. Collective.
  double violation(const AlignedDoubles& displacements) const;
  /// What a solution says of friction (ContactSpring::find_friction); take_friction() sets it. Collective.
  void find_friction(const AlignedDoubles& displacements, double relaxation, ContactSpring::Changes& changes);
  void take_friction();
  /// Takes the forces of a solution as those from which springs differ. Collective.
  void take_forces(const AlignedDoubles& displacements);

  /// Forces, work and heat of the step; before the particles move. Collective.
  void end_step(const AlignedDoubles& displacements, StepStatistics& to);

 private:
  /// What goes on to the next step of a point, in restart files with the number among those of its body.
  struct Kept {
    double number, component, sticks, pressure;
    double friction[3], gap[3];
  };
  static constexpr std::size_t size_of_kept = sizeof(Kept) / sizeof(double);

  void take_kept();
  void find_touches(std::size_t number, std::vector<FaceTouch>& found) const;
  std::int32_t component_of(const FaceTouch& touch) const { return fields_.all()[touch.field].component; }
  FacePatch::Key key_of(const FaceTouch& touch) const;
  PatchSums sums_of(const FaceTouch& touch) const;
  void prepare(FacePatch& patch) const;
  Vec3<double> way_of(const FacePatch& patch) const { return way_[static_cast<std::size_t>(patch.body())]; }
  /// Of the material against the body, by patch. Collective.
  std::vector<Vec3<double>> relative(const AlignedDoubles& displacements) const;
  static std::pair<double, double> order(const Kept& k) { return {k.number, k.component}; }
  const Kept* kept(std::size_t number, std::int32_t component) const;
  void keep(const FacePatch& patch, const Vec3<double>& d, std::vector<Kept>& to) const;
  void keep_parted(std::span<const Kept> before);
  void give_to_model() const;
  Vec3<double> place(std::size_t number) const;

  Model& model_;
  Reductions& ranks_;
  const BrickFields& fields_;
  NodeUnknowns& unknowns_;
  ImplicitContact* contact_;
  const std::vector<FacePoint> points_;  ///< where they were at the start of the run, or after a restart
  MaterialAtFaces material_;
  std::optional<FaceCover> cover_;  ///< of tied points
  FacePatches patches_;
  std::vector<std::size_t> first_;         ///< of the points, by body
  std::vector<Vec3<double>> moved_, way_;  ///< by body: since then, and in this step
  std::vector<std::size_t> reaction_;      ///< by body: number among the model's reactions
  std::vector<bool> deforms_;              ///< by component
  double dt_ = 0;
  std::vector<ContactSpring> next_;  ///< by patch
  std::vector<Kept> kept_;           ///< of all ranks, by number and component
};

/// The points of the bodies that act at their faces in the scene's steps. Collective.
std::vector<FacePoint> acting_faces(const Model& model, Reductions& ranks);
/// Their bodies, each once.
std::vector<int> bodies_of(std::span<const FacePoint> points);

}  // namespace mpm::core
