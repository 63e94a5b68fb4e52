// Rigid bodies in contact with others (thesis chapter 5; manual 3.2.1.13, 3.6.8): fixed, driven, or free with
// six degrees of freedom. Their particles carry mass and surface to the grid; their motion is one state per
// body (rigid_state.hpp), the same bits on every rank.
//
// At a node a driven body has infinite mass, and so has a free one with the motion that it has at the end of
// the step: found once the nodes' velocities without contact are known (rigid_motion.hpp), together with the
// impulses of the driven bodies on it (rigid_contact.hpp). Where the motion is not yet known (USF's strain) a
// free one has its mass over the number of nodes at which it touched others in the step before, so that the
// impulses of all of them stop it and no more (mass splitting, as in node_contact.hpp). Two free bodies do
// not act on each other, nor do two driven ones: contact.hpp stops the run where such two enter each other,
// and this class where a free one comes to a wall of the grid.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/contact/rigid_contact.hpp"
#include "core/exact_sum.hpp"
#include "core/model.hpp"
#include "core/step/loads.hpp"

namespace mpm::core {

/// Of contact on one rigid body in a step, by thread.
struct RigidImpulse {
  ExactSum impulse[3], moment[3];
  ExactSum energy;  ///< that the nodes give to it
  std::int64_t contacts = 0;

  void add(const Vec3<double>& p, const Vec3<double>& arm, double given);
  RigidImpulse& operator+=(const RigidImpulse& other);
};

/// The motions that a free rigid body has in a step: that of the end of the step, and that with XPIC's and
/// FMPM's corrections of the nodes' velocities, which press on it, too. The second begins with the first and
/// is the same without such corrections.
enum class RigidStage { end, corrected };

class RigidBodies {
 public:
  /// States that the model does not have yet follow from the particles. Collective.
  RigidBodies(Model& model, Reductions& ranks);

  std::size_t count() const { return bodies_.size(); }
  /// Number of the rigid body that is this component, or body; -1: deformable.
  int of_component(std::int32_t component) const {
    return by_component_[static_cast<std::size_t>(component)];
  }
  int of_body(int body) const { return by_body_[static_cast<std::size_t>(body)]; }
  /// With the motion without contact until end_step().
  const RigidState& state(int number) const;
  /// Mass over volume of the particles: with a given mass (RigidInertia) not the material's.
  double density(int number) const { return density_[static_cast<std::size_t>(number)]; }
  bool is_free(int number) const { return !bodies_[static_cast<std::size_t>(number)].driven; }
  bool any_free() const {
    return std::ranges::any_of(bodies_, [](const Rigid& r) { return !r.driven; });
  }
  /// Whether a free body touches bodies of prescribed motion in this stage.
  bool meets_rigid(int number) const { return bodies_[static_cast<std::size_t>(number)].meets_rigid; }
  /// Whether a free body slips in this step on all that it touches, as no motion with friction was found.
  bool slips(int number) const { return bodies_[static_cast<std::size_t>(number)].slips; }
  /// Mass of a rigid body at a node where its motion at the end of the step is not known.
  double mass_at_node(int number) const { return node_mass_[static_cast<std::size_t>(number)]; }
  /// Velocity at a place: without contact until find_motion(), which tries several.
  Vec3<double> velocity(RigidStage stage, int number, const Vec3<double>& place) const {
    return bodies_[static_cast<std::size_t>(number)].motion(stage).at(place - state(number).centre);
  }

  /// The motion that the bodies would have without contact.
  void begin_step(const Loads& loads, const Vec3<double>& gravity, const StepLength& length);
  /// The same for a shorter step than begun.
  void shorten_step(const Loads& loads, const Vec3<double>& gravity, const StepLength& length) {
    move_without_contact(loads, gravity, length);
  }
  /// The motion of the free bodies, the stages in their order. `contacts`: where bodies of prescribed motion
  /// meet them, of this rank; respond(responses) adds what its nodes with deformable bodies answer to
  /// velocity(), per body. Throws NumericalFailure where others close on a body. Collective.
  void find_motion(RigidStage stage, std::span<const RigidContact> contacts,
                   const std::function<void(std::span<RigidResponse>)>& respond);
  /// The bodies move with their corrected motion in this step, after find_motion().
  void move_corrected();
  /// On the free body, after find_motion().
  Vec3<double> impulse_of(RigidStage stage, const RigidContact& contact) const;
  /// The longest step in which no body moves by more than a part of a cell; infinite where a scene has
  /// deformable bodies, whose waves limit it.
  double longest_step(const Loads& loads) const;
  /// Moves a block of a rigid body's particles.
  void move(int number, const ColumnLayout& layout, double* block) const;
  /// With the impulses of all threads, per body: the motion at the end of the step. The work of loads and
  /// drives is added to `work`, what contact has dissipated beyond the nodes' sums to `contact`. Collective.
  void end_step(std::vector<RigidImpulse>& impulses, ExactSum& work, ContactRecord& contact);
  /// Sets the velocities of the bodies' particles, which have been moved, after end_step().
  void set_velocities();

 private:
  struct Rigid {
    int body = 0;
    bool driven = false;
    ReactionSums* reaction = nullptr;  ///< of the model, which keeps their number; null: not recorded
    double energy_before = 0;          ///< kinetic, at the start of the step
    Vec3<double> velocity_before{}, spin_before{};
    RigidVelocity end{}, corrected{};  ///< motions of the step
    RigidVelocity moves{};             ///< that with which it moves
    Mat3<double> turn{};               ///< its rotation by it
    bool meets_rigid = false;          ///< meets_rigid()
    bool found = false;                ///< its motion of the stage
    bool slips = false;                ///< slips()

    /// Faces of the grid that hold others and that a free one had reached at the end of the last step, by the
    /// particles of this rank, as bits.
    std::uint32_t reached = 0;

    RigidVelocity& motion(RigidStage stage) { return stage == RigidStage::end ? end : corrected; }
    const RigidVelocity& motion(RigidStage stage) const { return stage == RigidStage::end ? end : corrected; }
  };
  void find_states(Reductions& ranks);
  void find_densities(Reductions& ranks);
  void move_without_contact(const Loads& loads, const Vec3<double>& gravity, const StepLength& length);
  /// 1 for each axis along which particles of the rigid body lie at a symmetry plane. Collective.
  Vec3<double> symmetry_planes_at(int number);
  bool try_motion(RigidStage stage, const std::function<void(std::span<RigidResponse>)>& respond);
  void move_with(Rigid& rigid, const RigidVelocity& motion);
  std::vector<RigidContact>& contacts(RigidStage stage) { return contacts_[static_cast<std::size_t>(stage)]; }
  const std::vector<RigidContact>& contacts(RigidStage stage) const {
    return contacts_[static_cast<std::size_t>(stage)];
  }
  /// Those of all ranks. Collective.
  void gather(RigidStage stage, std::span<const RigidContact> mine);
  /// Of a body.
  std::span<RigidContact> contacts_of(RigidStage stage, std::size_t number);
  [[noreturn]] void fail_pressed(RigidStage stage, std::size_t number);
  std::uint32_t faces_reached(const RigidState& s, const Vec3<double>& x, double edge) const;
  /// Throws NumericalFailure where a free body has reached a face that holds others. Collective.
  void require_inside();

  Model& model_;
  Reductions& ranks_;
  StepLength length_;
  std::vector<Rigid> bodies_;
  std::vector<double> density_;  ///< density()
  std::vector<double> node_mass_;
  std::vector<int> by_component_, by_body_;
  std::vector<RigidContact> contacts_[2];  ///< by stage, of all ranks in this step, in their order
};

/// A sentence for each free rigid body that symmetry planes cut.
std::vector<std::string> rigid_parts_in_words(const Model& model);

/// Null without contact or without rigid bodies. Collective.
std::unique_ptr<RigidBodies> make_rigid_bodies(Model& model, Reductions& ranks);

}  // namespace mpm::core
