// External actions on particles other than gravity: a body's force per mass over place and time, a pressure
// or traction on its surface, and the absorption at non-reflecting faces of the grid. Bodies without loads
// and bricks beyond the boxes of surface loads cost nothing.
//
// The part of a body's force per mass that is the same for all its particles acts as gravity does: it
// multiplies the masses of the nodes, but in bricks where several bodies share a velocity field, and works
// over the particles' displacements. The nodal forces of all other loads are added after the particles'
// internal forces, particle by particle; the same forces over the nodal displacements give the work.
//
// Surface loads need no surface representation. By Gauss's theorem a traction T n, T constant, weighted with
// phi(x), is a volume integral, with particles as quadrature points:
//   f_i = integral of S_i phi T n dA = integral of grad(S_i phi) . T dV
//   = sum V (phi T grad S_i + S_i T grad phi)
// phi is 1 in a box and falls linearly to 0 across its edges; without a box it is 1, and T = -p I is a
// pressure on the whole surface of the body. A particle has the mean of phi over a cube of its volume, so
// that a lattice of particles bears the whole load with any width of the edges. With a normal axis e, T = t
// e^T applies the traction t to the surfaces in the box whose normal is +e. Where T varies with the place
// (expressions), the term S_i phi div T is added; its derivatives are central differences over a small part
// of a cell.
//
// Non-reflecting face: the dashpots of Lysmer and Kuhlemeyer (1969), rho c_p v against the normal velocity
// and rho c_s v against the tangential per area, spread over the layer of cells at the face. A particle at
// the distance d adds m 2 (1 - d/h)/h c v, h the cell: the hat has the integral 1 over the layer, and the
// particle maps it with its own functions. With wide functions, dashpots on the nodes of the face alone would
// leave the nodes beyond it as a free surface. A particle slows at most at the rate 2 c/h, where three such
// faces meet at 2 (c_p + 2 c_s)/h; scenes with non-reflecting faces are limited to half the critical step.
// Shown by tests/core/step/loads_test.cpp.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/model.hpp"
#include "core/step/load_functions.hpp"

namespace mpm::core {

/// Body force per mass at a time, from PrescribedAcceleration or HarmExcit; zero without either.
Vec3<double> acceleration_of(const BodyInput& input, double time);
/// Its integral from time zero.
Vec3<double> velocity_gained(const BodyInput& input, double time);

/// In what time gravity and the force per mass at this time (that of expressions excepted) move a free
/// deformable body from rest by half a cell, at least; infinite without either.
double fall_time(const Model& model);

/// The velocity that the input gives a body's particles in a step: for all the same, or with expressions of
/// their places at its beginning.
struct PrescribedMotion {
  Vec3<double> common{};
  std::vector<LoadFunctions::Term> terms;  ///< of place; their values are added
  LoadFunctions* functions = nullptr;      ///< not null where there are any
  const Body* body = nullptr;
  double time = 0;

  /// Of the particle whose column c is lane[layout.offset(c)].
  Vec3<double> velocity(const double* lane) const {
    if (terms.empty()) return common;
    double v[3] = {common.x, common.y, common.z};
    functions->add_values(terms, *body, lane, time, v);
    return {v[0], v[1], v[2]};
  }
};

/// What determines the velocities of a body's particles: the grid; only gravity and loads (a rigid body); or
/// the input.
struct BodyMotion {
  enum class Kind { free, rigid, prescribed };
  Kind kind = Kind::free;
  PrescribedMotion velocity;
  std::size_t reaction = 0;  ///< where prescribed without contact: number among the model's reactions
};

class Loads {
 public:
  explicit Loads(const Model& model);

  /// Largest part of the critical step with non-reflecting faces.
  static constexpr double nonreflecting_factor = 0.5;

  /// Prescribed velocities (ConstrainRigidPosition, expressions) in a step: those at its end, or, where a
  /// step may be long against their changes, the means over it by Gauss's rule, so that bodies travel as
  /// far as the input says; with expressions of the place, those at its middle.
  enum class VelocityOfStep { end, mean };
  /// Called before a step from `time` to `time + dt`; loads are evaluated after `part` of it.
  void begin_step(double time, double dt, double part = 0.5, VelocityOfStep velocity = VelocityOfStep::end);

  bool any() const { return !bodies_.empty(); }
  /// Force per mass on a body in this step: the part that is the same for all its particles.
  Vec3<double> acceleration(int body) const {
    return any() ? bodies_[static_cast<std::size_t>(body)].acceleration : Vec3<double>{};
  }
  /// Angular acceleration of a rigid body at the middle of this step, from PrescribedAcceleration.
  Vec3<double> angular_acceleration(int body) const;
  /// How the body's velocities evolve in this step.
  const BodyMotion& motion(int body) const { return motions_[static_cast<std::size_t>(body)]; }
  bool nonreflecting() const { return nonreflecting_; }
  /// Whether loads other than acceleration() act on this body in this brick.
  bool act(const BrickGrid& grid, Slot slot, int body) const {
    return any() && (reach(bodies_[static_cast<std::size_t>(body)], grid, slot) ||
                     (nonreflecting_ && touches_nonreflecting(grid, slot)));
  }

  /// A surface load of a body in this step.
  struct Surface {
    Vec3<double> column[3]{};  ///< of T
    const SurfaceLoad* input = nullptr;
    double ramp = 0;
    double factor = 1;             ///< over time
    LoadFunctions::Terms terms{};  ///< those of time are in `column`
  };
  struct OfBody {
    const BodyInput* input = nullptr;  ///< null in models without
    bool loaded = false;
    Vec3<double> acceleration{};
    LoadFunctions::Terms force;  ///< of BodyForce; those of time are in `acceleration`
    std::vector<Surface> surfaces;
    double shear_speed = 0;
  };
  const OfBody& of(int body) const { return bodies_[static_cast<std::size_t>(body)]; }

  /// The part of a body's force per mass that varies with the place, for a particle whose column c is
  /// lane[layout.offset(c)].
  Vec3<double> varying_acceleration(const OfBody& of, const Body& body, const double* lane) const;
  struct Stress {
    Vec3<double> column[3]{};
    Vec3<double> divergence{};
  };
  /// T and its divergence for a particle, where they vary with the place.
  Stress varying_stress(const Surface& surface, const Body& body, const double* lane) const;
  /// The first particle for which an expression of a load was not finite since the last call.
  OffendingParticle take_fault() const { return functions_ ? functions_->take_fault() : OffendingParticle{}; }
  bool touches_nonreflecting(const BrickGrid& grid, Slot slot) const;

 private:
  /// Whether a body's loads act on particles in this brick.
  static bool reach(const OfBody& of, const BrickGrid& grid, Slot slot);
  void add_functions(const Model& model, const std::vector<const BodyInput*>& inputs);
  LoadFunctions& functions();
  void set_stress(Surface& surface, const Body& body);

  const Model* model_;
  std::vector<OfBody> bodies_;                ///< empty without any load
  std::unique_ptr<LoadFunctions> functions_;  ///< null without expressions
  struct Held {
    std::size_t body = 0;  ///< its number
    const BodyInput* input = nullptr;
    std::vector<LoadFunctions::Term> of_time;
  };
  std::vector<Held> held_;  ///< bodies whose prescribed velocity has expressions
  std::vector<BodyMotion> motions_;
  bool nonreflecting_ = false;
  double middle_ = 0;      ///< time of the loads: the middle of the step, or as begin_step() was told
  double difference_ = 0;  ///< step of the central differences
};

}  // namespace mpm::core
