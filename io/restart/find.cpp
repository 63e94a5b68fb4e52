#include <sstream>

#include <fmt/format.h>

#include "io/restart/files.hpp"
#include "io/restart/restart.hpp"

namespace mpm::io {

std::optional<std::string> find_newest_restart(const std::string& folder, const std::string& job,
                                               core::Reductions& ranks, std::vector<std::string>& notices) {
  std::string mine, others;
  if (ranks.rank() == 0) {
    const RestartFiles files = restart_files(folder, job);
    for (const std::string& path : files.paths) mine += path + '\n';
    for (const std::string& path : files.of_others) others += path + '\n';
  }
  std::istringstream paths(ranks.gather(mine).front());
  for (std::string path; std::getline(paths, path);) {
    try {
      verify_restart(path, ranks);
      return path;
    } catch (const FileError& e) { notices.push_back(fmt::format("skipped: {}", e.what())); }
  }
  std::istringstream foreign(ranks.gather(others).front());
  for (std::string path; std::getline(foreign, path);)
    notices.push_back(fmt::format("skipped: the restart file '{}' belongs to another job", path));
  return std::nullopt;
}

}  // namespace mpm::io
