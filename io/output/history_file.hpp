// Job_curv.dat: rows of the total energies and of the histories that the scene asks for.
//
// A `Particle` history follows the particle that is nearest to its point when the history starts (of several,
// the one with the lowest identity) wherever it goes. Its last column, `present[particleN]`, is 1; once the
// particle is eroded or has left the grid it is 0, and the others keep their last values. A `Point` history
// is the average over the particles in the cell around the point, weighted by mass and by the cell's
// trilinear function of their distance from the point; 0 while the cell is empty. The same bits on any ranks.
// Shown by tests/io/output/history_file_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"
#include "core/step/totals.hpp"
#include "io/output/table_file.hpp"
#include "io/output/variables.hpp"

namespace mpm::io {

/// What identities no particle has.
inline constexpr std::uint64_t no_identity = ~std::uint64_t{0};

class HistoryFile {
 public:
  struct Continuation {
    TableContinuation rows;              ///< those that are kept
    std::vector<std::uint64_t> tracked;  ///< tracked() when the last of them was written
  };
  /// Throws FileError. Collective.
  HistoryFile(const std::string& path, const core::Model& model, std::optional<Continuation> continuation,
              core::Reductions& ranks);

  /// With histories a row belongs to every step; without, the total energies do, as often as someone wants.
  bool each_step() const { return !targets_.empty(); }
  /// The row of the present state; it waits in memory. Throws core::NumericalFailure where that has no finite
  /// energy. Collective.
  void add(const core::Model& model, core::Reductions& ranks);
  /// The same, where the energies are known.
  void add(const core::Model& model, const core::Energies& energies, core::Reductions& ranks);
  /// Particles that the last row does not find any more, a line each, for the log. The same on all ranks.
  const std::vector<std::string>& gone() const { return gone_; }
  /// Throws FileError. Collective.
  void flush(core::Reductions& ranks) { file_->flush(ranks); }
  /// As flush(), and to the disk itself. Collective.
  void sync(core::Reductions& ranks) { file_->sync(ranks); }
  const TableMark& mark() const { return file_->mark(); }
  const std::string& notice() const { return file_->notice(); }

  /// What histories remember, for restart files: of each particle its identity, whether it is present (0, 1)
  /// and the bits of its last values. The same on all ranks.
  std::vector<std::uint64_t> tracked() const;

 private:
  struct Target {
    core::Vec3<double> point{};
    bool particle = false;  ///< follows a particle; otherwise stays at the point
    std::vector<Variable> variables;
    std::size_t first = 0;  ///< of its record in the values exchanged
    // Of a particle: who it is, and where it was last.
    std::uint64_t identity = no_identity;
    bool present = false;
    std::optional<core::BrickCoord> last;
    std::vector<double> values;  ///< of its last row
  };
  static std::vector<Target> targets_of(const core::Scene& scene);
  bool recall(const std::vector<std::uint64_t>& tracked);
  void choose_particles(const core::Model& model, core::Reductions& ranks);
  std::string head() const;
  std::string legend() const;
  void look_up(const core::Model& model, int reach, std::vector<double>& values) const;
  void average(const core::Model& model, const Target& target, std::vector<double>& values) const;

  std::vector<Target> targets_;
  std::size_t record_ = 0;  ///< doubles exchanged per row
  std::optional<TableFile> file_;
  std::vector<std::string> gone_;
};

}  // namespace mpm::io
