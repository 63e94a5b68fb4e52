// The particles' rows of a restart file, read by one rank in pieces of bounded memory and checked on the way.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/output/file.hpp"
#include "io/restart/contents.hpp"

namespace mpm::io {

class RowReader {
 public:
  RowReader(const std::string& path, const RestartContents& contents);

  /// The next records of `wanted`, which ascends, from number `first` on: as many as fit into the memory of a
  /// piece. Their rows follow each other in rows(). Returns the number of records.
  std::size_t read(const std::vector<std::size_t>& wanted, std::size_t first);
  const double* rows() const { return rows_.data(); }
  /// Throws FileError unless the rows are as they were written.
  void check(const TileRecord& record, const double* rows) const;

 private:
  std::string path_;
  const RestartContents& contents_;
  File file_;
  std::vector<std::uint64_t> first_byte_;  ///< of each record's rows
  std::vector<double> rows_;
};

/// f(record, its rows) for the records of these numbers, ascending. Throws FileError. On this rank alone.
template <class F>
void for_each_record(const std::string& path, const RestartContents& contents,
                     const std::vector<std::size_t>& wanted, F f) {
  if (wanted.empty()) return;
  RowReader reader(path, contents);
  for (std::size_t first = 0; first < wanted.size();) {
    const std::size_t n = reader.read(wanted, first);
    const double* rows = reader.rows();
    for (std::size_t i = first; i < first + n; ++i) {
      const TileRecord& record = contents.tiles[wanted[i]];
      reader.check(record, rows);
      f(record, rows);
      rows += record.particles * contents.bodies[static_cast<std::size_t>(record.body)].columns.size();
    }
    first += n;
  }
}

}  // namespace mpm::io
