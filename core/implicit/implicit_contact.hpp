// Contact in implicit steps, with Coulomb's friction: of components with each other, and with rigid bodies of
// prescribed motion.
//
// Where components meet at a node each has a displacement of its own (node_unknowns.hpp); that of a rigid
// body is given. Two of them that touch there press on each other and rub by a spring (contact_spring.hpp) of
// `rigidity` times the stiffness of a cell of the stiffer one, so that in a step they enter each other, and
// creep where they stick, by the part 1/rigidity of the elastic displacement. The force is a function of the
// displacements at the node alone and enters the residual and, with its derivative, the Jacobian. Of more
// than two components at a node every two touch.
//
// Rigid bodies act in quasi-static steps at their faces (body_faces.hpp) and not here, unless they turn. In
// others a node touches a rigid body that fills at least a tenth of a cell around it; the normal is that of
// the steeper of the two volumes, the body's and the material's: where both have a face these are opposite,
// and at an edge of one, whose normal is that of the corner, the face of the other decides. Two deformable
// components touch where, with the volumes V that they fill around the node and their gradients along the
// normal over a cell, V_1 + V_2 >= least_cover max(|dV_1|, |dV_2|): the sum of the volumes is the larger
// gradient or more where no gap is between them, whatever part of the cell's width they cover, and falls to
// 0.4 to 0.5 of it at a gap of a cell (linear functions). The normal is that of the component of the larger
// normal_vector_weight, as in explicit steps. With equal weights it is the direction of what grad V_1 and
// -grad V_2 have in common, the smaller one of each component of the same sign: where the two fill the cell
// both are equal; a free side of one or both, which tilts the mean of the two normals, is not in common.
// Along the axes of the grid that is exact. Where they have nothing in common, one of them has the node
// inside, as the middle of a plate of two cells, or the node is beyond a face that wide shape functions
// reach: the normal is that of the steeper one of grad V/V, or they do not touch (touch() has the rule).
//
// In a dynamic step contact acts with one force all through the step, and not with the mean of those at its
// ends (C. Kane et al., Comput. Methods Appl. Mech. Eng. 180 (1999) 1); nodes that meet are stopped against
// each other by an impulse at the end of the step.
//
// Every rank that owns an unknown at a node has all that meets there, and finds the same forces.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "core/contact/rigid_bodies.hpp"
#include "core/implicit/contact_spring.hpp"
#include "core/implicit/implicit_passes.hpp"
#include "core/implicit/node_unknowns.hpp"

namespace mpm::core {

class ImplicitContact {
 public:
  static constexpr double rigidity = 1e4;
  static constexpr double least_cover = 0.4;

  /// `rigid`: null without rigid bodies.
  ImplicitContact(Model& model, RigidBodies* rigid, NodeUnknowns& unknowns);

  /// Begins a step, or begins it anew with another length.
  void begin_step(const Loads& loads, double dt);
  /// Finds where components meet; `mass`: of the own nodes. Collective.
  void find_nodes(ImplicitPasses& passes, std::span<const double> mass);

  static constexpr std::size_t no_own = static_cast<std::size_t>(-1);
  /// A component at a node where it meets others.
  struct Member {
    std::int32_t component = 0;
    int rigid = -1;             ///< number of the rigid body; -1: deformable
    std::int64_t number = -1;   ///< of the unknown, of all ranks; -1: rigid
    std::size_t own = no_own;   ///< own number; no_own: another rank's, or rigid
    std::uint8_t held = 0;      ///< components that are given, as bits; 7: rigid
    double mass = 0;            ///< infinite: rigid
    Vec3<double> displacement;  ///< in the step
    Vec3<double> velocity;      ///< at the end of the step without the impulses of this class
    NodeUnknowns::Copy at;      ///< where the unknown is
    bool moves(int axis) const { return (held >> axis & 1) == 0; }
  };
  /// Two of them that touch.
  struct Touch {
    std::size_t first, second;  ///< of members()
    Vec3<double> place;         ///< of the node
    ContactSpring spring;
    bool counts = false;  ///< on this rank: of one of the ranks that know it
  };
  std::span<const Member> members() const { return members_; }
  std::span<const Touch> touches() const { return touches_; }

  /// Takes the displacements of the members once NodeUnknowns::distribute() has sent those of all ranks.
  void take_displacements();

  ContactSpring::Response response(const Touch& touch) const {
    return touch.spring.response(relative(touch));
  }
  /// f(own node, force on it, whether by a rigid body) of each touch.
  template <class F>
  void for_each_force(F f) const {
    for (const Touch& touch : touches_) {
      const Vec3<double> force = response(touch).force;
      const Member &first = members_[touch.first], &second = members_[touch.second];
      if (first.own != no_own) f(first.own, -1.0 * force, second.rigid >= 0);
      if (second.own != no_own) f(second.own, force, first.rigid >= 0);
    }
  }
  /// Adds `factor` times the stiffness; its structure alone without `values`.
  void add_tangent(double factor, bool values, BlockMatrix& matrix) const;

  /// Whether deformable components may meet.
  bool has_springs() const {
    return std::ranges::count_if(stiffness_, [](double k) { return k > 0; }) > 1;
  }
  /// Whether any two components have friction.
  bool rubs() const {
    return std::ranges::any_of(friction_, [](const Friction& f) { return f.coefficient > 0; });
  }
  /// Finds which nodes stick, and friction, by the displacements taken (ContactSpring::find_friction);
  /// take_friction() sets them.
  void find_friction(double relaxation, ContactSpring::Changes& changes);
  void take_friction() { touches_ = next_; }
  /// Keeps them as the first guess of the next step.
  void keep_friction();

  /// Dynamic steps: with the velocities that own nodes would have at the end of the step, finds the impulses
  /// that stop what presses. gained(own node, change of its velocity). Collective.
  template <class F>
  void stop(std::span<const double> velocity_at_end, double least_mass, F gained) {
    find_stops(velocity_at_end, least_mass);
    for (std::size_t t = 0; t < touches_.size(); ++t) {
      const Member &a = members_[touches_[t].first], &b = members_[touches_[t].second];
      if (stops_[t].impulse == Vec3<double>{}) continue;
      if (a.own != no_own) gained(a.own, stops_[t].on_first);
      if (b.own != no_own) gained(b.own, stops_[t].on_second);
    }
  }
  /// Quasi-static steps: the force at the start, that of equilibrium, by the forces on own nodes without
  /// contact: the mean with that at the end does the work.
  void find_start(std::span<const Vec3<double>> force_of_own);

  /// Rigid bodies that act on others at their faces (body_faces.hpp), and not here: add_face() is given what
  /// a point of such a face does in the step, `impulse` on the deformable component and `given`, the work of
  /// the rigid one.
  void leave_to_faces(int body) { at_faces_[static_cast<std::size_t>(rigid_->of_body(body))] = true; }
  void add_face(std::int32_t rigid, std::int32_t deformable, const Vec3<double>& place,
                const Vec3<double>& impulse, double given, double heat, StepStatistics& to);
  double coefficient(std::int32_t a, std::int32_t b) const { return friction(a, b).coefficient; }

  /// What contact has done in the step; the motion of rigid bodies at its end. Collective.
  void end_step(StepStatistics& to);

 private:
  /// Of a touch, in a dynamic step.
  struct Stop {
    Vec3<double> impulse{};                ///< on the second
    Vec3<double> on_first{}, on_second{};  ///< changes of velocity
    double gained = 0;                     ///< kinetic energy of relative motion
  };
  struct Surface {
    std::int32_t component;
    double volume;
    Vec3<double> gradient;  ///< sum of V grad S: points outward
    NodeUnknowns::Copy at;
  };
  struct Meeting {
    Vec3<double> place;
    std::vector<Surface> surfaces;  ///< by component
  };
  std::vector<Meeting> find_meetings(ImplicitPasses& passes);
  std::size_t add_member(const Surface& surface, const Vec3<double>& place);
  void add_touch(std::size_t first, std::size_t second, const Vec3<double>& place, const Vec3<double>& normal,
                 double coefficient);
  bool touch(const Surface& first, const Surface& second, Vec3<double>& normal) const;
  double coefficient(const Surface& first, const Surface& second) const;
  void find_stops(std::span<const double> velocity_at_end, double least_mass);
  int rigid(std::int32_t component) const { return rigid_ == nullptr ? -1 : rigid_->of_component(component); }
  const Friction& friction(std::int32_t a, std::int32_t b) const {
    return friction_[static_cast<std::size_t>(a) * stiffness_.size() + static_cast<std::size_t>(b)];
  }
  Vec3<double> relative(const Touch& touch) const {
    return members_[touch.second].displacement - members_[touch.first].displacement;
  }

  Model& model_;
  RigidBodies* rigid_;
  NodeUnknowns& unknowns_;
  ContactPairs pairs_;
  std::vector<double> stiffness_;   ///< of a cell, by component, force/length; 0: rigid
  std::vector<double> weight_;      ///< of normals, by component
  std::vector<Friction> friction_;  ///< by two components
  double dt_ = 0;
  std::int64_t step_ = -1;  ///< the last that has been begun
  std::vector<Member> members_;
  std::vector<Touch> touches_, next_;
  std::vector<Stop> stops_;
  std::vector<Vec3<double>> start_;  ///< forces at the start, by touch
  /// Whether nodes stuck, and friction, at the end of the last step, by components and place.
  using Key = std::tuple<std::int32_t, std::int32_t, double, double, double>;
  Key key_of(const Touch& touch) const {
    const Vec3<double>& x = touch.place;
    return {members_[touch.first].component, members_[touch.second].component, x.x, x.y, x.z};
  }
  std::map<Key, std::tuple<bool, Vec3<double>>> last_;
  std::vector<RigidImpulse> impulses_;
  std::vector<bool> at_faces_;  ///< by rigid body
};

/// Null where nothing can meet: without contact, or with one component.
std::unique_ptr<ImplicitContact> make_implicit_contact(Model& model, RigidBodies* rigid,
                                                       NodeUnknowns& unknowns);

}  // namespace mpm::core
