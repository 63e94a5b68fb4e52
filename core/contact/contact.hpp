// Contact between the components of a scene. Components that meet in a brick or its neighbours have velocity
// fields of their own there (local multi-mesh, Ma et al. 2010; review 2.4), all others share one; where
// several fields have mass at a node, impulses stop their approach (node_contact.hpp).
//
// Three methods (manual 3.9) say what the impulses see and what the particles get of them:
//   bardenhagen           the velocities at the end of the step, after all other forces; all of it
//   pan                   first those at its start, then those that the corrected ones and the forces lead
//                         to; the particles get the second impulses, which oppose the nodal forces. The
//                         first change the velocities that strain and move, and not the particles' momenta
//   improved_bardenhagen  as pan; the particles get both
//
// Bodies whose supports share a node may still be up to two cells apart. With a largest distance, two fields
// touch only if the gap between their surfaces is not larger: the sum of the distances from the node to the
// nearest particle of each, along the normal, from the particles' centres or their faces (review eq. 42).
//
// All copies of a node see the same sums and find the same impulses, as they find the same motion.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/communication/node_halo.hpp"
#include "core/contact/contact_record.hpp"
#include "core/contact/node_contact.hpp"
#include "core/contact/rigid_bodies.hpp"
#include "core/exact_sum.hpp"
#include "core/model.hpp"
#include "core/step/node_update.hpp"

namespace mpm::core {

/// Stands for all components where a brick has one velocity field.
inline constexpr std::int32_t every_component = -1;

/// Where a field has no particle near a node.
inline constexpr double no_reach = -std::numeric_limits<double>::infinity();

/// One velocity field at the nodes of a brick.
struct FieldNodes {
  std::int32_t component = every_component;
  std::vector<double> motion;   ///< MotionRecords
  std::vector<double> surface;  ///< records of node_doubles: sum of m grad S in 0..2 (4-31)
  std::vector<double> reach;  ///< by node: distance from it to the field's surface, along its outward normal
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
  /// Sums the surfaces of the fields that a brick sees, their motion aside; they are taken as perpendicular
  /// to constrained faces.
  void take_surfaces(const BrickGrid& grid, const SharedNodes& shared, Slot s,
                     std::vector<FieldNodes>& fields) const;
  /// With those summed, how far the fields reach.
  void take_reach(const BrickGrid& grid, const SharedNodes& shared, Slot s,
                  std::vector<FieldNodes>& fields) const;
  /// Outward normal of a field at a node: of two fields that of the pair, of more its own. None where it has
  /// no surface.
  std::optional<Vec3<double>> outward(std::span<const FieldNodes> fields, std::size_t field, int node) const;

  /// MUSL's strain velocity comes after that of the end of the step, which the fields' motion still has.
  enum class Velocity { of_end, of_strain, of_strain_after_end };
  /// Changes the velocities of a brick's fields, with take_surfaces() done, and of those at the end of the
  /// step the increments that the particles get. Adds to `sums` what happens at nodes that no later brick
  /// has.
  void resolve(const BrickGrid& grid, const SharedNodes& shared, Slot s, Velocity which,
               std::span<FieldNodes> fields, ContactSums& sums) const;

 private:
  struct Node;
  void find_failed(const BrickGrid& grid, Reductions& ranks);
  ContactSurface surface(const FieldNodes& field, int node) const;
  double friction(std::int32_t a, std::int32_t b) const;
  /// Number of the rigid body that is a component; -1: none.
  int rigid(std::int32_t component) const { return rigid_ == nullptr ? -1 : rigid_->of_component(component); }
  bool find_pairs(std::span<const FieldNodes> fields, int node, Node& at) const;
  void hold_pairs(Node& at) const;
  void resolve_end(Node& at, ContactSums& sums, bool counts) const;

  const Model& model_;
  const RigidBodies* rigid_;
  ContactInput::Method method_;
  std::optional<double> largest_gap_;  ///< length
  bool to_faces_ = false;              ///< gaps between the particles' faces
  bool limits_time_step_ = false;
  std::vector<bool> has_failed_;  ///< by component; all false unless their normals are excluded
  std::vector<double> weight_;    ///< of normals, by component
  std::vector<int> material_;     ///< by component; -1 without bodies
  std::vector<double> friction_;  ///< by two materials
  ContactPairs pairs_;
  std::vector<std::size_t> seen_begin_{0};
  std::vector<std::int32_t> seen_;
};

}  // namespace mpm::core
