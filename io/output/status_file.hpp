// Job.sta: one row per report of the run's state: step, time, energies, momenta, per body and per material.
//
// Lines that start with '#' are comments; the last of them names the columns. Numbers have 17 significant
// digits, enough to see any drift. Shown by tests/io/output/status_file_test.cpp.
#pragma once

#include <optional>
#include <string>

#include "core/step/totals.hpp"
#include "io/output/text_file.hpp"

namespace mpm::io {

class StatusFile {
 public:
  /// Keeps the rows up to `continue_from`, a step, of an existing file with the same columns; starts anew
  /// without. Throws FileError. Collective.
  StatusFile(const std::string& path, const core::Model& model, std::optional<std::int64_t> continue_from,
             core::Exchange& exchange);

  /// One row, handed to the system when this returns. Throws FileError. Collective.
  void add(const core::Model& model, const core::Totals& totals, core::Exchange& exchange);

  std::int64_t rows_added() const { return rows_; }

 private:
  TextFile file_;
  bool memory_;
  bool occupancy_;
  std::int64_t rows_ = 0;
};

}  // namespace mpm::io
