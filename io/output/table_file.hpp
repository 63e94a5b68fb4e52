// A text table that grows by one row at a time and continues after a restart: rows start with the step,
// comments with '#', and the last comment before the rows names the columns. Every restart file stores the
// table's mark. A restarted run truncates the table there and reports missing or changed rows. Limit: the
// comments have no checksum. Tested by tests/io/output/table_file_test.cpp.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <string_view>

#include "io/output/text_file.hpp"

namespace mpm::io {

/// State of a table: the step of its last row, its number of rows, and their checksum.
struct TableMark {
  std::int64_t step = -1;
  std::int64_t rows = 0;
  std::uint64_t checksum = 0;

  /// `row` excludes the newline.
  void add(std::int64_t row_step, std::string_view row);
  std::string text() const;
  /// Nullopt if the text is not a mark.
  static std::optional<TableMark> from(const std::string& text);
  /// Reads text().
  friend std::istream& operator>>(std::istream& in, TableMark& mark);
  friend bool operator==(const TableMark&, const TableMark&) = default;
};

/// Where a restarted run truncates a table.
struct TableContinuation {
  std::int64_t step = 0;
  std::optional<TableMark> mark;  ///< the table's mark in the restart file; without it nothing is checked
};

struct TableCut {
  bool append = false;  ///< else a new table is started
  TableMark kept;
  std::string notice;  ///< notice for the user; usually empty
};
/// Truncates the table after the last row with a step up to `from.step` among those that the mark counts. A
/// table without the line `head`, or without the comments `legend` before it, belongs to another run and is
/// renamed to `<path>.old`. On one rank. Throws FileError.
TableCut cut_table(const std::string& path, const std::string& legend, const std::string& head,
                   const TableContinuation& from);

class TableFile {
 public:
  /// Continues the table if possible, else starts it with `comments`, `legend` and `head`. Throws FileError.
  /// Collective.
  TableFile(const std::string& path, const std::string& comments, const std::string& legend,
            const std::string& head, const std::optional<TableContinuation>& from, core::Reductions& ranks);

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
