// Columns of Job_curv.dat with the forces between components: their mean since the row before, so that a sum
// of force times interval over the rows is the impulse exactly; where steps change, the interval is that of
// the velocities (impulse_time()), not that of the rows. Component 1 acts on component 2 with the force of
// the last three columns (manual 3.9); the other pairs come before them.
#pragma once

#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"
#include "io/output/interval_means.hpp"

namespace mpm::io {

class ContactForces {
 public:
  /// No columns unless the scene records forces.
  explicit ContactForces(const core::Scene& scene);

  const std::vector<std::string>& columns() const { return columns_; }
  std::string legend() const;
  /// Without memory, the first means are since this state. Collective.
  void begin(const core::Model& model, core::Reductions& ranks);
  /// The forces of the present row, zero in the first of a run. Collective.
  std::vector<double> next(const core::Model& model, core::Reductions& ranks);

  /// State for restart files.
  IntervalMeans& means() { return means_; }
  const IntervalMeans& means() const { return means_; }

 private:
  std::vector<double> impulses(const core::Model& model, core::Reductions& ranks) const;

  std::vector<std::string> columns_;
  std::vector<std::size_t> order_;  ///< of the columns in the record
  IntervalMeans means_;             ///< of the impulses, in the order of the columns
};

}  // namespace mpm::io
