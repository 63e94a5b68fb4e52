#include "io/output/provenance.hpp"

#include <algorithm>
#include <ctime>
#include <map>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "core/version.hpp"

namespace mpm::io {

namespace {

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return text;
}

/// The start of a text of UTF-8, of whole characters.
std::string first_bytes(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0) == 0x80) --most;
  return text.substr(0, most);
}

}  // namespace

std::string git_text() { return std::string(core::git_hash) + (core::git_dirty ? "-dirty" : ""); }

ProvenanceLines provenance_of(const core::Scene& scene) {
  ProvenanceLines lines{
      {"program", "mpm_run"},
      {"version", std::string(core::version)},
      {"git", git_text()},
      {"build", fmt::format("{}, {}, {}, {} lanes", core::compiler, core::build_type, core::architecture,
                            core::simd_lanes)},
      {"job", scene.provenance.job_name},
      {"input", scene.provenance.path},
      {"input_hash", scene.provenance.hash},
      {"name", scene.header.name},
      {"heading", scene.header.heading},
      {"description", scene.header.description},
      {"time_unit", scene.header.time_unit},
      {"length_unit", scene.header.length_unit},
      {"mass_unit", scene.header.mass_unit},
      {"written", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
  };
  std::erase_if(lines, [](const auto& line) { return line.second.empty(); });
  for (auto& line : lines) line.second = one_line(line.second);
  return lines;
}

std::string to_text(const ProvenanceLines& lines, const std::string& prefix) {
  std::string text;
  for (const auto& [name, value] : lines) text += fmt::format("{}{}: {}\n", prefix, name, value);
  return text;
}

std::string to_xml_comment(const ProvenanceLines& lines) {
  std::string text = to_text(lines, "  ");
  // XML forbids two hyphens in a row in a comment.
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at))
    text[at + 1] = '_';
  return "<!--\n" + text + "-->\n";
}

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '&': out += "&amp;"; break;
      case '"': out += "&quot;"; break;
      default: out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
  }
  return out;
}

std::string safe_name(const std::string& name) {
  std::string out = name;
  for (char& c : out) {
    const auto u = static_cast<unsigned char>(c);
    if (u <= ' ' || u == 127 || std::string_view("/\\:*?\"<>|[]#,;").find(c) != std::string_view::npos)
      c = '_';
  }
  if (out.empty() || out.find_first_not_of('.') == std::string::npos) out = "_" + out;
  return out;
}

std::vector<std::string> distinct_names(const std::vector<std::string>& names, const std::string& kind,
                                        std::size_t most) {
  std::vector<std::string> distinct;
  std::map<std::string, int> times;
  for (const std::string& name : names) {
    distinct.push_back(safe_name(name));
    ++times[distinct.back()];
  }
  for (std::size_t i = 0; i < distinct.size(); ++i) {
    std::string& name = distinct[i];
    if (times.at(name) == 1 && name.size() <= most) continue;
    std::string ending = fmt::format("_{}{}", kind, i);
    std::string stem = name;
    if (most != std::string::npos) stem = first_bytes(stem, most - std::min(most, ending.size()));
    while (!times.emplace(stem + ending, 1).second) ending += '_';
    name = stem + ending;
  }
  return distinct;
}

}  // namespace mpm::io
