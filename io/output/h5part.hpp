// Job.h5part: all times in one HDF5 file, one group `Step#n` per time, one dataset per quantity (the H5Part
// schema: A. Adelmann et al., vis.lbl.gov/Research/AcceleratorSAPP). ParaView joins name_0, name_1, name_2 to
// a vector.
//
// Every group has the attributes TimeValue and step, and x, y, z, velocity_0..2 (reals), id (64-bit), body
// (32-bit) and the variables asked for. Rows are in the order of particle_order.hpp.
//
// A time is made in a group that readers do not look for, and gets its name when it is complete; until then
// nothing changes that the earlier times need. Limit: a kill within the few microseconds of the naming may
// still hurt. Shown by tests/io/output/h5part_test.cpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model.hpp"
#include "core/step/exchange.hpp"
#include "io/output/variables.hpp"

namespace mpm::io {

class H5PartWriter {
 public:
  struct Settings {
    std::string path;
    std::vector<Variable> variables;
    bool double_precision = false;
    /// Keep the times of an existing file up to this one and go on after them; start anew without.
    std::optional<double> continue_from;
  };
  /// Bodies without output are left out. Throws FileError. Collective.
  H5PartWriter(Settings settings, const core::Model& model, core::Exchange& exchange);

  /// One more time. Throws FileError; the earlier times stay readable. Collective.
  void write(const core::Model& model, core::Exchange& exchange);

  int times() const { return times_; }
  /// What the user should know about a file that could not be continued; mostly empty.
  const std::string& notice() const { return notice_; }

  struct Field {
    enum class Kind { identity, integer, real };
    std::string name;
    Kind kind = Kind::real;
    Variable variable = Variable::count;
  };

 private:
  int open_existing(double last);
  void create(const core::Scene& scene);
  void add_step(const core::Clock& clock, std::int64_t particles);
  void write_fields(const core::Model& model, core::Exchange& exchange,
                    const std::vector<struct RowBatch>& batches);
  void name_step();

  Settings settings_;
  std::vector<Field> fields_;
  int times_ = 0;
  std::string notice_;
};

}  // namespace mpm::io
