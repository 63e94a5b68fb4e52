// Particles from a text file: one line per particle, `mass x y z`, blanks between; plain or gzipped.
// Read as a stream, so that nobody holds the whole file.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/scene/geometry.hpp"

namespace mpm::io {

/// Why the file cannot be opened for reading ("no such file" ...), or an empty text.
std::string why_unreadable(const std::filesystem::path& file);

class PointFile {
 public:
  /// Throws core::InputErrors when the file cannot be opened.
  explicit PointFile(const std::filesystem::path& file);
  ~PointFile();
  PointFile(PointFile&&) noexcept;
  PointFile& operator=(PointFile&&) noexcept;

  /// The next particle; false at the end. Empty lines and lines that start with # are passed over.
  /// Throws core::InputErrors with file and line on anything but four numbers, or a mass that is not
  /// positive.
  bool next(core::PointMass& point);

 private:
  struct Stream;
  bool next_line(std::string_view& line);
  [[noreturn]] void fail(const std::string& message) const;

  std::unique_ptr<Stream> stream_;
};

}  // namespace mpm::io
