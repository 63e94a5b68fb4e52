// A text file that grows by lines, on rank 0; the other ranks do nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/communication/reductions.hpp"
#include "io/output/file.hpp"

namespace mpm::io {

class TextFile {
 public:
  /// Opens the file on rank 0, empty or for appending. Throws FileError. Collective.
  TextFile(const std::string& path, bool append, core::Reductions& ranks);
  ~TextFile();
  TextFile(TextFile&&) = default;

  /// Adds text to a buffer. Does nothing on ranks other than 0, and never fails: the next flush() reports a
  /// full disk.
  void add(std::string_view text) noexcept;
  /// Writes the buffer to the system.
  void write_out() noexcept;
  /// Throws FileError if anything could not be written since the file was opened. Collective.
  void flush(core::Reductions& ranks);
  /// As flush(), and syncs to disk. Collective.
  void sync(core::Reductions& ranks);
  /// Size of the file in bytes; 0 on ranks other than 0.
  std::uint64_t bytes() const { return file_ ? file_->size() : 0; }

 private:
  std::unique_ptr<File> file_;
  std::string waiting_;
  std::string fault_;
};

}  // namespace mpm::io
