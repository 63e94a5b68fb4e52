#include "io/restart/rows.hpp"

namespace mpm::io {

namespace {

constexpr std::size_t bytes_at_once = std::size_t{8} << 20;

std::uint64_t bytes_of(const RestartContents& contents, const TileRecord& record) {
  const BodyRecord& body = contents.bodies[static_cast<std::size_t>(record.body)];
  return sizeof(double) * body.columns.size() * record.particles;
}

/// Offsets of the rows of each body.
std::vector<std::uint64_t> begins_of_bodies(const std::string& path, const RestartContents& contents) {
  const hdf5::Handle file = hdf5::open_file(path, hdf5::Access::read);
  std::vector<std::uint64_t> begins;
  for (std::size_t b = 0; b < contents.bodies.size(); ++b)
    begins.push_back(hdf5::extent_of(hdf5::open_dataset(file, rows_name(b))).offset);
  return begins;
}

}  // namespace

RowReader::RowReader(const std::string& path, const RestartContents& contents)
    : path_(path), contents_(contents), file_(path, File::Mode::read) {
  std::vector<std::uint64_t> next = begins_of_bodies(path, contents);
  for (const TileRecord& r : contents.tiles) {
    first_byte_.push_back(next[static_cast<std::size_t>(r.body)]);
    next[static_cast<std::size_t>(r.body)] += bytes_of(contents, r);
  }
}

std::size_t RowReader::read(const std::vector<std::size_t>& wanted, std::size_t first) {
  struct Stretch {
    std::uint64_t at, bytes;
  };
  std::vector<Stretch> stretches;
  std::uint64_t bytes = 0;
  std::size_t records = 0;
  for (std::size_t i = first; i < wanted.size(); ++i, ++records) {
    const std::uint64_t at = first_byte_[wanted[i]], size = bytes_of(contents_, contents_.tiles[wanted[i]]);
    if (records > 0 && bytes + size > bytes_at_once) break;
    if (!stretches.empty() && stretches.back().at + stretches.back().bytes == at) {
      stretches.back().bytes += size;
    } else {
      stretches.push_back({at, size});
    }
    bytes += size;
  }
  rows_.resize(bytes / sizeof(double));
  std::span<std::byte> into = std::as_writable_bytes(std::span(rows_));
  for (const Stretch& s : stretches) {
    file_.read_at(into.first(s.bytes), s.at);
    into = into.subspan(s.bytes);
  }
  return records;
}

void RowReader::check(const TileRecord& record, const double* rows) const {
  const BodyRecord& body = contents_.bodies[static_cast<std::size_t>(record.body)];
  if (hash_of(record, rows, static_cast<int>(body.columns.size())) == record.hash) return;
  const auto [x, y, z, level] = core::brick_of_key(record.brick);
  throw FileError(
      fmt::format("the restart file '{}' is damaged: the particles of body '{}' in brick ({}, {}, {}) fail "
                  "their checksum",
                  path_, body.name, x, y, z));
}

}  // namespace mpm::io
