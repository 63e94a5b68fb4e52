// What acts on particles from outside beside gravity: a body's acceleration over time, a pressure or traction
// on its surface, and what non-reflecting faces of the grid take from the waves that reach them. What they
// add to the nodes comes after the particles' own share, particle by particle; the same forces over the
// nodes' way give the work. A body and a brick that none of them concerns pay nothing.
//
// Surface loads need no surface. A traction T n, T constant, times a weight phi(x) over the surface is a
// volume integral by Gauss's theorem, and particles are its quadrature:
//   f_i = integral of S_i phi T n dA = integral of grad(S_i phi) . T dV = sum V (phi T grad S_i + S_i T grad
//   phi)
// phi is 1 in a box and falls to 0 across its edges, over a ramp; without a box it is 1, and T = -p I is a
// pressure all around the body. With a normal axis e, T = t e^T puts the traction t on the surfaces in the
// box that look along +e.
//
// Non-reflecting face: dashpots on its nodes (Lysmer and Kuhlemeyer 1969), rho c_p against the normal
// velocity, rho c_s against the tangential. The mass of a face's nodes is rho A h/2 for cells of depth h, so
// a particle adds 2 m/h S_i c v. On a node with half a cell's mass that is stable up to 0.73 of the critical
// step; where three such faces meet, up to 0.5, and so far go the steps of a scene with one.
// Shown by tests/core/step/loads_test.cpp.
#pragma once

#include <optional>
#include <vector>

#include "core/model.hpp"

namespace mpm::core {

/// Body force per mass at a time: PrescribedAcceleration or HarmExcit; zero where a body has neither.
Vec3<double> acceleration_of(const BodyInput& input, double time);
/// Its integral from time zero.
Vec3<double> velocity_gained(const BodyInput& input, double time);

/// What decides the velocities of a body's particles: the grid; nothing but gravity and loads (a rigid body);
/// the input.
struct BodyMotion {
  enum class Kind { free, rigid, prescribed };
  Kind kind = Kind::free;
  Vec3<double> velocity{};  ///< prescribed, at the end of the step
};

class Loads {
 public:
  explicit Loads(const Model& model);

  /// Largest part of the critical step with non-reflecting faces.
  static constexpr double nonreflecting_factor = 0.5;

  /// Before a step from `time` to `time + dt`: loads take their value at its middle, held velocities
  /// (ConstrainRigidPosition) that at its end.
  void begin_step(double time, double dt);

  bool any() const { return !bodies_.empty(); }
  /// Per mass, at this step.
  Vec3<double> acceleration(int body) const {
    return any() ? bodies_[static_cast<std::size_t>(body)].acceleration : Vec3<double>{};
  }
  /// How the body's velocities evolve in this step.
  const BodyMotion& motion(int body) const { return motions_[static_cast<std::size_t>(body)]; }
  bool nonreflecting() const { return nonreflecting_; }
  /// Whether add_load_forces has anything to do for this body in this brick.
  bool act(const BrickGrid& grid, Slot slot, int body) const {
    return any() && (bodies_[static_cast<std::size_t>(body)].loaded ||
                     (nonreflecting_ && touches_nonreflecting(grid, slot)));
  }

  /// A surface load of a body as it acts in this step.
  struct Surface {
    Vec3<double> column[3]{};  ///< of T
    const SurfaceLoad* input = nullptr;
    double ramp = 0;
  };
  struct OfBody {
    const BodyInput* input = nullptr;  ///< null in models without
    bool loaded = false;
    Vec3<double> acceleration{};
    std::vector<Surface> surfaces;
    double shear_speed = 0;
  };
  const OfBody& of(int body) const { return bodies_[static_cast<std::size_t>(body)]; }
  double step() const { return dt_; }
  bool touches_nonreflecting(const BrickGrid& grid, Slot slot) const;

 private:
  std::vector<OfBody> bodies_;  ///< empty where nothing at all acts
  std::vector<BodyMotion> motions_;
  bool nonreflecting_ = false;
  double dt_ = 0;
};

}  // namespace mpm::core
