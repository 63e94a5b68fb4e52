// Job.sta: one row per report of the run's state: step, time, energies, momenta, per body and per material.
//
// Lines that start with '#' are comments; the last of them lists the columns. Numbers have 17 significant
// digits, enough to see any drift. Tested by tests/io/output/status_file_test.cpp.
#pragma once

#include <optional>
#include <string>

#include "core/step/totals.hpp"
#include "io/output/contact_forces.hpp"
#include "io/output/reactions.hpp"
#include "io/output/table_file.hpp"

namespace mpm::io {

class StatusFile {
 public:
  /// Creates a new file without a continuation. Throws FileError. Collective.
  StatusFile(const std::string& path, const core::Model& model, const std::optional<TableContinuation>& from,
             core::Reductions& ranks);

  /// Writes one row to the system before it returns. Throws FileError. Collective.
  void add(const core::Model& model, const core::Totals& totals, core::Reductions& ranks);

  std::int64_t rows_added() const { return rows_; }
  /// Syncs the rows to disk. Throws FileError. Collective.
  void sync(core::Reductions& ranks) { file_.sync(ranks); }
  /// For restart files: the table's mark, then the memory of the means, first of the reactions. The
  /// constructor takes the first, recall() the others; without these, means begin at the state that the
  /// constructor had.
  std::string mark() const;
  void recall(const std::string& mark);
  const std::string& notice() const { return file_.notice(); }

 private:
  Reactions reactions_;
  ContactForces forces_;
  TableFile file_;
  bool memory_;
  bool occupancy_;
  std::int64_t rows_ = 0;
};

}  // namespace mpm::io
