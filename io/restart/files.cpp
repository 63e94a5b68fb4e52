#include "io/restart/files.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "io/output/file.hpp"
#include "io/restart/guard.hpp"
#include "io/restart/restart.hpp"

namespace mpm::io {

namespace {

constexpr std::size_t files_kept = 2;
constexpr std::string_view extension = ".pe";

bool all_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Whether the name reads `<job>_<digits><ending>`.
bool is_named_for(std::string_view name, const std::string& job, std::string_view ending) {
  const std::string start = job + "_";
  return name.size() > start.size() + ending.size() && name.starts_with(start) && name.ends_with(ending) &&
         all_digits(name.substr(start.size(), name.size() - start.size() - ending.size()));
}

/// The file names in the folder that end so.
std::vector<std::string> names(const std::string& folder, std::string_view ending) {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(ending)) found.push_back(name);
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string in_folder(const std::string& folder, const std::string& name) {
  return folder.empty() ? name : folder + "/" + name;
}

/// Times at which the restart files named for the job were written, newest first; without files of other jobs
/// and unreadable ones.
std::vector<std::pair<std::int64_t, std::string>> readable(const std::string& folder,
                                                           const std::string& job) {
  std::vector<std::pair<std::int64_t, std::string>> files;
  for (const std::string& name : names(folder, extension)) {
    if (!is_named_for(name, job, extension)) continue;
    const std::string path = in_folder(folder, name);
    try {
      const Guard guard = read_guard(path);
      if (guard.job == 0 || guard.job == job_hash(job)) files.emplace_back(guard.written, path);
    } catch (const FileError&) {}  // ignored
  }
  std::stable_sort(files.begin(), files.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  return files;
}

}  // namespace

std::string restart_path(const std::string& folder, const std::string& job, std::int64_t step) {
  return in_folder(folder, fmt::format("{}_{}{}", job, step, extension));
}

std::string job_of_restart(const std::string& path) {
  const std::string stem = std::filesystem::path(path).stem().string();
  const std::size_t at = stem.rfind('_');
  if (at == std::string::npos || at == 0 || !all_digits(std::string_view(stem).substr(at + 1))) return stem;
  return stem.substr(0, at);
}

RestartFiles restart_files(const std::string& folder, const std::string& job) {
  constexpr std::int64_t unreadable = std::numeric_limits<std::int64_t>::min();
  std::vector<std::pair<std::int64_t, std::string>> files;
  RestartFiles found;
  for (const std::string& name : names(folder, extension)) {
    const std::string path = in_folder(folder, name);
    const bool named = is_named_for(name, job, extension);
    try {
      const Guard guard = read_guard(path);
      if (guard.job == job_hash(job) || (guard.job == 0 && named)) {
        files.emplace_back(guard.written, path);
      } else if (named) {
        found.of_others.push_back(path);
      }
    } catch (const FileError&) {
      if (named) files.emplace_back(unreadable, path);
    }
  }
  std::stable_sort(files.begin(), files.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& file : files) found.paths.push_back(file.second);
  return found;
}

std::int64_t youngest(const std::string& folder, const std::string& job) {
  const auto files = readable(folder, job);
  return files.empty() ? 0 : std::max<std::int64_t>(0, files.front().first);
}

std::vector<std::string> set_aside_superseded(const std::string& folder, const std::string& job,
                                              const std::optional<std::string>& start) {
  const std::int64_t last = start ? read_guard(*start).written : std::numeric_limits<std::int64_t>::min();
  std::vector<std::string> set_aside;
  for (const auto& [written, path] : readable(folder, job)) {
    if (written <= last) continue;
    set_aside.push_back(path + ".superseded");
    std::error_code error;
    std::filesystem::rename(path, set_aside.back(), error);
    if (error) throw FileError("cannot rename " + path + " to " + set_aside.back() + ": " + error.message());
  }
  return set_aside;
}

void remove_older(const std::string& folder, const std::string& job) {
  const auto files = readable(folder, job);
  for (std::size_t i = files_kept; i < files.size(); ++i) remove_file(files[i].second);
  const std::string part = part_name(std::string(extension));
  for (const std::string& name : names(folder, part)) {
    if (is_named_for(name, job, part)) remove_file(in_folder(folder, name));
  }
}

}  // namespace mpm::io
