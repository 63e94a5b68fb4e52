// Datasets that all ranks fill together, each with its own particles' rows.
//
// One rank has made them (hdf5::create_dataset) and their space is reserved. What several ranks have written
// is read back and compared before it counts: MPI's parallel writing may cut a write short without an error
// (Open MPI 4.1 does where a limit or a quota is met in the middle of one). Shown by
// tests/parallel/files.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/step/exchange.hpp"
#include "io/output/row_batches.hpp"

namespace mpm::io {

/// This rank's rows of one dataset.
struct SharedRows {
  std::string dataset;  ///< its path within the file
  hid_t memory_type;
  std::size_t bytes;                  ///< of a row in memory
  std::span<const RowBatch> batches;  ///< as many on every rank
  /// Puts the rows of a batch into memory, the same ones each time.
  std::function<void(const RowBatch&, std::byte*)> fill;
};

/// Every rank gives the same datasets, in the same order. Throws FileError on every rank. Collective.
void write_together(const std::string& path, std::span<const SharedRows> datasets, core::Exchange& exchange);

}  // namespace mpm::io
