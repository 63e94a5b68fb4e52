// Job.h5part: all times in one HDF5 file, one group `Step#n` per time, one dataset per quantity (the H5Part
// schema: A. Adelmann et al., vis.lbl.gov/Research/AcceleratorSAPP). ParaView joins name_0, name_1, name_2 to
// a vector.
// Reals are 32-bit floats; values beyond their range are clipped (narrowing.hpp).
//
// Every group has the attributes TimeValue and step, and x, y, z, velocity_0..2 (reals), id (64-bit), body
// (32-bit) and the requested variables. Rows are in the order of particle_order.hpp.
// A time is written to a group that readers ignore, and renamed when it is complete; earlier times stay
// readable throughout. Its attribute `checksum` covers the values of all its datasets. A restarted run
// restores the file (h5part_mark.hpp), so a kill or damage in between has no effect. Limit: if the run is not
// restarted, a kill within the few microseconds of the renaming may damage the file. Tested by
// tests/io/output/h5part_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"
#include "io/output/h5part_mark.hpp"
#include "io/output/narrowing.hpp"
#include "io/output/variables.hpp"

namespace mpm::io {

class H5PartWriter {
 public:
  struct Settings {
    std::string path;
    std::vector<Variable> variables;
    bool double_precision = false;
    /// mark() of the run to be continued, empty if it had none; without a value a new file is started.
    std::optional<std::string> continue_from;
  };
  /// Bodies without output are left out. Throws FileError. Collective.
  H5PartWriter(Settings settings, const core::Model& model, core::Reductions& ranks);

  /// Writes one more time. Throws FileError; the earlier times stay readable. Collective.
  void write(const core::Model& model, core::Reductions& ranks);

  /// The mark of the file for a restart file, on rank 0; syncs the file to disk. Throws FileError.
  /// Collective.
  std::string mark(core::Reductions& ranks);
  /// Ends the file and syncs it to disk. Throws FileError. Collective.
  void finish(core::Reductions& ranks);

  int times() const { return static_cast<int>(mark_.times); }
  /// Step of the last time in the file; -1 if there is none.
  std::int64_t last_step() const { return mark_.step; }
  /// Notice about a file that could not be continued; usually empty.
  const std::string& notice() const { return notice_; }

  /// Variables that the last write() clipped for the first time; usually empty. The same on all ranks.
  const std::string& warning() const { return warning_; }
  const CutValues& cut_values() const { return cut_; }

  struct Field {
    enum class Kind { identity, integer, real };
    std::string name;
    Kind kind = Kind::real;
    Variable variable = Variable::count;
  };

 private:
  bool go_on(core::Reductions& ranks);
  void create(const core::Scene& scene);
  void add_step(const core::Clock& clock, std::int64_t particles);
  void write_fields(const core::Model& model, core::Reductions& ranks,
                    const std::vector<struct RowBatch>& batches);
  void name_step();

  Settings settings_;
  std::vector<Field> fields_;
  H5PartMark mark_;                        ///< without the file's size and other bytes; `head` on rank 0
  std::vector<H5PartMark::Rows> unnamed_;  ///< of the time being written
  std::string notice_, warning_;
  CutValues cut_;
};

}  // namespace mpm::io
