// Columns with the reactions of bodies: forces, and moments about the centre of mass at the start of the last
// step (of a rigid body in contact: at the start of each), as means since the row before, so that a sum of
// force times interval over the rows is the impulse exactly; where steps change, the interval is that of the
// velocities (impulse_time()), not that of the rows. Of contact, the force on the rigid body; of a prescribed
// velocity, the force that keeps the body in its motion. Tested by
// tests/system/physics_reactions.py.
#pragma once

#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"
#include "io/output/interval_means.hpp"

namespace mpm::io {

/// The columns of a reaction and its number in Model::reactions.
struct ReactionColumns {
  std::size_t reaction = 0;
  bool force = true, moment = true;
};

class Reactions {
 public:
  Reactions(std::vector<ReactionColumns> columns, const core::Model& model);

  const std::vector<std::string>& names() const { return names_; }
  std::string legend() const;
  /// Without memory, the first means are since this state. Collective.
  void begin(const core::Model& model, core::Reductions& ranks);
  /// The values of the present row; of the same state again they are the same. Collective.
  std::vector<double> next(const core::Model& model, core::Reductions& ranks);

  /// State for restart files.
  IntervalMeans& means() { return means_; }
  const IntervalMeans& means() const { return means_; }

 private:
  /// By reaction, those of ReactionSums.
  std::vector<double> sums(const core::Model& model, core::Reductions& ranks) const;

  std::vector<ReactionColumns> columns_;
  std::vector<std::string> names_;
  IntervalMeans means_;  ///< of impulse and moment, by reaction
};

}  // namespace mpm::io
