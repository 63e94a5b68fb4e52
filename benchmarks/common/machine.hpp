// The machine and the program that a measurement belongs to, for the head of every table and file.
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/setup/memory.hpp"
#include "core/version.hpp"

namespace mpm::benchmarks {

/// The first line of a file that starts with `key`, what follows its colon; empty if there is none.
inline std::string line_of(const char* path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const auto colon = line.find(':');
    const auto first = line.find_first_not_of(" \t", colon == std::string::npos ? key.size() : colon + 1);
    return first == std::string::npos ? "" : line.substr(first);
  }
  return "";
}

inline std::string first_line(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

using Facts = std::vector<std::pair<std::string, std::string>>;

inline Facts machine_facts() {
  const std::string model = line_of("/proc/cpuinfo", "model name");
  const std::string memory = line_of("/proc/meminfo", "MemTotal");
  std::string load, one, five, fifteen;
  std::istringstream(first_line("/proc/loadavg")) >> one >> five >> fifteen;
  load = fmt::format("{} {} {} (1, 5, 15 minutes; above 0 others were at work too)", one, five, fifteen);
  std::string git(core::git_hash);
  if (core::git_dirty) git += " with changes";
  return {
      {"processor", fmt::format("{}, {} cores seen", model.empty() ? "unknown" : model,
                                std::thread::hardware_concurrency())},
      {"memory", fmt::format("{:.1f} GiB, {:.1f} GiB free; huge pages: {}",
                             std::atof(memory.c_str()) / 1048576, core::available_memory() / 1073741824.0,
                             first_line("/sys/kernel/mm/transparent_hugepage/enabled"))},
      {"load", load},
      {"compiler", fmt::format("{}, {}", core::compiler, core::build_type)},
      {"flags", fmt::format("-march={}, {} SIMD lanes", core::architecture, core::simd_lanes)},
      {"version", fmt::format("{}, git {}", core::version, git)},
  };
}

inline std::string facts_as_text(const Facts& facts, const std::string& prefix) {
  std::string text;
  for (const auto& [name, value] : facts) text += fmt::format("{}{:<10} {}\n", prefix, name, value);
  return text;
}

}  // namespace mpm::benchmarks
