// Which particles contact moves from their component to that of the failed (manual 3.2.1,
// FailureDamageThreshold): those that have failed, and those whose damage has reached the threshold, even if
// they still have strength.
#pragma once

#include "core/particles/columns.hpp"

namespace mpm::core {

struct FailedComponentRule {
  double damage = 1;      ///< threshold
  bool scatters = false;  ///< times the particle's threshold_factor, but no more than 1

  /// `block`: from the lane on.
  template <class T>
  MaskOf<T> holds(const ColumnLayout& layout, const double* block) const {
    return holds_with<T>(layout, [&](Column c) { return load<T>(block + layout.offset(c)); });
  }
  /// For a particle whose columns are stored consecutively.
  bool holds_for(const ColumnLayout& layout, const double* columns) const {
    return holds_with<double>(layout, [&](Column c) { return columns[layout.index(c)]; });
  }

 private:
  template <class T, class At>
  MaskOf<T> holds_with(const ColumnLayout& layout, At at) const {
    MaskOf<T> joins{};
    if (layout.has(Column::failed)) joins = at(Column::failed) > 0.5;
    if (layout.has(Column::damage)) {
      T limit = damage;
      if (scatters) limit = min(limit * at(Column::threshold_factor), 1.0);
      // With a threshold of zero, any damage counts, but not its absence.
      const T damaged = at(Column::damage);
      const MaskOf<T> enough = damaged >= limit, some = damaged > 0.0;
      joins = joins | (enough & some);
    }
    return joins;
  }
};

}  // namespace mpm::core
