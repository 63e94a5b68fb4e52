// Datasets that all ranks write together, each with the rows of its own particles.
// One rank creates them (hdf5::create_dataset) and reserves their space; every rank then writes its rows at
// their offsets by system calls. Collective writes of HDF5 use MPI-IO, which may truncate a write without an
// error, or leave a rank waiting forever for one whose write failed (both occur with Open MPI 4.1). Data
// written by several ranks is read back and compared, since a distributed file system may lose adjacent
// writes from different machines. Tested by tests/parallel/files.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"
#include "io/output/file.hpp"
#include "io/output/row_batches.hpp"

namespace mpm::io {

/// This rank's rows of one dataset.
struct SharedRows {
  std::string dataset;  ///< its path within the file
  std::size_t bytes;    ///< of a row, in the file as in memory
  std::span<const RowBatch> batches;
  /// Copies the rows of a batch into memory; repeated calls give the same rows.
  std::function<void(const RowBatch&, std::byte*)> fill;
  /// Optional: this rank's share of the dataset's checksum_of_rows() is added to it.
  std::uint64_t* checksum = nullptr;
};

/// Offsets of the datasets in the file. Throws FileError on every rank if it fails on any. Collective.
std::vector<Extent> write_together(const std::string& path, std::span<const SharedRows> datasets,
                                   core::Reductions& ranks);

}  // namespace mpm::io
