// The restart files of a job in a folder. On one rank.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mpm::io {

struct RestartFiles {
  /// Of the job by what is in them, whatever their names, the one that was written last first; at the end
  /// those named `<job>_<step>.pe` that cannot be read.
  std::vector<std::string> paths;
  std::vector<std::string> of_others;  ///< named for this job, but of another
};
RestartFiles restart_files(const std::string& folder, const std::string& job);

/// When the youngest readable one named `<job>_<step>.pe` was written, as in Guard::written; 0 if there is
/// none.
std::int64_t youngest(const std::string& folder, const std::string& job);

/// Remove all files `<job>_<step>.pe` of the job but the two that were written last, and what an interrupted
/// run left half written. A file that cannot be read, or is of another job, counts as none and stays.
void remove_older(const std::string& folder, const std::string& job);

}  // namespace mpm::io
