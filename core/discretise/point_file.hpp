#pragma once
// Lines of a text file of particles, plain or gzipped: mass x y z, separated by blanks. Empty lines and text
// after # or ! are skipped. Reads in blocks, which are discarded after use.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct gzFile_s;

namespace mpm::core {

/// Position where a line starts.
struct LinePlace {
  std::int64_t offset = 0;  ///< in the unpacked text
  std::int64_t number = 1;  ///< of the line, from 1
};

class PointFile {
 public:
  /// Longest line accepted as a particle.
  static constexpr std::size_t longest_line = 4096;

  /// Throws std::runtime_error with the system's reason when the file cannot be opened.
  explicit PointFile(const std::string& path);

  /// The next line without its end; valid until the next call. False at the end of the file. Throws
  /// std::runtime_error on a read error, a damaged archive and lines that are too long.
  bool next(std::string_view& line);
  /// Start of the line returned last.
  const LinePlace& place() const { return place_; }
  /// Makes next() return the line at `place`. Going back in a gzipped file unpacks it from its start.
  void seek(const LinePlace& place);

 private:
  bool refill();

  struct Close {
    void operator()(gzFile_s* file) const;
  };
  std::unique_ptr<gzFile_s, Close> file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  ///< unread part of the buffer
  std::size_t end_ = 0;
  bool exhausted_ = false;
  LinePlace place_;
  LinePlace following_;
};

enum class LineKind { point, blank, wrong };

struct ParsedLine {
  LineKind kind = LineKind::blank;
  std::array<double, 4> values{};  ///< mass, x, y, z; finite, mass > 0
  std::string message;             ///< the error
};

ParsedLine parse_point_line(std::string_view line);

}  // namespace mpm::core
