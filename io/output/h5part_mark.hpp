// Where an .h5part file stood when a restart file was written: its length, the place and checksum of every
// dataset's rows, and a copy of all other bytes.
//
// With these a run that goes on makes the file what it was then, whatever came later: later times, half of
// one that a kill has left, or damage to what HDF5 needs to find its way, which might crash it. HDF5 sees the
// file only after that. A time's values are never copied; they are checked where that is cheap, and whenever
// bytes have changed that only another history of the file, or damage, can change. Shown by
// tests/io/output/h5part_test.cpp.
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
  std::uint64_t head = 0;   ///< bytes at the file's start in which every new time changes something
  std::uint64_t size = 0;   ///< of the file
  std::vector<Rows> rows;   ///< ascending
  std::string other_bytes;  ///< of the file, without those of `rows`

  std::string bytes() const;
  /// Nothing if the bytes are no mark's.
  static std::optional<H5PartMark> from(std::string_view bytes);

  /// Take over the file's size and other bytes. On one rank. Throws FileError.
  void copy_tables(const std::string& path);
};

/// Make the file what the mark says; what is wrong with the file if that cannot be, and then it is as it was.
/// The same on all ranks. Throws FileError if the file cannot be written. Collective.
std::string restore(const std::string& path, const H5PartMark& mark, core::Reductions& ranks);

/// Of rows that follow each other, the first of them number `first` of its dataset. The sum over the
/// stretches of a dataset is that of the dataset.
std::uint64_t checksum_of_rows(std::uint64_t first, std::span<const std::byte> rows, std::size_t row_bytes);
/// Sums over the ranks, in place. Collective.
void sum_checksums(std::span<std::uint64_t> checksums, core::Reductions& ranks);

}  // namespace mpm::io
