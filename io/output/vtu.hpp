// Job_vtu/: one unstructured grid of vertices per time, in pieces, one from each rank that has particles,
// combined by a .pvtu; or one such set per body. Job.pvd lists all times and is replaced atomically.
//
// Arrays are appended raw, little-endian, 32-bit reals by default (clipped, see narrowing.hpp). Point data:
// velocity (vector), id, body and the requested variables; velocity_0..2 are in the vector. Tested by
// tests/io/output/vtu_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"
#include "io/output/narrowing.hpp"
#include "io/output/variables.hpp"

namespace mpm::io {

class VtuWriter {
 public:
  struct Settings {
    std::string folder;  ///< folder of Job.pvd and Job_vtu
    std::string job;
    bool per_body = false;
    std::vector<Variable> variables;
    bool double_precision = false;
    /// mark() of the run to be continued, whose list is kept; without it a new list is started.
    std::optional<std::string> continue_from;
  };
  /// Throws FileError. Collective.
  VtuWriter(Settings settings, const core::Model& model, core::Reductions& ranks);

  /// Writes one more time. Throws FileError; the files in Job.pvd stay readable. Collective.
  void write(const core::Model& model, core::Reductions& ranks);

  /// Syncs all files to disk. Throws FileError. Collective.
  void sync(core::Reductions& ranks);
  /// The list, for restart files; empty on ranks other than 0.
  std::string mark() const;
  /// Step of the last time in the list; -1 if there is none.
  std::int64_t last_step() const { return last_step_; }
  /// Notice about missing files; usually empty.
  const std::string& notice() const { return notice_; }
  /// Variables that the last write() clipped for the first time; usually empty. The same on all ranks.
  const std::string& warning() const { return warning_; }
  const CutValues& cut_values() const { return cut_; }

 private:
  struct Entry {
    double time = 0;
    int part = 0;  ///< number of the body, or 0
    std::string name;
    std::string file;  ///< relative to the folder of Job.pvd
  };
  void read_mark(const std::string& mark);
  std::string list() const;
  void write_collection(const core::Scene& scene) const;
  void write_set(const std::string& stem, const std::string& name, const std::vector<std::size_t>& bodies,
                 const core::Model& model, core::Reductions& ranks, int part);

  Settings settings_;
  std::vector<Entry> entries_;  ///< on rank 0
  std::int64_t last_step_ = -1;
  std::vector<std::string> unsynced_;  ///< files of this rank that may not be on the disk yet
  std::string notice_;
  std::vector<std::int64_t> cut_now_;  ///< clipped values of the present write by array, position first
  CutValues cut_;
  std::string warning_;
};

}  // namespace mpm::io
