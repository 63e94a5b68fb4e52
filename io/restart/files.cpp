#include "io/restart/files.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>

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

/// The file names in the folder that read `<job>_<digits><ending>`.
std::vector<std::string> names(const std::string& folder, const std::string& job, std::string_view ending) {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder, error)) {
    const std::string name = entry.path().filename().string();
    const std::string start = job + "_";
    if (name.size() <= start.size() + ending.size() || !name.starts_with(start) || !name.ends_with(ending))
      continue;
    if (all_digits(std::string_view(name).substr(start.size(), name.size() - start.size() - ending.size()))) {
      found.push_back(name);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string in_folder(const std::string& folder, const std::string& name) {
  return folder.empty() ? name : folder + "/" + name;
}

constexpr std::int64_t unreadable = std::numeric_limits<std::int64_t>::min();

std::int64_t time_written(const std::string& path) {
  try {
    return read_guard(path).written;
  } catch (const FileError&) { return unreadable; }
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

std::vector<std::string> restart_files(const std::string& folder, const std::string& job) {
  std::vector<std::pair<std::int64_t, std::string>> files;
  for (const std::string& name : names(folder, job, extension)) {
    const std::string path = in_folder(folder, name);
    files.emplace_back(time_written(path), path);
  }
  std::stable_sort(files.begin(), files.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> paths;
  for (const auto& file : files) paths.push_back(file.second);
  return paths;
}

std::int64_t youngest(const std::string& folder, const std::string& job) {
  const std::vector<std::string> paths = restart_files(folder, job);
  return paths.empty() ? 0 : std::max<std::int64_t>(0, time_written(paths.front()));
}

void remove_older(const std::string& folder, const std::string& job) {
  const std::vector<std::string> paths = restart_files(folder, job);
  for (std::size_t i = files_kept; i < paths.size(); ++i) {
    if (time_written(paths[i]) != unreadable) remove_file(paths[i]);
  }
  for (const std::string& name : names(folder, job, part_name(std::string(extension)))) {
    remove_file(in_folder(folder, name));
  }
}

}  // namespace mpm::io
