// State of an .h5part file when a restart file was written: its length, the offset and checksum of every
// dataset's rows, and a copy of all other bytes. A restarted run uses it to restore the file: it removes
// later times, incomplete times after a kill, and damage to HDF5's metadata, which might crash HDF5. HDF5
// opens the file only afterwards. Values are never copied; they are checked where that is cheap, and whenever
// bytes have changed that regular writing does not change. Tested by tests/io/output/h5part_test.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "io/output/file.hpp"

namespace mpm::io {

struct H5PartMark {
  struct Rows {
    Extent extent;
    std::uint64_t row_bytes = 0;
    std::uint64_t checksum = 0;  ///< checksum_of_rows(), of all of them
  };
  std::int64_t times = 0;
  std::int64_t step = -1;   ///< of the last time
  std::uint64_t head = 0;   ///< bytes at the start of the file that every new time changes
  std::uint64_t size = 0;   ///< of the file
  std::vector<Rows> rows;   ///< ascending
  std::string other_bytes;  ///< of the file, without those of `rows`

  std::string bytes() const;
  /// Nullopt if the bytes are not a mark.
  static std::optional<H5PartMark> from(std::string_view bytes);

  /// Reads the file's size and other bytes. On one rank. Throws FileError.
  void copy_tables(const std::string& path);
};

/// Restores the file to the mark; if that is impossible, leaves it unchanged and returns the fault. The same
/// on all ranks. Throws FileError if the file cannot be written. Collective.
std::string restore(const std::string& path, const H5PartMark& mark, core::Reductions& ranks);

/// Checksum of consecutive rows, the first being row `first` of the dataset. The sum over the stretches of a
/// dataset is the checksum of the dataset.
std::uint64_t checksum_of_rows(std::uint64_t first, std::span<const std::byte> rows, std::size_t row_bytes);
/// Sums over the ranks, in place. Collective.
void sum_checksums(std::span<std::uint64_t> checksums, core::Reductions& ranks);

}  // namespace mpm::io
