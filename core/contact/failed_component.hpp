// The component of failed particles (manual 3.2.1, failure_to_component): in contact, particles that have
// failed leave the component of their body and have a velocity field of their own. Which do follows from
// their state alone (core/material/failed_component.hpp); in a brick they have tiles of their own, and change
// tiles by migration at the end of the step in which they fail.
#pragma once

#include <cstdint>
#include <vector>

#include "core/model.hpp"

namespace mpm::core {

/// Weight of the normals of failed particles: the lowest of all (manual 3.3).
inline constexpr double failed_normal_weight = -32768;

/// Number of a particle's component. `columns` are stored consecutively.
std::int32_t component_of(const Model& model, int body, const double* columns);

class FailedComponent {
 public:
  explicit FailedComponent(const Model& model);

  /// Which particles belong to a tile.
  struct Membership {
    const FailedComponentRule* rule = nullptr;  ///< null: all of its body
    bool of_failed = false;                     ///< those for which the rule holds; otherwise the others

    /// The lanes of a block of the tile, one bit each, that belong to the other tile of the body.
    unsigned misplaced(const ColumnLayout& layout, const double* block, int used) const;
  };
  Membership of(const ParticleTile& tile) const {
    if (rules_.empty()) return {};
    return {&rules_[static_cast<std::size_t>(tile.body)], tile.component == number_};
  }

 private:
  std::vector<FailedComponentRule> rules_;  ///< by body; empty without a component of failed particles
  std::int32_t number_ = 0;
};

}  // namespace mpm::core
