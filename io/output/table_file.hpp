// A text table that grows by one row at a time and goes on after a restart: rows start with the step,
// comments with '#', and the last comment before the rows names the columns.
//
// Every restart file carries the table's mark. A run that goes on cuts the table there and says what is not
// as it was: rows that are missing, or that have other bytes. Limit: the comments have no checksum. Shown by
// tests/io/output/table_file_test.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "io/output/text_file.hpp"

namespace mpm::io {

/// Where a table stood: its last row's step, its number of rows, and a checksum of them.
struct TableMark {
  std::int64_t step = -1;
  std::int64_t rows = 0;
  std::uint64_t checksum = 0;

  /// `row` is without the end of its line.
  void add(std::int64_t row_step, std::string_view row);
  std::string text() const;
  /// Nothing if the text is no mark's.
  static std::optional<TableMark> from(const std::string& text);
  friend bool operator==(const TableMark&, const TableMark&) = default;
};

/// Up to where a run that goes on keeps a table's rows.
struct TableContinuation {
  std::int64_t step = 0;
  std::optional<TableMark> mark;  ///< what the restart file says of the table; without, nothing is checked
};

struct TableCut {
  bool append = false;  ///< else the table begins anew
  TableMark kept;
  std::string notice;  ///< what the user should know; mostly empty
};
/// Cut the table after its last row of a step up to `from.step` among those that the mark counts. A table
/// without the line `head` is not of this run: it is renamed to `<path>.old`. On one rank. Throws FileError.
TableCut cut_table(const std::string& path, const std::string& head, const TableContinuation& from);

class TableFile {
 public:
  /// Continues the table if it can, else begins it with `comments` and `head`. Throws FileError. Collective.
  TableFile(const std::string& path, const std::string& comments, const std::string& head,
            const std::optional<TableContinuation>& from, core::Reductions& ranks);

  /// As TextFile::add().
  void add(std::int64_t step, const std::string& row) noexcept;
  /// As those of TextFile. Collective.
  void flush(core::Reductions& ranks) { file_->flush(ranks); }
  void sync(core::Reductions& ranks) { file_->sync(ranks); }

  const TableMark& mark() const { return mark_; }
  const std::string& notice() const { return notice_; }

 private:
  std::optional<TextFile> file_;
  TableMark mark_;
  std::string notice_;
};

}  // namespace mpm::io
