// Contact of the material with rigid bodies of prescribed motion in implicit steps, with Coulomb's friction.
//
// A node touches a body that fills at least a tenth of a cell around it. With d, the displacement of the node
// in the step less that of the body there, n, the normal out of the body, and mu, the coefficient of
// friction, the body exerts on it
//   f = p n - t   p = k max(0, -d.n)   t = k d_t where the material sticks, mu p d_t/|d_t| where it slides
// with d_t = d - (d.n) n: the node may leave the body and slide along it. k is `rigidity` times the stiffness
// of a cell, so that in a step the material enters the body, and creeps where it sticks, by the part
// 1/rigidity of its elastic displacement. The force is a function of the node's displacement alone and enters
// the residual and, with its derivative, the node's block of the Jacobian.
//
// Which nodes stick, and the friction of those that slide, are those of the last solution: a step is solved
// again, from there, until they agree. A node that sticks with more than mu p slides; one that slides against
// its friction sticks. Within a solution friction is thus linear or constant, and the matrix symmetric: with
// mu p inside, Newton's method goes to and fro between directions of sliding.
//
// In a dynamic step contact acts with one force all through the step, and not with the mean of those at its
// ends (C. Kane et al., Comput. Methods Appl. Mech. Eng. 180 (1999) 1): a node that arrives is stopped.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "core/contact/rigid_bodies.hpp"
#include "core/implicit/implicit_passes.hpp"
#include "core/implicit/node_unknowns.hpp"

namespace mpm::core {

class RigidContact {
 public:
  static constexpr double rigidity = 1e4;

  /// `stiffness`: of a cell, force/length.
  RigidContact(Model& model, RigidBodies& rigid, double stiffness);

  /// Begins a step, or begins it anew with another length.
  void begin_step(const Loads& loads, double dt);
  /// Finds the nodes that touch bodies. Collective.
  void find_nodes(ImplicitPasses& passes, NodeUnknowns& unknowns);

  /// A node that touches a body.
  struct Touch {
    std::size_t node;     ///< number of the own node
    int body;             ///< number of the rigid body
    Vec3<double> place;   ///< of the node
    Vec3<double> normal;  ///< out of the body
    Vec3<double> way;     ///< displacement of the body there in the step
    double coefficient;   ///< of friction
    bool sticks = false;
    Vec3<double> friction{};  ///< t of a node that slides
    double pressure = 0;      ///< p of the last solutions
    int solutions = 0;        ///< of this step
    int turns = 0;            ///< changes between sticking and sliding in this step
  };
  std::span<const Touch> touches() const { return touches_; }

  struct Response {
    Vec3<double> force{};      ///< on the node
    Mat3<double> stiffness{};  ///< minus its derivative by the node's displacement
    double pressure = 0;       ///< p, a force
  };
  Response response(const Touch& touch, const Vec3<double>& u) const;

  /// Whether any body has friction.
  bool rubs() const {
    return std::ranges::any_of(friction_, [](double f) { return f > 0; });
  }
  /// Over this rank's nodes.
  struct Changes {
    ExactSum change;  ///< of the friction of nodes that slide
    ExactSum most;    ///< mu p of all
  };
  /// Finds which nodes stick, and friction, by a solution; take_friction() sets them. `relaxation`: stiffness
  /// with which friction grows with the slip of a node that slides.
  Changes find_friction(std::span<const double> u, double relaxation);
  void take_friction() { touches_ = next_; }
  /// Keeps them as the first guess of the next step.
  void keep_friction();

  /// What a body exerts on a node in a step.
  struct Exerted {
    Vec3<double> force{};
    Vec3<double> mean{};  ///< force over the step, that does the work
    Vec3<double> stop{};  ///< impulse at the end of the step, that leads it along the body
    double gained = 0;    ///< kinetic energy of the node by that
  };
  /// The bodies' motion at the end of the step, with what they exert: `exerted` by touch. Collective.
  void end_step(std::span<const double> u, std::span<const Exerted> exerted, StepStatistics& to);

  static Vec3<double> displacement(std::span<const double> u, std::size_t node) {
    return {u[3 * node], u[3 * node + 1], u[3 * node + 2]};
  }

 private:
  Model& model_;
  RigidBodies& rigid_;
  const double k_;
  ContactPairs pairs_;
  std::int32_t material_component_ = 0;
  std::vector<int> body_;         ///< its number in the model, by number of the rigid body
  std::vector<double> friction_;  ///< with the material, by number of the rigid body
  double dt_ = 0;
  std::int64_t step_ = -1;  ///< the last that has been begun
  std::vector<Touch> touches_, next_;
  /// Whether nodes stuck, and friction, at the end of the last step, by body and place.
  std::map<std::tuple<int, double, double, double>, std::tuple<bool, Vec3<double>>> last_;
  std::vector<RigidImpulse> impulses_;
};

/// Null without contact.
std::unique_ptr<RigidContact> make_rigid_contact(Model& model, RigidBodies* rigid, double stiffness);

}  // namespace mpm::core
