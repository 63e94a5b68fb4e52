// Datasets that all ranks fill together, each with its own particles' rows.
//
// One rank has made them (hdf5::create_dataset) and reserved their space; every rank then writes to where its
// rows lie with the system's own calls. HDF5's collective writing would go through MPI's, which may cut a
// write short without an error, or let a rank wait for ever for one whose write failed (Open MPI 4.1 does
// either).
//
// What several ranks wrote is read back before it counts: a file system of several machines may lose what two
// of them write next to each other. Shown by tests/parallel/files.cpp.
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
  /// Puts the rows of a batch into memory, the same ones each time.
  std::function<void(const RowBatch&, std::byte*)> fill;
  /// This rank's share of the dataset's checksum_of_rows() is added to it, where there is one.
  std::uint64_t* checksum = nullptr;
};

/// Where the datasets are in the file. Throws FileError on every rank if it fails on any. Collective.
std::vector<Extent> write_together(const std::string& path, std::span<const SharedRows> datasets,
                                   core::Reductions& ranks);

}  // namespace mpm::io
