// The command line of mpm_run: the options of the manual (chapter 2) and those of this program.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mpm::apps {

struct RunOptions {
  std::string job;  ///< Job, Job.xmp or Job_<step>.pe
  std::string output_dir = ".";
  bool dry_run = false;                      ///< report what the run would need, and exit
  bool to_h5part = false;                    ///< -h5pt: convert a restart file and exit
  bool lsdyna = false;                       ///< -lsdyna
  std::optional<std::string> restart_input;  ///< -rt: another Grid, Solution, Output, Deactive
  std::optional<long> status_rows;           ///< -nsteps: stop after this many rows of the .sta file
  std::optional<double> max_wall_time;       ///< seconds; then a restart file is written
  std::vector<std::string> solver_options;   ///< after --: PETSc's, for implicit steps
};

/// Exit codes of the process.
enum ExitCode {
  done = 0,
  input_error = 2,
  numerical_failure = 3,
  stopped_early = 4,
  file_error = 5,
  out_of_resources = 6  ///< memory or threads
};

/// The options, or the exit code after help or wrong usage; printed on rank 0 only.
struct ParsedOptions {
  RunOptions options;
  std::optional<int> leave;
};
ParsedOptions parse_command_line(int argc, char** argv, bool speak);

}  // namespace mpm::apps
