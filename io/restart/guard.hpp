// The first block of a restart file, before HDF5's own: what the file is, how long, and checksums that cover
// every byte of it but the particles' rows (those have checksums of their own, see contents.hpp). A file is
// only handed to HDF5 after this block says that it is whole, since HDF5 may crash on a damaged one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/output/file.hpp"

namespace mpm::io {

inline constexpr std::uint32_t restart_format = 2;
/// Read, too: without marks of other files, and without the job in the guard.
inline constexpr std::uint32_t oldest_restart_format = 1;

struct Guard {
  std::int64_t step = 0;
  std::int64_t written = 0;  ///< nanoseconds since 1970
  std::uint64_t file_size = 0;
  std::uint64_t tables_hash = 0;  ///< of all bytes after this block but the rows
  std::vector<Extent> rows;       ///< of the particles of each body, ascending
  std::uint64_t job = 0;          ///< job_hash(); 0 if the file does not say
};

/// What a job's name is in the guard.
std::uint64_t job_hash(const std::string& job);

/// Room that the guard of a file with this many bodies needs; a power of two from 512 up, as HDF5 wants it.
std::uint64_t guard_bytes(std::size_t bodies);

/// Checksum the complete file of a job and write its guard, all of it to the disk. `after`: the time that the
/// file must be younger than, whatever the clock says. Throws FileError.
void seal(const std::string& path, const std::string& job, std::int64_t step, std::int64_t after,
          std::vector<Extent> rows, std::size_t bodies);

/// Read the guard and make sure that everything but the rows is as it was written. Throws FileError that says
/// what is wrong.
Guard check_guard(const std::string& path);
/// The guard alone.
Guard read_guard(const std::string& path);

}  // namespace mpm::io
