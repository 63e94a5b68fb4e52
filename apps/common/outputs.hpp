// All output of a run, each kind at its own interval of simulated time. Output that the scene does not
// request is not created.
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

/// A periodic event in simulated time, due after the first step that reaches its mark.
class Interval {
 public:
  Interval() = default;
  Interval(double every, double now) : every_(every), marks_(passed(now)) {}
  bool due(double now) const { return every_ > 0 && passed(now) > marks_; }
  void done(double now) { marks_ = passed(now); }

 private:
  /// Marks up to `now`, within round-off.
  double passed(double now) const;
  double every_ = 0;
  double marks_ = 0;
};

/// Where a restarted run continues its files.
struct Continuation {
  std::vector<std::uint64_t> tracked;        ///< particles tracked by histories
  std::map<std::string, std::string> marks;  ///< Outputs::marks() of the original run
};

/// For a run that continues in another folder than its restart file's: removes the marks of files
/// `<stem><ending>` that do not exist there, so that new ones are started. True if there are any. Collective.
bool forget_what_is_elsewhere(const std::string& stem, Continuation& from, core::Reductions& ranks);

/// Notice for the user about the log to be continued, before it is opened; usually empty. On one rank.
std::string log_notice(const std::string& path, const Continuation& from);

class Outputs {
 public:
  Outputs(const std::string& folder, const core::Model& model, core::Reductions& ranks,
          const std::optional<Continuation>& from, io::Log& log);

  /// Writes whatever is due, after a step or before the first one. Collective.
  void after_step(const core::Model& model, core::Reductions& ranks);
  /// Writes the state's row to .sta and the console; returns its totals. Collective.
  const core::Totals& report(const core::Model& model, core::Reductions& ranks);
  bool report_due(const core::Model& model) const { return report_.due(model.clock.time); }
  /// At the end: writes the state if it is not yet in the files, and syncs everything to disk. Collective.
  void finish(const core::Model& model, core::Reductions& ranks);

  /// Syncs all output to disk and returns the mark of each file for a restart file: output that a restarted
  /// run does not write again must be on disk before the restart file becomes valid. Collective.
  std::map<std::string, std::string> marks(core::Reductions& ranks);

  std::int64_t status_rows() const { return status_.rows_added(); }
  std::vector<std::uint64_t> tracked() const;
  double seconds() const { return seconds_; }
  /// Files to open in a viewer, listed at the end of the log.
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
