// Everything that a run writes while it goes on, each at its own interval of simulated time. What a scene
// does not ask for is not created.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"
#include "core/step/totals.hpp"
#include "io/output/h5part.hpp"
#include "io/output/history_file.hpp"
#include "io/output/log.hpp"
#include "io/output/status_file.hpp"
#include "io/output/vtu.hpp"

namespace mpm::apps {

/// Something that happens every so much simulated time, after the first step that reaches the mark.
class Interval {
 public:
  Interval() = default;
  Interval(double every, double now) : every_(every), marks_(passed(now)) {}
  bool due(double now) const { return every_ > 0 && passed(now) > marks_; }
  void done(double now) { marks_ = passed(now); }

 private:
  /// Marks up to `now`; a time that misses one by round-off has passed it.
  double passed(double now) const;
  double every_ = 0;
  double marks_ = 0;
};

/// Where a continued run's files are to be taken up.
struct Continuation {
  std::vector<std::uint64_t> tracked;        ///< particles that the histories follow
  std::map<std::string, std::string> marks;  ///< Outputs::marks() of the run that goes on
};

/// Of a run that goes on in another folder than its restart file's: files `<stem><ending>` that are not there
/// begin anew, and their marks go. True if there are any. Collective.
bool forget_what_is_elsewhere(const std::string& stem, Continuation& from, core::Reductions& ranks);

/// What the user should know about the log that is to go on, before it is opened; mostly nothing. On one
/// rank.
std::string log_notice(const std::string& path, const Continuation& from);

class Outputs {
 public:
  Outputs(const std::string& folder, const core::Model& model, core::Reductions& ranks,
          const std::optional<Continuation>& from, io::Log& log);

  /// After a step, or before the first one: whatever is due. Collective.
  void after_step(const core::Model& model, core::Reductions& ranks);
  /// The state's row in .sta and on the console, and what it was made from. Collective.
  const core::Totals& report(const core::Model& model, core::Reductions& ranks);
  bool report_due(const core::Model& model) const { return report_.due(model.clock.time); }
  /// At the end, the state if it is not yet in the files; everything to the disk. Collective.
  void finish(const core::Model& model, core::Reductions& ranks);

  /// All that has been written so far to the disk itself, and where each file stands, for a restart file:
  /// what a run that goes on does not write again is safe before the restart file counts. Collective.
  std::map<std::string, std::string> marks(core::Reductions& ranks);

  std::int64_t status_rows() const { return status_.rows_added(); }
  std::vector<std::uint64_t> tracked() const;
  double seconds() const { return seconds_; }
  /// Files for the eye, to be named at the end.
  std::vector<std::string> pictures() const;

 private:
  void write_pictures(const core::Model& model, core::Reductions& ranks);
  void open_pictures(const std::string& folder, const core::Model& model, core::Reductions& ranks,
                     const std::optional<Continuation>& from);
  void say_notices();

  std::string stem_;
  io::Log& log_;
  io::StatusFile status_;
  io::HistoryFile history_;
  std::optional<io::H5PartWriter> h5part_;
  std::optional<io::VtuWriter> vtu_;
  Interval report_, pictures_;
  core::Totals totals_;
  std::int64_t report_step_ = -1;
  double seconds_ = 0;
  double start_time_ = 0;
  double wall_start_ = 0;
  bool momentum_ = false;
};

}  // namespace mpm::apps
