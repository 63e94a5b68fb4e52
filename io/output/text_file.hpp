// A text file that grows by lines, on rank 0; the other ranks hold nothing.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/step/exchange.hpp"
#include "io/output/file.hpp"

namespace mpm::io {

class TextFile {
 public:
  /// Opens the file on rank 0, anew or after what it holds. Throws FileError. Collective.
  TextFile(const std::string& path, bool append, core::Exchange& exchange);
  ~TextFile();
  TextFile(TextFile&&) = default;

  /// Waits in memory until there is enough of it. Does nothing on other ranks than 0, and never fails: a full
  /// disk is told by the next flush().
  void add(std::string_view text) noexcept;
  /// Hand what waits to the system.
  void write_out() noexcept;
  /// Throws FileError if anything could not be written since the file was opened. Collective.
  void flush(core::Exchange& exchange);

 private:
  std::unique_ptr<File> file_;
  std::string waiting_;
  std::string complaint_;
};

/// Cut a table, whose rows start with the step and whose other lines start with '#', after the last whole row
/// of a step up to `last_step`. The last '#' line before the rows must be `head`, else the table is not of
/// this run: it is renamed to `<path>.old` and false is returned. False, too, if there is no such file. On
/// one rank.
bool cut_table(const std::string& path, const std::string& head, std::int64_t last_step);

}  // namespace mpm::io
