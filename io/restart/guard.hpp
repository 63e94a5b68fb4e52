// The first block of a restart file, before HDF5's own: its type, its length, and checksums of every byte
// except the particles' rows (which have their own, see contents.hpp). HDF5 opens a file only after this
// check, since it may crash on a damaged one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/output/file.hpp"

namespace mpm::io {

inline constexpr std::uint32_t restart_format = 2;
/// The oldest readable format: without marks of other files, and without the job in the guard.
inline constexpr std::uint32_t oldest_restart_format = 1;

struct Guard {
  std::int64_t step = 0;
  std::int64_t written = 0;  ///< nanoseconds since 1970
  std::uint64_t file_size = 0;
  std::uint64_t tables_hash = 0;  ///< of all bytes after this block except the rows
  std::vector<Extent> rows;       ///< of the particles of each body, ascending
  std::uint64_t job = 0;          ///< job_hash(); 0 if the file does not state it
};

/// Hash of a job's name in the guard.
std::uint64_t job_hash(const std::string& job);

/// Size of the guard of a file with this many bodies; a power of two from 512 up, as HDF5 requires.
std::uint64_t guard_bytes(std::size_t bodies);

/// Computes the checksums of a job's complete file, writes its guard, and syncs to disk. The time written is
/// later than `after`, whatever the clock says. Throws FileError.
void seal(const std::string& path, const std::string& job, std::int64_t step, std::int64_t after,
          std::vector<Extent> rows, std::size_t bodies);

/// Reads the guard and verifies everything except the rows. Throws FileError with the fault.
Guard check_guard(const std::string& path);
/// Reads the guard only.
Guard read_guard(const std::string& path);

}  // namespace mpm::io
