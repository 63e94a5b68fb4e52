#include "io/output/shared_rows.hpp"

#include <bit>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include "io/output/file.hpp"
#include "io/output/h5part_mark.hpp"
#include "io/output/hdf5.hpp"

namespace mpm::io {

namespace {

static_assert(std::endian::native == std::endian::little, "rows are written in memory order");

std::vector<Extent> extents_of(const std::string& path, std::span<const SharedRows> datasets) {
  const hdf5::Handle file = hdf5::open_file(path, hdf5::Access::read);
  std::vector<Extent> extents;
  for (const SharedRows& rows : datasets)
    extents.push_back(hdf5::extent_of(hdf5::open_dataset(file, rows.dataset)));
  return extents;
}

/// f(bytes, their offset in the file) for all stretches of rows of this rank.
template <class F>
void for_each_stretch(const SharedRows& rows, const Extent& dataset, F f) {
  std::vector<std::byte> memory;
  for (const RowBatch& batch : rows.batches) {
    memory.resize(batch.particles * rows.bytes);
    rows.fill(batch, memory.data());
    std::span<const std::byte> left(memory);
    for (const RowBatch::Stretch& stretch : batch.rows) {
      f(left.first(stretch.count * rows.bytes), dataset.offset + stretch.first * rows.bytes);
      left = left.subspan(stretch.count * rows.bytes);
    }
  }
}

void write(const std::string& path, std::span<const SharedRows> datasets,
           const std::vector<Extent>& extents) {
  File file(path, File::Mode::fill);
  for (std::size_t d = 0; d < datasets.size(); ++d) {
    const SharedRows& rows = datasets[d];
    for_each_stretch(rows, extents[d], [&](std::span<const std::byte> bytes, std::uint64_t at) {
      file.write_at(bytes, at);
      if (rows.checksum != nullptr)
        *rows.checksum += checksum_of_rows((at - extents[d].offset) / rows.bytes, bytes, rows.bytes);
    });
  }
  file.close();
}

void compare(const std::string& path, std::span<const SharedRows> datasets,
             const std::vector<Extent>& extents) {
  const File file(path, File::Mode::read);
  std::vector<std::byte> found;
  for (std::size_t d = 0; d < datasets.size(); ++d) {
    for_each_stretch(datasets[d], extents[d], [&](std::span<const std::byte> bytes, std::uint64_t at) {
      found.resize(bytes.size());
      file.read_at(found, at);
      if (std::memcmp(found.data(), bytes.data(), bytes.size()) == 0) return;
      throw FileError(
          fmt::format("cannot write '{}': the data read back from '{}' differ from the data written, and no "
                      "error was reported: this file system loses data written by several machines; choose "
                      "another with --output-dir",
                      path, datasets[d].dataset));
    });
  }
}

}  // namespace

std::vector<Extent> write_together(const std::string& path, std::span<const SharedRows> datasets,
                                   core::Reductions& ranks) {
  std::vector<Extent> extents;
  together(ranks, [&] {
    extents = extents_of(path, datasets);
    write(path, datasets, extents);
  });
  if (ranks.size() > 1) together(ranks, [&] { compare(path, datasets, extents); });
  return extents;
}

}  // namespace mpm::io
