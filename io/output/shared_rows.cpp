#include "io/output/shared_rows.hpp"

#include <optional>

#include <fmt/format.h>

namespace mpm::io {

namespace {

constexpr const char* remedy =
    "see whether the disk is full, its quota used up, or the size of files limited";

void write(const std::string& path, std::span<const SharedRows> datasets, core::Exchange& exchange) {
  const std::string doing = fmt::format("write '{}' ({})", path, remedy);
  std::vector<std::byte> memory;
  std::optional<hdf5::Handle> file;
  together(exchange, [&] { file = hdf5::open_file_together(path, exchange); });
  for (const SharedRows& rows : datasets) {
    std::optional<hdf5::Handle> dataset;
    together(exchange, [&] { dataset = hdf5::open_dataset(*file, rows.dataset); });
    for (const RowBatch& batch : rows.batches) {
      memory.resize(batch.particles * rows.bytes);
      rows.fill(batch, memory.data());
      // All leave here if one must: nobody waits for it at the next batch.
      together(exchange, [&] {
        hdf5::write_rows(*dataset, rows.memory_type, batch.rows, memory.data(), exchange.size() > 1, doing);
      });
    }
  }
  together(exchange, [&] { file->close(doing); });
}

void check(const std::string& path, std::span<const SharedRows> datasets) {
  const hdf5::Handle file = hdf5::open_file(path, hdf5::Access::read);
  std::vector<std::byte> expected, found;
  for (const SharedRows& rows : datasets) {
    const hdf5::Handle dataset = hdf5::open_dataset(file, rows.dataset);
    for (const RowBatch& batch : rows.batches) {
      expected.resize(batch.particles * rows.bytes);
      rows.fill(batch, expected.data());
      found.resize(expected.size());
      hdf5::read_rows(dataset, rows.memory_type, batch.rows, found.data());
      if (found != expected) {
        throw FileError(fmt::format(
            "cannot write '{}' ({}): what was written to '{}' does not read back the same, and no error was "
            "reported",
            path, remedy, rows.dataset));
      }
    }
  }
}

}  // namespace

void write_together(const std::string& path, std::span<const SharedRows> datasets, core::Exchange& exchange) {
  write(path, datasets, exchange);
  if (exchange.size() > 1) together(exchange, [&] { check(path, datasets); });
}

}  // namespace mpm::io
