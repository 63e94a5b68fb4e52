// The particles' rows of a restart file, read and checked by one rank in pieces of bounded memory.
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

  /// Reads the next records of `wanted`, in ascending order, from number `first` on: as many as fit into one
  /// piece. Their rows are contiguous in rows(). Returns the number of records.
  std::size_t read(const std::vector<std::size_t>& wanted, std::size_t first);
  const double* rows() const { return rows_.data(); }
  /// Throws FileError if the rows fail their checksums.
  void check(const TileRecord& record, const double* rows) const;

 private:
  std::string path_;
  const RestartContents& contents_;
  File file_;
  std::vector<std::uint64_t> first_byte_;  ///< of each record's rows
  std::vector<double> rows_;
};

/// f(record, its rows) for the records of these numbers, ascending. Throws FileError. On this rank only.
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
