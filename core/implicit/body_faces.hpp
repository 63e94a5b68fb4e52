// Rigid bodies of prescribed motion in quasi-static steps: they act on other bodies at their faces.
//
// A face lies anywhere between nodes. At a point x_s of it (face_points.hpp) the displacement of the other
// body is that of its nodes, u(x_s) = sum_i N_i(x_s) u_i, and the force there acts on them by the same
// weights,
//   f_i = sum_s N_i(x_s) f_s(u(x_s) - u_b),
// f_s that of a spring (contact_spring.hpp) between it and the body, whose displacement u_b is given: tied
// without contact, and pressed or sliding with it. N_i are the functions whose gradients particles feel, at a
// point: so a uniform stress with its pressure on the face is in equilibrium wherever the face cuts the
// cells, which it is not with forces at nodes inside the body alone. (Penalties at points of boundaries that
// do not follow the grid: B. Chandra et al., Acta Geotechnica 16 (2021) 2315.)
//
// The stiffness of all points on the face of a cell together is `rigidity` times that of the cell, which
// multigrid bears. The force of a point goes on from step to step, also through a restart. What is left of
// the displacement, the violation, is made good in the mean of a patch, the points of a body in one cell: a
// step is solved again from the forces found, and from this mean in the place of each point's own, until it
// is less than most_violation. So is the force of points that are tied. Made good point by point, and with
// the force of each, it would hold nodes that reach the face by a hundredth of their function, too: a tied
// strip footing then bore 43 % too much.
//
// A point touches a body that has its face there, opposite, or at a distance of up to about 0.3 cells: where
// the volume around the point is not much less than its change along the normal over a cell. Across the
// normal the body may cover any part of the cell.
//
// A point belongs to the brick of its place. Where that has no field of the other body, whose outermost
// particles then are in the next brick towards it, the point belongs to that one. Weights of nodes that are
// not active count for the others.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/implicit/brick_fields.hpp"
#include "core/implicit/contact_spring.hpp"
#include "core/implicit/face_points.hpp"
#include "core/implicit/implicit_contact.hpp"
#include "core/implicit/implicit_passes.hpp"
#include "core/implicit/node_unknowns.hpp"

namespace mpm::core {

class BodyFaces {
 public:
  static constexpr double rigidity = 100;
  static constexpr double most_violation = 1e-6;  ///< of a cell, of a solution

  /// `points`: of the bodies that act at their faces. `contact`: null without.
  BodyFaces(Model& model, Reductions& ranks, const BrickFields& fields, NodeUnknowns& unknowns,
            std::vector<FacePoint> points, ImplicitContact* contact);

  /// Begins a step, or begins it anew with another length.
  void begin_step(const Loads& loads, double dt);
  /// Takes the stiffness of the material, once mapped::implicit_motion has been exchanged.
  void take_moduli() { take_sums(moduli_); }
  /// Finds where faces touch other bodies, once the nodes are numbered, after take_moduli(). Collective.
  void find_points(ImplicitPasses& passes);

  /// Adds forces to the contributions, in the components of node_field::force.
  void add_forces(const AlignedDoubles& displacements);
  /// The same with those at the start of the step.
  void add_start_forces();
  /// Adds the derivative of minus these forces; its structure alone without `displacements`.
  void add_tangent(const AlignedDoubles* displacements, BlockMatrix& matrix) const;

  /// By how much of a cell a solution lets bodies enter each other, or part where they are tied, in the mean
  /// of a patch: the largest of this rank.
  double violation(const AlignedDoubles& displacements) const;
  /// What a solution says of friction (ContactSpring::find_friction); take_friction() sets it.
  void find_friction(const AlignedDoubles& displacements, double relaxation, ContactSpring::Changes& changes);
  void take_friction();
  /// Takes the forces of a solution as those from which springs differ.
  void take_forces(const AlignedDoubles& displacements);

  /// Forces, work and heat of the step. `reactions`: of bodies that are tied, by body; before the particles
  /// move. Collective.
  void end_step(const AlignedDoubles& displacements, StepStatistics& to);

 private:
  /// A point where it touches.
  struct Point {
    std::size_t number;  ///< of the face's points
    std::size_t field;
    std::int32_t component;                                ///< that it touches
    std::vector<std::pair<std::int32_t, double>> weights;  ///< by node of the brick
    ContactSpring spring;
    Vec3<double> before{};  ///< of the gap at the start of the step
    Vec3<double> start;     ///< force at the start of the step
    std::size_t patch = 0;  ///< of the points of a body in one cell
  };
  /// What goes on to the next step, in restart files with the number among the points of its body.
  struct Kept {
    double number, component, sticks, pressure;
    double friction[3], gap[3];
  };
  static constexpr std::size_t size_of_kept = sizeof(Kept) / sizeof(double);
  void take_kept();
  void take_sums(std::vector<double>& to) const;
  void add_points_of(std::size_t number);
  void find_patches();
  void add_force(const Point& point, const Vec3<double>& force);
  bool touch(const BrickField& field, std::size_t number, const Vec3<double>& place, Point& point) const;
  /// What a solution leaves of the displacement where springs hold it, by patch.
  std::vector<Vec3<double>> violations(const AlignedDoubles& displacements) const;
  std::vector<Vec3<double>> tractions(const AlignedDoubles& displacements) const;
  Vec3<double> relative(const Point& point, const AlignedDoubles& displacements) const;
  static std::pair<double, double> key_of(const Kept& k) { return {k.number, k.component}; }
  const Kept* kept(const std::pair<double, double>& key) const;
  void keep_parted(std::span<const Kept> before);
  Vec3<double> place(std::size_t number) const;

  Model& model_;
  Reductions& ranks_;
  const BrickFields& fields_;
  NodeUnknowns& unknowns_;
  ImplicitContact* contact_;
  const std::vector<FacePoint> faces_;     ///< where they were at the start of the run, or after a restart
  std::vector<std::size_t> first_;         ///< of these, by body
  std::vector<Vec3<double>> moved_, way_;  ///< by body: since then, and in this step
  std::vector<std::size_t> reaction_;      ///< by body: number among the model's reactions
  std::vector<bool> deforms_;              ///< by component
  int layers_;                             ///< nodes of a weight along an axis
  double dt_ = 0;
  std::vector<double> moduli_;  ///< stiffness of the material at the nodes of the fields
  std::vector<double> sums_;    ///< volumes and gradients of the fields
  std::vector<Point> points_;
  std::size_t patches_ = 0;
  std::vector<ContactSpring> next_;  ///< by point
  std::vector<Kept> kept_;           ///< of all ranks, by number and component
};

/// The points of the bodies that act at their faces in the scene's steps. Collective.
std::vector<FacePoint> acting_faces(const Model& model, Reductions& ranks);
/// Their bodies, each once.
std::vector<int> bodies_of(std::span<const FacePoint> points);

}  // namespace mpm::core
