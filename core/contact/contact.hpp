// Contact between the components of a scene. Components that meet in a brick or its neighbours have velocity
// fields of their own there (local multi-mesh, Ma et al. 2010; review 2.4), all others share one; where
// several fields have mass at a node, impulses stop their approach (node_contact.hpp).
//
// Three methods (manual 3.9) say what the impulses see and what the particles get of them:
//   bardenhagen           the velocities at the end of the step, after all other forces; all of it
//   pan                   first those at its start, then those that the corrected ones and the forces lead
//                         to; the particles get the second impulses, which oppose the nodal forces. The
//                         first change the velocities that strain and move, and the particles' momenta only
//                         as far as the approach is as fast as waves, or the transfer takes velocities from
//                         the nodes
//   improved_bardenhagen  as pan; the particles get both
// Nodes at which a free rigid body is follow bardenhagen's.
//
// Bodies whose supports share a node may still be up to two cells apart. With a largest distance, two fields
// touch only if the gap between their surfaces is not larger: the sum of the distances from the node to the
// nearest particle of each, along the normal, from the particles' centres or their faces (review eq. 42).
//
// All copies of a node see the same sums and find the same impulses, as they find the same motion.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/communication/node_halo.hpp"
#include "core/contact/axis_box.hpp"
#include "core/contact/contact_points.hpp"
#include "core/contact/contact_record.hpp"
#include "core/contact/node_contact.hpp"
#include "core/contact/rigid_bodies.hpp"
#include "core/exact_sum.hpp"
#include "core/model.hpp"
#include "core/step/node_update.hpp"
#include "core/step/offending_particle.hpp"
#include "core/step/shared_nodes.hpp"

namespace mpm::core {

/// Where a field has no particle near a node.
inline constexpr double no_reach = -std::numeric_limits<double>::infinity();

/// One velocity field at the nodes of a brick.
struct FieldNodes {
  std::int32_t component = all_components;
  std::vector<double> motion;   ///< MotionRecords
  std::vector<double> surface;  ///< records of node_doubles: sum of m grad S in 0..2 (4-31), of m S in 3
  /// MotionRecords with the velocities that blows give to the nodes at the end of the step; their masses are
  /// 0.
  std::vector<double> blow;
};

/// Where fields meet in the node block of a brick: once per step, before anything is updated.
struct MeetingNodes {
  struct Pair {
    int first = 0, second = 0;  ///< numbers of the fields, among those that the brick sees
    Vec3<double> normal{};      ///< from the first to the second
    bool shears = false;        ///< above the rough surface of a rigid body
  };
  struct Node {
    int number = 0;      ///< in the node block
    bool counts = true;  ///< no later brick has it
    /// The first brick of this rank that has the node, and its number there: normals by regression are found
    /// once.
    Slot finder = no_slot;
    int number_there = 0;
    std::size_t first_pair = 0, last_pair = 0;
  };
  std::vector<Node> nodes;  ///< in the order of SharedNodes
  std::vector<Pair> pairs;
  OffendingParticle overlap;  ///< of two driven rigid bodies, by number of the node; empty: none
  /// Where gaps are measured: outward normals by node of the list, then field; zero: none.
  std::vector<Vec3<double>> outward;

  std::span<const Pair> pairs_of(const Node& node) const {
    return std::span(pairs).subspan(node.first_pair, node.last_pair - node.first_pair);
  }
  void clear() { nodes.clear(), pairs.clear(), outward.clear(), overlap = {}; }
  template <class F>
  void filter(F keep);
};

/// Of a thread, for normals by regression.
struct RegressionScratch {
  PointsByCell by_cell;
  LabelledPoints points, near;
};

/// A node at which a free rigid body touches others, for the motion of the body.
struct RigidNode {
  Vec3<double> place{};
  std::vector<ContactField> fields;
  std::vector<int> rigid;  ///< numbers of the rigid bodies; -1: deformable
  int moves = -1;  ///< field of the body whose motion of the stage counts; -1: several rigid bodies meet
  std::vector<ContactPair> pairs;
  std::vector<RigidContact> contacts;  ///< with bodies of prescribed motion
};

/// What contact adds to in a step, by thread.
struct ContactSums {
  ContactRecord record;
  std::vector<RigidImpulse> rigid;  ///< by rigid body
  double fastest = 0;               ///< largest speed of approach of two fields in contact
};

class Contact {
 public:
  /// `rigid`: the rigid bodies; null without.
  Contact(const Model& model, const RigidBodies* rigid);

  /// What it has to know of the transfer in a step: the part of the particles' velocities that the nodes'
  /// velocities are, whether these are corrected, and whether particles move with the corrected ones.
  struct TransferOfStep {
    double share_of_nodes = 0;
    bool corrects = false, moves_corrected = false;
  };
  void set_transfer(const TransferOfStep& transfer) { transfer_ = transfer; }

  /// Gives the grid's bricks their fields. Collective, with the neighbouring ranks.
  void find_fields(BrickGrid& grid, NodeHalo& halo, Reductions& ranks);

  /// Whether several components meet in the neighbourhood of an owned brick.
  bool meets(Slot s) const { return seen(s).size() > 1; }
  /// The components in the neighbourhood of an owned brick, ascending.
  std::span<const std::int32_t> seen(Slot s) const {
    const auto at = static_cast<std::size_t>(s);
    return std::span(seen_).subspan(seen_begin_[at], seen_begin_[at + 1] - seen_begin_[at]);
  }
  /// Number of the first of the fields seen by an owned brick, counted over all of them.
  std::size_t first_seen(Slot s) const { return seen_begin_[static_cast<std::size_t>(s)]; }
  std::size_t all_seen() const { return seen_begin_.back(); }

  /// The nodes at which particles that an owned brick has of a component may meet others.
  AxisBox zone(Slot s, std::int32_t component) const;

  /// Share of a cell by which two fields may approach in a step, where contact limits it (contact_time_step);
  /// the speed that the critical step must then allow for.
  static constexpr double most_approach = 0.1;
  double speed_of_step(const ContactSums& sums) const {
    return limits_time_step_ ? sums.fastest / most_approach : 0.0;
  }

  /// Whether the gap between two fields decides about their contact.
  bool measures_gaps() const { return largest_gap_.has_value(); }
  /// Half the edge of a particle of this volume, where the faces of particles count and not their centres.
  double half_edge(double volume) const;
  /// Gets the particles that normals by regression need. Collective, with the neighbouring ranks.
  void collect_points(NodeHalo& halo);
  /// With the surfaces mapped, finds where the fields that a brick sees meet, and their normals. By
  /// regression those of the nodes of which it is the finder; take_normals() gets the others.
  void find_meetings(const BrickGrid& grid, const SharedNodes& shared, Slot s,
                     std::vector<FieldNodes>& fields, RegressionScratch& scratch);
  bool shares_normals() const { return regresses_; }
  /// Normals from the bricks that have found them; then, with all of those taken, complete_meetings().
  void take_normals(Slot s);
  void complete_meetings(Slot s) { complete(s, {}); }
  /// With their reach mapped, drops the pairs that are farther apart than the largest gap.
  void drop_distant_pairs(const BrickGrid& grid, const SharedNodes& shared, Slot s);
  const MeetingNodes& meetings(Slot s) const { return meetings_[static_cast<std::size_t>(s)]; }
  /// Where two driven rigid bodies overlap, of this rank: the node of the lowest number.
  OffendingParticle first_overlap() const;

  /// Free rigid bodies: the nodes at which the fields that a brick sees touch them, no later brick having
  /// these, and the answer of such a node to a trial motion of the bodies. The fields have the motion of the
  /// end of the step, or its corrected velocities, without the contact of this stage.
  bool sees_free_body(Slot s) const;
  bool is_rigid(std::int32_t component) const { return rigid(component) >= 0; }
  void find_rigid_nodes(const BrickGrid& grid, Slot s, RigidStage stage, std::span<FieldNodes> fields,
                        std::vector<RigidNode>& to) const;
  void respond(const RigidNode& node, RigidStage stage, std::span<RigidResponse> to) const;

  /// MUSL's strain velocity comes after that of the end of the step, which the fields' motion still has. So
  /// do the corrected velocities of XPIC and FMPM, which come in its place.
  enum class Velocity { of_end, of_strain, of_strain_after_end, of_correction };
  /// Changes the velocities of the fields that a brick sees where they meet, and of those at the end of the
  /// step the increments that the particles get. Adds to `sums` what happens at nodes that no later brick
  /// has.
  void resolve(const BrickGrid& grid, Slot s, Velocity which, std::span<FieldNodes> fields,
               ContactSums& sums) const;

 private:
  struct Node;
  void find_failed(const BrickGrid& grid, Reductions& ranks);
  ContactSurface surface(const FieldNodes& field, int node) const;
  bool by_regression(std::int32_t a, std::int32_t b) const;
  bool are_rigid_and_meet(std::int32_t a, std::int32_t b) const;
  Friction friction(std::int32_t a, std::int32_t b) const;
  /// Number of the rigid body that is a component; -1: none.
  int rigid(std::int32_t component) const { return rigid_ == nullptr ? -1 : rigid_->of_component(component); }
  bool is_slipping(int rigid) const { return rigid >= 0 && rigid_->slips(rigid); }
  void take_surfaces(const BrickGrid& grid, const SharedNodes& shared, Slot s,
                     std::vector<FieldNodes>& fields) const;
  void find_nodes(const BrickGrid& grid, const SharedNodes& shared, Slot s,
                  std::span<const FieldNodes> fields);
  void find_normals(const BrickGrid& grid, Slot s, std::span<const FieldNodes> fields,
                    RegressionScratch& scratch);
  void complete(Slot s, std::span<const FieldNodes> fields);
  void find_overlap(const BrickGrid& grid, Slot s, int node, std::span<const FieldNodes> fields,
                    std::span<const int> present);
  static Vec3<double> outward(int field, std::span<const MeetingNodes::Pair> pairs);
  Vec3<double> outward(std::span<const FieldNodes> fields, int field, int node,
                       std::span<const MeetingNodes::Pair> pairs) const;
  static std::int64_t number_in_grid(const BrickGrid& grid, Slot s, const std::array<int, 3>& in_brick);
  bool take_node(const BrickGrid& grid, Slot s, Velocity which, std::span<FieldNodes> fields,
                 const MeetingNodes::Node& node, Node& at) const;
  bool find_pairs(std::span<const FieldNodes> fields, std::span<const MeetingNodes::Pair> pairs,
                  Node& at) const;
  void take_rigid_contacts(Node& at) const;
  void hold_pairs(Node& at, Velocity which) const;
  void prepare_strain(Node& at, Velocity which) const;
  void resolve_strain(Node& at, Velocity which) const;
  static void keep_strain(const Node& at);
  void book_on_rigid(int number, RigidStage stage, const Vec3<double>& place, const Vec3<double>& impulse,
                     const Vec3<double>& velocity, ContactSums& sums) const;
  void book_pair_on_rigid(const Node& at, const ContactPair& pair, RigidStage stage,
                          const Vec3<double>& impulse, ContactSums& sums) const;
  void book_correction(const Node& at, ContactSums& sums) const;
  static Vec3<double> increment(const Node& at, std::size_t field);
  double share_of_particles(const Node& at, const ContactPair& pair) const;
  void correct_start(Node& at, ContactInput::Method method) const;
  void find_first_impulses(Node& at) const;
  void resolve_end(Node& at, ContactSums& sums, bool counts) const;
  void find_blows(const Node& at, std::span<Vec3<double>> by_field) const;
  void book(const Node& at, ContactSums& sums) const;
  void book_rigid(const Node& at, RigidStage stage, ContactSums& sums) const;

  const Model& model_;
  const RigidBodies* rigid_;
  ContactInput::Method method_;
  std::optional<double> largest_gap_;  ///< length
  bool to_faces_ = false;              ///< gaps between the particles' faces
  bool limits_time_step_ = false;
  TransferOfStep transfer_;
  std::vector<bool> has_failed_;    ///< by component; all false unless their normals are excluded
  std::vector<double> weight_;      ///< of normals, by component
  std::vector<double> wave_;        ///< largest wave speed at the start, by component; 0: rigid, or failed
  std::vector<int> material_;       ///< by component; -1 without bodies
  std::vector<Friction> friction_;  ///< by two materials
  ContactPairs pairs_;
  std::vector<std::size_t> seen_begin_{0};
  std::vector<std::int32_t> seen_;
  ContactInput::Normal normal_;
  bool regresses_ = false;  ///< some pairs of components: particles give their normals
  /// Mass in a full cell, by component, of rigid bodies; 0: others. Empty with fewer than two of them.
  std::vector<double> full_mass_;
  ContactPoints points_;                ///< empty unless particles give normals
  std::vector<MeetingNodes> meetings_;  ///< by owned slot; those of slots that do not meet are not set
};

}  // namespace mpm::core
