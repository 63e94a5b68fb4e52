// The restart files of a job in a folder. On one rank.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mpm::io {

struct RestartFiles {
  /// Files that belong to the job by their contents, whatever their names, newest first; then the unreadable
  /// ones named `<job>_<step>.pe`.
  std::vector<std::string> paths;
  std::vector<std::string> of_others;  ///< named for this job, but belonging to another
};
RestartFiles restart_files(const std::string& folder, const std::string& job);

/// Time at which the newest readable file named `<job>_<step>.pe` was written, as in Guard::written; 0 if
/// there is none.
std::int64_t youngest(const std::string& folder, const std::string& job);

/// Removes all files `<job>_<step>.pe` of the job except the newest two, and incomplete files of an
/// interrupted run. Files that are unreadable or belong to another job are ignored and kept.
void remove_older(const std::string& folder, const std::string& job);

}  // namespace mpm::io
