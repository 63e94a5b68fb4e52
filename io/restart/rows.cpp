#include "io/restart/rows.hpp"

namespace mpm::io {

namespace {
constexpr std::size_t doubles_at_once = std::size_t{1} << 20;
constexpr std::size_t stretches_at_once = 256;  // HDF5 takes time quadratic in them
}  // namespace

RowReader::RowReader(const std::string& path, const RestartContents& contents)
    : path_(path), contents_(contents), file_(hdf5::open_file(path, hdf5::Access::read)) {
  std::vector<hsize_t> rows(contents.bodies.size());
  for (const CohortRecord& r : contents.cohorts) {
    first_row_.push_back(rows[static_cast<std::size_t>(r.body)]);
    rows[static_cast<std::size_t>(r.body)] += r.particles;
  }
}

std::size_t RowReader::read(const std::vector<std::size_t>& wanted, std::size_t first) {
  const auto body = static_cast<std::size_t>(contents_.cohorts[wanted[first]].body);
  const std::size_t columns = contents_.bodies[body].columns.size();
  std::vector<hdf5::Rows> stretches;
  std::size_t rows = 0, records = 0;
  for (std::size_t i = first; i < wanted.size(); ++i, ++records) {
    const CohortRecord& r = contents_.cohorts[wanted[i]];
    const bool full =
        (rows + r.particles) * columns > doubles_at_once || stretches.size() == stretches_at_once;
    if (static_cast<std::size_t>(r.body) != body || (records > 0 && full)) break;
    const hsize_t at = first_row_[wanted[i]];
    if (!stretches.empty() && stretches.back().first + stretches.back().count == at) {
      stretches.back().count += r.particles;
    } else {
      stretches.push_back({at, r.particles});
    }
    rows += r.particles;
  }
  rows_.resize(rows * columns);
  hdf5::read_rows(hdf5::open_dataset(file_, rows_name(body)), H5T_NATIVE_DOUBLE, stretches, rows_.data());
  return records;
}

void RowReader::check(const CohortRecord& record, const double* rows) const {
  const BodyRecord& body = contents_.bodies[static_cast<std::size_t>(record.body)];
  if (hash_of(record, rows, static_cast<int>(body.columns.size())) == record.hash) return;
  const auto [x, y, z] = core::brick_of_key(record.brick);
  throw FileError(
      fmt::format("the restart file '{}' is damaged: the particles of body '{}' in brick ({}, {}, {}) fail "
                  "their checksum",
                  path_, body.name, x, y, z));
}

}  // namespace mpm::io
