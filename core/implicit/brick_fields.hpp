// The displacement fields at the nodes of this rank's bricks: one per brick or, where components are in
// contact, one for each component of which the brick holds particles (BrickGrid::set_components).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/grid/brick_grid.hpp"

namespace mpm::core {

struct BrickField {
  Slot slot = no_slot;
  int number = 0;  ///< among the velocity fields of the brick
  std::int32_t component = all_components;
  std::size_t index = 0;  ///< among all fields of this rank
  bool has(const ParticleTile& tile) const {
    return component == all_components || component == tile.component;
  }
};

class BrickFields {
 public:
  /// Those of the owned bricks.
  void find(const BrickGrid& grid) {
    fields_.clear();
    begin_.assign(1, 0);
    for (Slot s = 0; s < grid.owned(); ++s) {
      if (grid.has_fields_by_component()) {
        int number = 0;
        for (const std::int32_t component : grid.components(s))
          fields_.push_back({s, number++, component, fields_.size()});
      } else {
        fields_.push_back({s, 0, all_components, fields_.size()});
      }
      begin_.push_back(fields_.size());
    }
  }
  std::size_t count() const { return fields_.size(); }
  std::span<const BrickField> all() const { return fields_; }
  std::span<const BrickField> of(Slot s) const {
    const auto at = static_cast<std::size_t>(s);
    return std::span(fields_).subspan(begin_[at], begin_[at + 1] - begin_[at]);
  }

 private:
  std::vector<BrickField> fields_;
  std::vector<std::size_t> begin_{0};  ///< by slot
};

}  // namespace mpm::core
