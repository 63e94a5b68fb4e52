// Contact between the components of a scene. Components that meet in a brick or its neighbours have velocity
// fields of their own there (local multi-mesh, Ma et al. 2010; review 2.4), all others share one; where
// several fields have mass at a node, impulses stop their approach (node_contact.hpp).
//
// All copies of a node see the same sums and find the same impulses, as they find the same motion.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/communication/node_halo.hpp"
#include "core/exact_sum.hpp"
#include "core/model.hpp"
#include "core/step/node_update.hpp"

namespace mpm::core {

/// Stands for all components where a brick has one velocity field.
inline constexpr std::int32_t every_component = -1;

/// One velocity field at the nodes of a brick.
struct FieldNodes {
  std::int32_t component = every_component;
  std::vector<double> motion;   ///< MotionRecords
  std::vector<double> surface;  ///< records of node_doubles: sum of m grad S in 0..2 (4-31)
};

/// Of a step, by a thread or a rank.
struct ContactSums {
  ExactSum impulse[3];  ///< on the second of the first two components in contact
  ExactSum dissipated;  ///< kinetic energy that contact takes from the nodes
};

class Contact {
 public:
  explicit Contact(const Model& model);

  /// Gives the grid's bricks their fields. Collective, with the neighbouring ranks.
  void find_fields(BrickGrid& grid, NodeHalo& halo);

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

  enum class Velocity { of_end, of_strain };
  /// Changes the velocities of a brick's fields, and with those at the end of the step their increments.
  /// Surfaces at constrained faces are taken as perpendicular to them. Adds to `sums` what happens at nodes
  /// that no later brick has.
  void resolve(const BrickGrid& grid, const SharedNodes& shared, Slot s, Velocity which,
               std::span<FieldNodes> fields, ContactSums& sums) const;

 private:
  double friction(std::int32_t a, std::int32_t b) const {
    return friction_[static_cast<std::size_t>(a) * weight_.size() + static_cast<std::size_t>(b)];
  }
  const Model& model_;
  std::vector<double> weight_;    ///< of normals, by component
  std::vector<double> friction_;  ///< by two components
  std::vector<std::size_t> seen_begin_{0};
  std::vector<std::int32_t> seen_;
};

}  // namespace mpm::core
