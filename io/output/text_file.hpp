// A text file that grows by lines, on rank 0; the other ranks hold nothing.
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
  /// Opens the file on rank 0, anew or after what it holds. Throws FileError. Collective.
  TextFile(const std::string& path, bool append, core::Reductions& ranks);
  ~TextFile();
  TextFile(TextFile&&) = default;

  /// Waits in memory until there is enough of it. Does nothing on other ranks than 0, and never fails: a full
  /// disk is told by the next flush().
  void add(std::string_view text) noexcept;
  /// Hand what waits to the system.
  void write_out() noexcept;
  /// Throws FileError if anything could not be written since the file was opened. Collective.
  void flush(core::Reductions& ranks);
  /// As flush(), and to the disk itself. Collective.
  void sync(core::Reductions& ranks);
  /// What the file holds; 0 on other ranks than 0.
  std::uint64_t bytes() const { return file_ ? file_->size() : 0; }

 private:
  std::unique_ptr<File> file_;
  std::string waiting_;
  std::string fault_;
};

}  // namespace mpm::io
