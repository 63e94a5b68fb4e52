// The command line of mpm_run: the manual's options (chapter 2) under their own spellings, and this
// project's.
#pragma once

#include <optional>
#include <string>

namespace mpm::apps {

struct RunOptions {
  std::string job;  ///< Job, Job.xmp or Job_<step>.pe
  std::string output_dir = ".";
  bool dry_run = false;                      ///< report what the run would need, and leave
  bool to_h5part = false;                    ///< -h5pt: convert a restart file and leave
  bool lsdyna = false;                       ///< -lsdyna
  std::optional<std::string> restart_input;  ///< -rt: another Grid, Solution, Output, Deactive
  std::optional<long> status_rows;           ///< -nsteps: stop after so many rows of the .sta file
  std::optional<double> max_wall_time;       ///< seconds; then a restart file is written
};

/// What the process returns to the shell.
enum ExitCode {
  done = 0,
  input_error = 2,
  numerical_failure = 3,
  stopped_early = 4,
  file_error = 5,
  out_of_resources = 6  ///< memory or threads
};

/// The options, or the code with which to leave at once (help asked for, or wrong usage; said on rank 0
/// only).
struct ParsedOptions {
  RunOptions options;
  std::optional<int> leave;
};
ParsedOptions parse_command_line(int argc, char** argv, bool speak);

}  // namespace mpm::apps
