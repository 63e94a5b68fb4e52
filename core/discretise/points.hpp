#pragma once
// Particles given individually. Positions are in the body's work plane; a particle's volume is its mass over
// the body's density. Every rank reads every line of a file, because a gzipped one has no random access, but
// keeps only the particles of its units.

#include <cstdint>
#include <mutex>
#include <vector>

#include "core/discretise/frame.hpp"
#include "core/discretise/point_file.hpp"
#include "core/discretise/seeds.hpp"

namespace mpm::core {

/// Common part of both kinds: a list of known length and total, in units of points_per_unit.
class PointList : public SeedSource {
 public:
  static constexpr std::uint64_t points_per_unit = 4096;

  std::uint64_t units() const final { return (count_ + points_per_unit - 1) / points_per_unit; }
  std::uint64_t identities() const final { return count_; }
  double expected_particles() const final { return static_cast<double>(count_); }
  Box bounds() const final { return box_; }
  double solid_volume() const final { return mass_ / density_; }

 protected:
  PointList(const Frame& frame, double density);
  /// Counts one more point, in the local frame.
  void count(double mass, const Position& position);
  Seed seed(double mass, const Position& position, std::uint64_t identity) const;

 private:
  Frame frame_;
  double density_;
  std::uint64_t count_ = 0;
  double mass_ = 0;
  Box box_;
};

class InlinePoints final : public PointList {
 public:
  InlinePoints(std::vector<PointMass> points, const Frame& frame, double density);
  void generate(std::uint64_t first_unit, std::uint64_t last_unit, std::vector<Seed>& out) const override;

 private:
  std::vector<PointMass> points_;
};

class FilePoints final : public PointList {
 public:
  /// Reads the whole file and throws InputErrors with its first twenty bad lines. `body` is where the input
  /// names the file.
  FilePoints(const std::string& path, const SourceLocation& body, const Frame& frame, double density);
  /// Fastest when called with ascending units. Throws InputErrors when the file changed since it was counted.
  void generate(std::uint64_t first_unit, std::uint64_t last_unit, std::vector<Seed>& out) const override;

 private:
  void scan(const SourceLocation& body);
  void append_lines(std::uint64_t first, std::uint64_t last, std::vector<Seed>& out) const;

  std::string path_;
  std::vector<LinePlace> unit_starts_;
  mutable std::mutex mutex_;  ///< guards file_
  mutable PointFile file_;
};

}  // namespace mpm::core
