#include "io/output/table_file.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "io/output/hash.hpp"

namespace mpm::io {

namespace {

/// The number at the start of a row, if any.
std::optional<std::int64_t> step_of(std::string_view row) {
  const std::size_t start = row.find_first_not_of(' ');
  if (start == std::string_view::npos) return {};
  std::int64_t step = 0;
  const auto [end, error] = std::from_chars(row.data() + start, row.data() + row.size(), step);
  const bool whole = end == row.data() + row.size() || *end == ' ';
  return error == std::errc() && whole && step >= 0 ? std::optional(step) : std::nullopt;
}

/// Contents of a table up to the point of continuation.
struct Found {
  bool head = false;
  bool legend = false;
  bool empty = true;
  TableMark all;  ///< of the rows that were read
  TableMark kept;
  std::uint64_t bytes = 0;  ///< up to the end of the last row kept
};

Found look_at(const std::string& path, const std::string& legend, const std::string& head,
              const TableContinuation& from) {
  Found found;
  std::ifstream in(path, std::ios::binary);
  std::string line, comments;
  std::uint64_t end = 0;
  while (std::getline(in, line) &&
         !in.eof()) {  // a line without a newline at the end of the file is incomplete
    found.empty = false;
    end += line.size() + 1;
    if (!found.head) {
      found.head = line == head;
      found.legend = found.head && comments.find(legend) != std::string::npos;
      if (found.head && !found.legend) break;
      if (line.starts_with('#')) comments += line + '\n';
      found.bytes = end;
      continue;
    }
    if (from.mark && found.all.rows == from.mark->rows) break;
    const std::optional<std::int64_t> step = step_of(line);
    if (!from.mark && (!step || *step > from.step)) break;
    found.all.add(step.value_or(found.all.step), line);
    if (!step || *step > from.step || (from.mark && *step > from.mark->step)) continue;
    found.kept = found.all;
    found.bytes = end;
  }
  return found;
}

std::string rows_in_words(const TableMark& mark) {
  return mark.rows == 0 ? "no rows" : fmt::format("{} row(s) up to step {}", mark.rows, mark.step);
}

/// Differences from the mark.
std::string difference(const std::string& path, const Found& found, const TableContinuation& from) {
  if (!from.mark || found.all == *from.mark) return {};
  const TableMark& expected = *from.mark;
  // A run with no steps left was killed between removing its last row and writing it again.
  const bool last_row_follows = from.step < expected.step && found.all.step <= from.step;
  if (last_row_follows && found.all.rows + 1 == expected.rows) return {};
  if (found.all.rows < expected.rows) {
    return fmt::format("'{}' has {}, but had {} when the restart file was written: the missing part is lost",
                       path, rows_in_words(found.all), rows_in_words(expected));
  }
  return fmt::format(
      "'{}' has been changed: its first {} do not match the checksum in the restart file; the last row kept "
      "is that of step {}, but step {} was expected",
      path, rows_in_words(expected), found.kept.step, std::min(expected.step, from.step));
}

}  // namespace

void TableMark::add(std::int64_t row_step, std::string_view row) {
  Hash hash;
  hash.add(checksum);
  hash.add(row);
  *this = {row_step, rows + 1, hash.value()};
}

std::string TableMark::text() const { return fmt::format("{} {} {}", step, rows, checksum); }

std::istream& operator>>(std::istream& in, TableMark& mark) {
  return in >> mark.step >> mark.rows >> mark.checksum;
}

std::optional<TableMark> TableMark::from(const std::string& text) {
  TableMark mark;
  std::istringstream words(text);
  return words >> mark ? std::optional(mark) : std::nullopt;
}

TableCut cut_table(const std::string& path, const std::string& legend, const std::string& head,
                   const TableContinuation& from) {
  TableCut cut;
  const std::string lost =
      from.mark && from.mark->rows > 0 ? "; it had " + rows_in_words(*from.mark) : std::string();
  if (!std::filesystem::exists(path)) {
    if (!lost.empty()) cut.notice = fmt::format("'{}' is missing{}: a new file is started", path, lost);
    return cut;
  }
  const Found found = look_at(path, legend, head, from);
  if (!found.legend) {
    if (found.empty) {
      if (!lost.empty()) cut.notice = fmt::format("'{}' is empty{}: a new file is started", path, lost);
      return cut;
    }
    rename_file(path, path + ".old");
    cut.notice = fmt::format(
        "'{0}' does not have this run's {1}: it has been renamed to '{0}.old', and a new file is started",
        path, found.head ? "points and particles" : "columns");
    return cut;
  }
  cut.append = true;
  cut.kept = found.kept;
  cut.notice = difference(path, found, from);
  File(path, File::Mode::change).truncate(found.bytes);
  return cut;
}

TableFile::TableFile(const std::string& path, const std::string& comments, const std::string& legend,
                     const std::string& head, const std::optional<TableContinuation>& from,
                     core::Reductions& ranks) {
  TableCut cut;
  together(ranks, [&] {
    if (ranks.rank() == 0 && from) cut = cut_table(path, legend, head, *from);
  });
  mark_ = cut.kept;
  notice_ = cut.notice;
  file_.emplace(path, cut.append, ranks);
  if (!cut.append) file_->add(comments + legend + head + '\n');
  file_->flush(ranks);
}

void TableFile::add(std::int64_t step, const std::string& row) noexcept {
  mark_.add(step, row);
  file_->add(row + '\n');
}

}  // namespace mpm::io
