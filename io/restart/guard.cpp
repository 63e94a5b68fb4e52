#include "io/restart/guard.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>

#include <fmt/format.h>

#include "io/output/file.hpp"
#include "io/output/hash.hpp"

namespace mpm::io {

namespace {

constexpr std::string_view magic("mpm-restart\r\n\x1a\0\0", 16);
constexpr std::size_t head_bytes = 64;                         // magic and the fields before the extents
constexpr std::size_t tail_bytes = 2 * sizeof(std::uint64_t);  // the job after the extents, the checksum
constexpr std::size_t smallest_block = 512;
constexpr std::size_t bytes_at_once = std::size_t{1} << 20;

template <class T>
void put(std::string& block, std::size_t& at, T value) {
  std::memcpy(block.data() + at, &value, sizeof value);
  at += sizeof value;
}

template <class T>
T take(const std::string& block, std::size_t& at) {
  T value;
  std::memcpy(&value, block.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

std::uint64_t hash_of_block(std::string_view block) {
  Hash hash;
  hash.add(block.substr(0, block.size() - sizeof(std::uint64_t)));
  return hash.value();
}

std::string encode(const Guard& guard, std::size_t block_bytes) {
  std::string block(block_bytes, '\0');
  std::memcpy(block.data(), magic.data(), magic.size());
  std::size_t at = magic.size();
  put(block, at, restart_format);
  put(block, at, static_cast<std::uint32_t>(block_bytes));
  put(block, at, guard.step);
  put(block, at, guard.written);
  put(block, at, guard.file_size);
  put(block, at, guard.tables_hash);
  put(block, at, static_cast<std::uint64_t>(guard.rows.size()));
  for (const Extent& e : guard.rows) {
    put(block, at, e.offset);
    put(block, at, e.size);
  }
  put(block, at, guard.job);
  at = block_bytes - sizeof(std::uint64_t);
  put(block, at, hash_of_block(block));
  return block;
}

std::uint64_t hash_tables(const File& file, std::uint64_t begin, std::uint64_t end,
                          const std::vector<Extent>& rows) {
  Hash hash;
  std::string buffer;
  const auto add = [&](std::uint64_t from, std::uint64_t to) {
    for (; from < to; from += buffer.size()) {
      buffer.resize(std::min<std::uint64_t>(bytes_at_once, to - from));
      file.read_at(std::as_writable_bytes(std::span(buffer)), from);
      hash.add(buffer);
    }
  };
  for (const Extent& e : rows) {
    add(begin, e.offset);
    begin = e.offset + e.size;
  }
  add(begin, end);
  return hash.value();
}

[[noreturn]] void damaged(const std::string& path, const std::string& how) {
  throw FileError(fmt::format("the restart file '{}' is damaged: {}", path, how));
}

Guard decode(const File& file, const std::string& path, std::size_t& block_bytes) {
  const std::uint64_t size = file.size();
  std::string block(smallest_block, '\0');
  if (size < smallest_block) damaged(path, fmt::format("it has {} bytes, too few for a restart file", size));
  file.read_at(std::as_writable_bytes(std::span(block)), 0);
  if (std::string_view(block).substr(0, magic.size()) != magic) {
    throw FileError(fmt::format("'{}' is not a restart file, or its first block is damaged", path));
  }
  std::size_t at = magic.size();
  const auto format = take<std::uint32_t>(block, at);
  block_bytes = take<std::uint32_t>(block, at);
  if (!std::has_single_bit(block_bytes) || block_bytes < smallest_block || block_bytes > size) {
    damaged(path, "its first block contains an invalid length");
  }
  block.resize(block_bytes);
  file.read_at(std::as_writable_bytes(std::span(block)), 0);
  Guard guard;
  guard.step = take<std::int64_t>(block, at);
  guard.written = take<std::int64_t>(block, at);
  guard.file_size = take<std::uint64_t>(block, at);
  guard.tables_hash = take<std::uint64_t>(block, at);
  const auto bodies = take<std::uint64_t>(block, at);
  std::size_t hash_at = block_bytes - sizeof(std::uint64_t);
  if (take<std::uint64_t>(block, hash_at) != hash_of_block(block))
    damaged(path, "its first block fails its checksum");
  if (format < oldest_restart_format || format > restart_format) {
    throw FileError(
        fmt::format("the restart file '{}' has format {}, but this program reads formats {} to {}", path,
                    format, oldest_restart_format, restart_format));
  }
  for (std::uint64_t b = 0; b < bodies; ++b) {
    const auto offset = take<std::uint64_t>(block, at);
    guard.rows.push_back({offset, take<std::uint64_t>(block, at)});
  }
  if (format > oldest_restart_format) guard.job = take<std::uint64_t>(block, at);
  return guard;
}

}  // namespace

std::uint64_t guard_bytes(std::size_t bodies) {
  return std::bit_ceil(std::max(smallest_block, head_bytes + sizeof(Extent) * bodies + tail_bytes));
}

std::uint64_t job_hash(const std::string& job) {
  Hash hash;
  hash.add(job);
  return std::max<std::uint64_t>(1, hash.value());
}

void seal(const std::string& path, const std::string& job, std::int64_t step, std::int64_t after,
          std::vector<Extent> rows, std::size_t bodies) {
  const auto block_bytes = static_cast<std::size_t>(guard_bytes(bodies));
  std::sort(rows.begin(), rows.end(), [](const Extent& a, const Extent& b) { return a.offset < b.offset; });
  File file(path, File::Mode::change);
  Guard guard;
  guard.step = step;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  guard.written =
      std::max<std::int64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count(), after + 1);
  guard.file_size = file.size();
  guard.tables_hash = hash_tables(file, block_bytes, guard.file_size, rows);
  guard.rows = std::move(rows);
  guard.job = job_hash(job);
  file.write_at(encode(guard, block_bytes), 0);
  file.sync();
  file.close();
}

Guard read_guard(const std::string& path) {
  std::size_t block_bytes = 0;
  return decode(File(path, File::Mode::read), path, block_bytes);
}

Guard check_guard(const std::string& path) {
  const File file(path, File::Mode::read);
  std::size_t block_bytes = 0;
  const Guard guard = decode(file, path, block_bytes);
  if (file.size() != guard.file_size) {
    damaged(path, fmt::format("it has {} bytes instead of {}", file.size(), guard.file_size));
  }
  if (hash_tables(file, block_bytes, guard.file_size, guard.rows) != guard.tables_hash) {
    damaged(path, "its tables fail their checksum");
  }
  return guard;
}

}  // namespace mpm::io
