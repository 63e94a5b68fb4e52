// Columns with the reactions of bodies: forces, and moments about the centre of mass at the start of the last
// step (of a rigid body in contact: at the start of each), as means since the row before, so that a sum of
// force times interval over the rows is the impulse exactly. Of contact, the force on the rigid body; of a
// prescribed velocity, the force that keeps the body in its motion. Tested by
// tests/system/physics_reactions.py.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"

namespace mpm::io {

/// The columns of a reaction and its number in Model::reactions.
struct ReactionColumns {
  std::size_t reaction = 0;
  bool force = true, moment = true;
};

class Reactions {
 public:
  explicit Reactions(std::vector<ReactionColumns> columns);

  std::vector<std::string> names(const core::Model& model) const;
  std::string legend() const;
  /// The values of the present row; of the same state again they are the same. Collective.
  std::vector<double> next(const core::Model& model, core::Reductions& ranks);

  /// State for restart files: the last row and the one before.
  std::size_t memory_length() const { return columns_.empty() ? 0 : last_.size() + earlier_.size(); }
  std::vector<std::uint64_t> memory() const;
  /// Without memory_length() entries nothing is recalled, and the next means are since time zero.
  void recall(std::span<const std::uint64_t> memory);

 private:
  std::vector<ReactionColumns> columns_;
  /// Of a row: its time, then impulse and moment since time zero by reaction.
  std::vector<double> last_, earlier_;
};

}  // namespace mpm::io
