// The restart files of a job in a folder. On one rank.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mpm::io {

/// Files `<job>_<step>.pe`, the one that was written last first; those whose guard cannot be read come at the
/// end.
std::vector<std::string> restart_files(const std::string& folder, const std::string& job);

/// When the youngest readable one was written, as in Guard::written; 0 if there is none.
std::int64_t youngest(const std::string& folder, const std::string& job);

/// Remove all restart files of the job but the two that were written last, and what an interrupted run left
/// half written. A file that cannot be read counts as none and stays.
void remove_older(const std::string& folder, const std::string& job);

}  // namespace mpm::io
