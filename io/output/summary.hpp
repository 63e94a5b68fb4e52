// Job.summary.json: status and results of the run in machine-readable form; and the timing table for the log.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/model.hpp"
#include "core/step/totals.hpp"
#include "io/output/memory_use.hpp"

namespace mpm::io {

/// Status and timings of the run. Seconds are wall time.
struct RunReport {
  std::string status;  ///< "completed", "stopped" or "failed"
  std::string reason;
  int threads = 1;  ///< per rank
  double seconds_total = 0;
  double seconds_setup = 0;
  double seconds_loop = 0;
  core::Spread output;  ///< seconds of tables, pictures and restart files, over the ranks
  /// Per phase of the step, in its order: seconds over the ranks.
  std::vector<std::pair<std::string, core::Spread>> phases;
  /// Parts of the phases: phase, name, seconds over the ranks.
  struct Part {
    std::string phase, name;
    core::Spread seconds;
  };
  std::vector<Part> parts;
  /// Sum over the steps of this run of the particles in each.
  double particle_steps = 0;
};

/// The text of the file; phase times are means over the ranks. Undefined numbers are null. `pairs`: of
/// contact.
std::string summary_json(const core::Model& model, const core::Totals& totals, const RunReport& report,
                         int ranks, const MemoryUse& memory,
                         const std::vector<core::ContactPairTotals>& pairs);

/// Writes the file atomically. Throws FileError. Collective.
void write_summary(const std::string& path, const core::Model& model, const core::Totals& totals,
                   const RunReport& report, core::Reductions& ranks);

/// Seconds per phase and part of a phase over the ranks, shares of the loop and imbalance (max over mean,
/// less one), one line each.
std::string timing_table(const RunReport& report);

}  // namespace mpm::io
