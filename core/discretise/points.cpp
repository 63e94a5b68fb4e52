#include "core/discretise/points.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace mpm::core {

namespace {

constexpr std::size_t most_messages = 20;

Diagnostic at_line(const std::string& path, std::int64_t line, std::string message) {
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  return {path, static_cast<int>(std::min(line, most)), {}, {}, {}, std::move(message)};
}

/// An error in the file as a whole, located where the input names it.
InputErrors about_file(const std::string& path, const SourceLocation& body, std::string message) {
  return InputErrors({Diagnostic{body.file, body.line, "Geometry", "file", path, std::move(message)}});
}

PointFile open(const std::string& path, const SourceLocation& body) {
  try {
    return PointFile(path);
  } catch (const std::runtime_error& error) {
    throw about_file(path, body, fmt::format("the file of particles cannot be opened: {}", error.what()));
  }
}

}  // namespace

PointList::PointList(const Frame& frame, double density) : frame_(frame), density_(density) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  box_ = {{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}}};
}

void PointList::count(double mass, const Position& position) {
  const Position global = frame_.to_global(position);
  for (std::size_t d = 0; d < 3; ++d) {
    box_[0][d] = std::min(box_[0][d], global[d]);
    box_[1][d] = std::max(box_[1][d], global[d]);
  }
  mass_ += mass;
  ++count_;
}

Seed PointList::seed(double mass, const Position& position, std::uint64_t identity) const {
  return {frame_.to_global(position), mass, mass / density_, identity};
}

InlinePoints::InlinePoints(std::vector<PointMass> points, const Frame& frame, double density)
    : PointList(frame, density), points_(std::move(points)) {
  for (const PointMass& point : points_) count(point.mass, point.position);
}

void InlinePoints::generate(std::uint64_t first_unit, std::uint64_t last_unit, std::vector<Seed>& out) const {
  const std::uint64_t last = std::min(std::min(last_unit, units()) * points_per_unit, identities());
  for (std::uint64_t i = std::min(first_unit, units()) * points_per_unit; i < last; ++i)
    out.push_back(seed(points_[i].mass, points_[i].position, i));
}

FilePoints::FilePoints(const std::string& path, const SourceLocation& body, const Frame& frame,
                       double density)
    : PointList(frame, density), path_(path), file_(open(path, body)) {
  scan(body);
  if (identities() == 0)
    throw about_file(path, body, "the file contains no particles: expected lines of mass x y z");
}

void FilePoints::scan(const SourceLocation& body) {
  std::vector<Diagnostic> errors;
  std::size_t bad = 0;
  try {
    std::string_view line;
    while (file_.next(line)) {
      const ParsedLine parsed = parse_point_line(line);
      const auto& [mass, x, y, z] = parsed.values;
      if (parsed.kind == LineKind::wrong && ++bad <= most_messages)
        errors.push_back(at_line(path_, file_.place().number, parsed.message));
      if (parsed.kind != LineKind::point) continue;
      if (identities() % points_per_unit == 0) unit_starts_.push_back(file_.place());
      count(mass, Position{x, y, z});
    }
  } catch (const std::runtime_error& error) {
    errors.push_back(about_file(path_, body, error.what()).diagnostics().front());
  }
  if (bad > most_messages)
    errors.push_back(at_line(path_, 0, fmt::format("{} more lines are invalid", bad - most_messages)));
  if (!errors.empty()) throw InputErrors(std::move(errors));
}

void FilePoints::generate(std::uint64_t first_unit, std::uint64_t last_unit, std::vector<Seed>& out) const {
  last_unit = std::min(last_unit, units());
  if (first_unit >= last_unit) return;
  const std::lock_guard lock(mutex_);
  try {
    file_.seek(unit_starts_[first_unit]);
    append_lines(first_unit * points_per_unit, std::min(last_unit * points_per_unit, identities()), out);
  } catch (const std::runtime_error& error) {
    throw InputErrors(
        {at_line(path_, 0, fmt::format("the file changed while it was read: {}", error.what()))});
  }
}

void FilePoints::append_lines(std::uint64_t first, std::uint64_t last, std::vector<Seed>& out) const {
  std::string_view line;
  for (std::uint64_t i = first; i < last;) {
    if (!file_.next(line)) throw std::runtime_error("it is now shorter");
    const ParsedLine parsed = parse_point_line(line);
    if (parsed.kind == LineKind::wrong) throw std::runtime_error(parsed.message);
    if (parsed.kind == LineKind::blank) continue;
    const auto& [mass, x, y, z] = parsed.values;
    out.push_back(seed(mass, Position{x, y, z}, i++));
  }
}

}  // namespace mpm::core
