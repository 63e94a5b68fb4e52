// Implicit steps (Solution@Integration "impl"): the nodes' displacements u in a step follow from the equation
// of motion at its end, or from equilibrium,
//   R(u) = m (inertia u - start v - recall q) - carry f - f_ext - f_int(u) = 0
// (time_rule.hpp, with q over the mass here; stress_response.hpp)
// solved by Newton's method with the laws' consistent tangents. The grid is the configuration at the start of
// the step; particles keep their state until the step has converged (Guilkey and Weiss, IJNME 57 (2003) 1323,
// for the method; AMPLE, Coombs and Augarde, Adv. Eng. Softw. 139 (2020) 102748, for the quasi-static form).
//
// A step that does not converge or that step_motion.hpp refuses is taken again with half its length; steps
// that were cut grow again. Where free flight itself would invert or overstrain a particle, Newton's method
// begins at rest instead: with a rule whose velocity at the end depends on the forces at the start, which are
// mapped anew, stiff nodes keep velocities that a step of a thousand explicit ones turns into such strains.
//
// Held nodes are led to their places: Newton's method begins with the motion of free flight at all nodes, and
// what is left of the way of held ones enters the residual of the others by its derivative, R + dR/du_h du_h,
// a difference of two residuals; a full step of Newton's method then ends there, with the linear answer of
// the free nodes to all of the way. If they were there from the start, the particles next to them would
// invert as soon as they move by more than a cell.
#pragma once

#include <array>
#include <memory>

#include "core/implicit/body_faces.hpp"
#include "core/implicit/brick_fields.hpp"
#include "core/implicit/cell_stabilisation.hpp"
#include "core/implicit/implicit_contact.hpp"
#include "core/implicit/implicit_passes.hpp"
#include "core/implicit/time_rule.hpp"
#include "core/step/cells_in_use.hpp"
#include "core/step/integrator.hpp"

namespace mpm::core {

class ImplicitIntegrator final : public Integrator, private NonlinearProblem {
 public:
  /// `solver` outlives the integrator.
  ImplicitIntegrator(Model& model, Communication& communication, NewtonSolver& solver);

  std::vector<Phase> phases() override;
  double next_step(const Clock& clock) const override;
  void begin_step(double) override {}
  double stable_step(const StepStatistics& statistics) const override;
  StepStatistics take_statistics() override;
  std::vector<std::vector<DepartingParticle>>& departing() override { return passes_->departing(); }
  std::string words_of_step() const override { return words_; }
  std::string words_of_run() const override;
  std::vector<PartOfPhase> parts() const override;

 private:
  /// Of its phase.
  const char* name_of_solution() const;

  /// State of an own node in the step; vectors of three.
  struct NodeState {
    double mass;
    double ground;       ///< stiffness against any displacement but that of free motion
    double velocity[3];  ///< at the start
    double lag[3];       ///< of the acceleration, at the start
    double external[3];  ///< force
    double force[3];     ///< all, at the start
    double contact[3];   ///< force in the last evaluation
    bool meets_rigid;    ///< a part of it is by a rigid body
    double reaction[3];  ///< residual of the last evaluation, also of held components
    double ahead[3];     ///< what the rest of the way of held nodes adds to it
    double drive[3];     ///< change of velocity in the step of the bodies of prescribed motion that hold it
    double impulse[3];   ///< of these bodies on it
  };

  // NonlinearProblem.
  std::int64_t own_nodes() const override { return static_cast<std::int64_t>(unknowns_.own()); }
  std::int64_t first_node() const override { return unknowns_.first(); }
  std::int64_t all_nodes() const override { return unknowns_.all(); }
  std::span<const double> coordinates() const override { return unknowns_.coordinates(); }
  std::span<const std::int32_t> lattice() const override { return unknowns_.lattice(); }
  std::span<const std::int32_t> fields() const override { return unknowns_.components(); }
  std::span<const std::uint8_t> held() const override { return unknowns_.held(); }
  bool has_springs() const override { return contact_ && contact_->has_springs(); }
  bool residual(std::span<const double> u, std::span<double> r) override;
  double force_scale() const override { return force_scale_; }
  void structure(BlockMatrix& matrix) override {
    passes_->add_tangent(nullptr, unknowns_, matrix);
    stabilisation_.add_tangent(unknowns_, false, matrix);
    if (contact_) contact_->add_tangent(0, false, matrix);
    if (faces_) faces_->add_tangent(nullptr, matrix);
  }
  void jacobian(std::span<const double> u, BlockMatrix& matrix) override;

  void prepare();
  void solve();
  NewtonReport solve_once(std::span<double> u, const NewtonOptions& options);
  /// The same again in a step, with its report added.
  void solve_again(std::span<double> u, const NewtonOptions& options, NewtonReport& report);
  void settle_friction(std::span<double> u, const NewtonOptions& options, NewtonReport& report);
  void settle_contact(std::span<double> u, const NewtonOptions& options, NewtonReport& report);
  /// Impulses on the nodes that bodies of prescribed motion hold, by the solution; to these bodies.
  /// Collective.
  void find_reactions();
  void move();
  void find_fields();
  void find_contacts();
  /// Sends displacements of the own nodes to all bricks, and to contact. Collective.
  void distribute(std::span<const double> u);
  /// Sets the nodes' contact forces at the displacements distributed.
  void find_contact_forces();
  void stop_contacts(std::span<double> gained);
  /// Of free flight, or of nodes at rest.
  std::vector<double> first_guess(bool at_rest) const;
  /// Whether a state strains particles more than a step may, or inverts them. Collective.
  bool overstrains(std::span<const double> u);
  /// Why the solution cannot be accepted; empty if it can. The same on all ranks.
  std::string objection(const NewtonReport& report, std::span<const double> u);
  /// Maps the forces for displacements `u` and exchanges them. False where a state cannot be evaluated.
  bool map_forces(std::span<const double> u);
  /// What held nodes have left of their way, into `ahead`, times a small factor, which it returns, plus `u`;
  /// 0: nothing.
  double look_ahead(std::span<const double> u);
  /// Displacement of a node without forces.
  double free_motion(const NodeState& at, int axis) const {
    return rule_.dynamic() ? model_.clock.dt * at.velocity[axis] : 0;
  }
  bool held(std::size_t node, int axis) const { return (unknowns_.held()[node] >> axis & 1) != 0; }
  /// By a body of prescribed motion.
  bool moved(std::size_t node, int axis) const {
    return moves_bodies_ && (unknowns_.moved()[node] >> axis & 1) != 0;
  }
  [[noreturn]] void fail(const std::string& why, std::span<const double> u);
  std::string bodies_around(const std::array<double, 3>& place);

  Model& model_;
  Reductions& ranks_;
  NodeHalo& halo_;
  NewtonSolver& solver_;
  const ImplicitInput input_;
  std::vector<FacePoint> face_points_;  ///< of bodies that act at their faces; until faces_ takes them
  const std::vector<int> with_faces_;   ///< these bodies
  std::unique_ptr<CellsInUse> cells_;
  std::unique_ptr<RigidBodies> rigid_;  ///< in contact; null without
  BrickFields fields_;
  std::unique_ptr<ImplicitPasses> passes_;
  NodeUnknowns unknowns_;
  CellStabilisation stabilisation_;
  std::unique_ptr<ImplicitContact> contact_;  ///< null without
  std::unique_ptr<BodyFaces> faces_;          ///< null without bodies that act at their faces
  TimeRule rule_;
  const bool lags_;            ///< particles carry a lag
  bool moves_bodies_ = false;  ///< some body has a prescribed motion
  double held_diagonal_ = 0;   ///< of the Jacobian's held components
  double force_scale_ = 0;
  std::vector<NodeState> state_;
  std::vector<double> solution_, ahead_;
  AlignedDoubles displacements_, velocities_, lag_increments_;  ///< records of the bricks' nodes
  StepStatistics of_nodes_;
  std::string words_;
  /// Of all steps.
  NewtonReport total_;
  std::int64_t solves_ = 0, rejected_ = 0;
};

}  // namespace mpm::core
