// Job_curv.dat: rows of the total energies and of the histories that the scene requests.
//
// A `Particle` history follows the particle that is nearest to its point when the history starts (of several,
// the one with the lowest identity) wherever it goes; one that the input of a restart adds starts there. Its
// last column, `present[particleN]`, is 1; once the particle is eroded or has left the grid it is 0, and the
// others keep their last values. A `Point` history is the average over the particles in the cell around the
// point, weighted by mass and by the cell's trilinear function of their distance from the point; 0 while the
// cell is empty. Bitwise identical on any ranks. Tested by tests/io/output/history_file_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"
#include "core/step/totals.hpp"
#include "io/output/contact_forces.hpp"
#include "io/output/reactions.hpp"
#include "io/output/table_file.hpp"
#include "io/output/variables.hpp"

namespace mpm::io {

/// Identity that no particle has.
inline constexpr std::uint64_t no_identity = ~std::uint64_t{0};

class HistoryFile {
 public:
  struct Continuation {
    TableContinuation rows;              ///< the rows that are kept
    std::vector<std::uint64_t> tracked;  ///< tracked() when the last of them was written
  };
  /// Throws FileError. Collective.
  HistoryFile(const std::string& path, const core::Model& model, std::optional<Continuation> continuation,
              core::Reductions& ranks);

  /// Particles that this run has chosen although it began at a restart, one line each, for the log.
  const std::vector<std::string>& chosen_late() const { return chosen_late_; }
  /// Particles that are farther from the point of their history than particles are from each other, one line
  /// each, for the log.
  const std::vector<std::string>& chosen_far() const { return chosen_far_; }
  /// With histories, every step has a row; otherwise the total energies are written on request.
  bool each_step() const { return !targets_.empty() || !reactions_.means().empty(); }
  /// Adds the row of the present state to the buffer. Throws core::NumericalFailure if an energy is not
  /// finite. Collective.
  void add(const core::Model& model, core::Reductions& ranks);
  /// The same with known energies.
  void add(const core::Model& model, const core::Energies& energies, core::Reductions& ranks);
  /// Particles that the last row no longer finds, one line each, for the log. The same on all ranks.
  const std::vector<std::string>& gone() const { return gone_; }
  /// Throws FileError. Collective.
  void flush(core::Reductions& ranks) { file_->flush(ranks); }
  /// As flush(), and syncs to disk. Collective.
  void sync(core::Reductions& ranks) { file_->sync(ranks); }
  const TableMark& mark() const { return file_->mark(); }
  const std::string& notice() const { return file_->notice(); }

  /// State of the histories for restart files, the same on all ranks: a mark of the format and the number of
  /// particles; of each its place, variables (a hash), identity, presence (0, 1) and last values, with their
  /// number before them; then the memories of both means, each with its length before it. Floating-point
  /// numbers as bits.
  std::vector<std::uint64_t> tracked() const;

 private:
  struct Target {
    core::Vec3<double> point{};
    bool particle = false;  ///< follows a particle; otherwise stays at the point
    std::vector<Variable> variables;
    std::size_t first = 0;  ///< of its record in the values exchanged
    // For a particle: its identity and last position.
    std::uint64_t identity = no_identity;
    bool recalled = false;  ///< from a restart file; otherwise chosen by this run
    bool present = false;
    std::optional<core::BrickCoord> last;
    std::vector<double> values;  ///< of its last row
  };
  static std::vector<Target> targets_of(const core::Scene& scene);
  void recall(const std::vector<std::uint64_t>& tracked);
  void choose_particles(const core::Model& model, core::Reductions& ranks);
  std::string head() const;
  std::string legend() const;
  void look_up(const core::Model& model, int reach, std::vector<double>& values) const;
  /// Of all Points. Collective.
  void average(const core::Model& model, core::Reductions& ranks, std::vector<double>& values) const;

  std::vector<Target> targets_;
  Reactions reactions_;
  ContactForces forces_;
  std::size_t record_ = 0;  ///< doubles exchanged per row
  std::optional<TableFile> file_;
  std::vector<std::string> gone_, chosen_late_, chosen_far_;
};

}  // namespace mpm::io
