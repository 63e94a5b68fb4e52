#include "io/output/h5part_mark.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "io/output/hash.hpp"

namespace mpm::io {

namespace {

constexpr std::size_t bytes_at_once = std::size_t{1} << 20;
/// Rows that a rank always checks; takes a fraction of a second.
constexpr std::uint64_t cheap_bytes = std::uint64_t{1} << 28;

struct Fixed {
  std::int64_t times, step;
  std::uint64_t head, size, rows;
};
static_assert(sizeof(H5PartMark::Rows) == 4 * sizeof(std::uint64_t));

/// f(part of the mark's other bytes, where they stand in the file), in pieces of bounded size.
template <class F>
void for_each_piece(const H5PartMark& mark, F f) {
  std::uint64_t in_mark = 0, at = 0;
  const auto up_to = [&](std::uint64_t end) {
    while (at < end) {
      const std::uint64_t n = std::min<std::uint64_t>(bytes_at_once, end - at);
      f(in_mark, at, n);
      in_mark += n;
      at += n;
    }
  };
  for (const H5PartMark::Rows& r : mark.rows) {
    up_to(r.extent.offset);
    at = r.extent.offset + r.extent.size;
  }
  up_to(mark.size);
}

std::uint64_t bytes_of_rows(const H5PartMark& mark) {
  std::uint64_t bytes = 0;
  for (const H5PartMark::Rows& r : mark.rows) bytes += r.extent.size;
  return bytes;
}

/// Whether bytes beyond the head differ; writing later times does not change these.
bool differs_beyond_head(const File& file, const H5PartMark& mark) {
  bool differs = false;
  std::string found;
  for_each_piece(mark, [&](std::uint64_t in_mark, std::uint64_t at, std::uint64_t n) {
    const std::uint64_t skip = at < mark.head ? std::min(n, mark.head - at) : 0;
    if (differs || skip == n) return;
    found.resize(n - skip);
    file.read_at(std::as_writable_bytes(std::span(found)), at + skip);
    differs = std::memcmp(found.data(), mark.other_bytes.data() + in_mark + skip, found.size()) != 0;
  });
  return differs;
}

/// Every rank reads its share of each dataset. Collective.
bool rows_are_right(const std::string& path, const H5PartMark& mark, core::Reductions& ranks) {
  std::vector<std::uint64_t> sums(mark.rows.size());
  together(ranks, [&] {
    const File file(path, File::Mode::read);
    std::vector<std::byte> buffer;
    const auto shares = static_cast<std::uint64_t>(ranks.size());
    const auto rank = static_cast<std::uint64_t>(ranks.rank());
    for (std::size_t d = 0; d < sums.size(); ++d) {
      const H5PartMark::Rows& r = mark.rows[d];
      const std::uint64_t all = r.extent.size / r.row_bytes;
      const std::uint64_t end = all / shares * (rank + 1) + std::min(all % shares, rank + 1);
      for (std::uint64_t row = all / shares * rank + std::min(all % shares, rank); row < end;) {
        const std::uint64_t n = std::min(end - row, std::max<std::uint64_t>(1, bytes_at_once / r.row_bytes));
        buffer.resize(n * r.row_bytes);
        file.read_at(buffer, r.extent.offset + row * r.row_bytes);
        sums[d] += checksum_of_rows(row, buffer, r.row_bytes);
        row += n;
      }
    }
  });
  sum_checksums(sums, ranks);
  for (std::size_t d = 0; d < sums.size(); ++d) {
    if (sums[d] != mark.rows[d].checksum) return false;
  }
  return true;
}

void write_tables(const std::string& path, const H5PartMark& mark) {
  File file(path, File::Mode::change);
  std::string found;
  for_each_piece(mark, [&](std::uint64_t in_mark, std::uint64_t at, std::uint64_t n) {
    const std::string_view right = std::string_view(mark.other_bytes).substr(in_mark, n);
    found.resize(n);
    file.read_at(std::as_writable_bytes(std::span(found)), at);
    if (found != right) file.write_at(right, at);
  });
  file.truncate(mark.size);
  file.close();
}

}  // namespace

std::string H5PartMark::bytes() const {
  const Fixed fixed{times, step, head, size, rows.size()};
  std::string text(sizeof fixed + sizeof(Rows) * rows.size(), '\0');
  std::memcpy(text.data(), &fixed, sizeof fixed);
  if (!rows.empty()) std::memcpy(text.data() + sizeof fixed, rows.data(), sizeof(Rows) * rows.size());
  return text + other_bytes;
}

std::optional<H5PartMark> H5PartMark::from(std::string_view bytes) {
  Fixed fixed{};
  if (bytes.size() < sizeof fixed) return {};
  std::memcpy(&fixed, bytes.data(), sizeof fixed);
  bytes.remove_prefix(sizeof fixed);
  if (fixed.rows > bytes.size() / sizeof(Rows)) return {};
  H5PartMark mark{fixed.times, fixed.step, fixed.head, fixed.size, std::vector<Rows>(fixed.rows), {}};
  if (fixed.rows > 0) std::memcpy(mark.rows.data(), bytes.data(), sizeof(Rows) * fixed.rows);
  mark.other_bytes = bytes.substr(sizeof(Rows) * fixed.rows);
  if (mark.other_bytes.size() + bytes_of_rows(mark) != mark.size) return {};
  return mark;
}

void H5PartMark::copy_tables(const std::string& path) {
  const File file(path, File::Mode::read);
  size = file.size();
  other_bytes.resize(size - bytes_of_rows(*this));
  for_each_piece(*this, [&](std::uint64_t in_mark, std::uint64_t at, std::uint64_t n) {
    file.read_at(std::as_writable_bytes(std::span(other_bytes).subspan(in_mark, n)), at);
  });
}

std::string restore(const std::string& path, const H5PartMark& mark, core::Reductions& ranks) {
  enum State : std::int64_t { as_it_was, changed, too_short };
  std::int64_t state = as_it_was, size = 0;
  together(ranks, [&] {
    if (ranks.rank() != 0) return;
    const File file(path, File::Mode::read);
    size = static_cast<std::int64_t>(file.size());
    if (file.size() < mark.size) {
      state = too_short;
    } else if (differs_beyond_head(file, mark)) {
      state = changed;
    }
  });
  std::int64_t both[] = {state, size};
  ranks.sum(std::span<std::int64_t>(both));
  if (both[0] == too_short) {
    return fmt::format("'{}' has {} bytes instead of the {} that it had when the restart file was written",
                       path, both[1], mark.size);
  }
  const bool cheap = bytes_of_rows(mark) / static_cast<std::uint64_t>(ranks.size()) <= cheap_bytes;
  if ((cheap || both[0] == changed) && !rows_are_right(path, mark, ranks))
    return fmt::format(
        "'{}' is damaged, or does not belong to the restart file: values fail their "
        "checksum",
        path);
  together(ranks, [&] {
    if (ranks.rank() == 0) write_tables(path, mark);
  });
  return {};
}

std::uint64_t checksum_of_rows(std::uint64_t first, std::span<const std::byte> rows, std::size_t row_bytes) {
  std::uint64_t sum = 0;
  const std::string_view bytes(reinterpret_cast<const char*>(rows.data()), rows.size());
  for (std::size_t at = 0; at < bytes.size(); at += row_bytes) {
    Hash hash;
    hash.add(first++);
    hash.add(bytes.substr(at, row_bytes));
    sum += hash.value();
  }
  return sum;
}

void sum_checksums(std::span<std::uint64_t> checksums, core::Reductions& ranks) {
  constexpr std::uint64_t low = 0xffffffffu;
  std::vector<std::int64_t> halves;
  for (const std::uint64_t c : checksums) {
    halves.push_back(static_cast<std::int64_t>(c & low));
    halves.push_back(static_cast<std::int64_t>(c >> 32));
  }
  ranks.sum(std::span(halves));
  for (std::size_t i = 0; i < checksums.size(); ++i) {
    checksums[i] =
        static_cast<std::uint64_t>(halves[2 * i]) + (static_cast<std::uint64_t>(halves[2 * i + 1]) << 32);
  }
}

}  // namespace mpm::io
