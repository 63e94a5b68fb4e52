#include "core/discretise/point_file.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>
#include <zlib.h>

#include "core/simd/denormals.hpp"

namespace mpm::core {

namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;

ParsedLine wrong(std::string message) { return {LineKind::wrong, {}, std::move(message)}; }

/// Control characters of a binary file must not reach the terminal.
std::string printable(std::string_view word) {
  std::string text(word.substr(0, 40));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  return text;
}

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_comment(char c) { return c == '#' || c == '!'; }

/// Removes the first word of a line and returns it; empty at the end or before a comment.
std::string_view take_word(std::string_view& rest) {
  std::size_t begin = 0;
  while (begin < rest.size() && is_blank(rest[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest.size() && !is_blank(rest[end]) && !is_comment(rest[end])) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

bool to_number(std::string_view word, double& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && stop == word.data() + word.size() && std::isfinite(value);
}

}  // namespace

void PointFile::Close::operator()(gzFile_s* file) const { gzclose_r(file); }

PointFile::PointFile(const std::string& path) {
  errno = 0;
  file_.reset(gzopen(path.c_str(), "rb"));
  if (!file_) throw std::runtime_error(std::strerror(errno != 0 ? errno : ENOMEM));
  gzbuffer(file_.get(), 1U << 18);
  buffer_.resize(buffer_bytes);
}

bool PointFile::refill() {
  if (exhausted_) return false;
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  errno = 0;
  const int got = gzread(file_.get(), buffer_.data() + end_, static_cast<unsigned>(buffer_.size() - end_));
  int error = Z_OK;
  const char* reason = gzerror(file_.get(), &error);
  if (got < 0 || (error != Z_OK && error != Z_STREAM_END)) {
    const std::string why = error == Z_ERRNO && errno != 0 ? std::strerror(errno) : reason;
    throw std::runtime_error("reading stopped after line " + std::to_string(following_.number - 1) + ": " +
                             why);
  }
  exhausted_ = got == 0;
  end_ += static_cast<std::size_t>(got);
  return !exhausted_;
}

bool PointFile::next(std::string_view& line) {
  std::size_t searched = 0;
  const void* newline = nullptr;
  for (;;) {
    newline = std::memchr(buffer_.data() + begin_ + searched, '\n', end_ - begin_ - searched);
    if (newline != nullptr) break;
    searched = end_ - begin_;
    if (searched > longest_line) break;
    if (!refill()) break;
  }
  if (newline == nullptr && end_ == begin_) return false;
  const char* start = buffer_.data() + begin_;
  const auto length = newline != nullptr ? static_cast<std::size_t>(static_cast<const char*>(newline) - start)
                                         : end_ - begin_;
  place_ = following_;
  if (length > longest_line)
    throw std::runtime_error(
        fmt::format("line {} is longer than {} characters: this is not a file of particles", place_.number,
                    longest_line));
  line = {start, length};
  const std::size_t taken = length + (newline != nullptr ? 1 : 0);
  begin_ += taken;
  following_ = {place_.offset + static_cast<std::int64_t>(taken), place_.number + 1};
  return true;
}

void PointFile::seek(const LinePlace& place) {
  // Skips the part already in the buffer.
  const std::int64_t ahead = place.offset - following_.offset;
  if (ahead >= 0 && static_cast<std::uint64_t>(ahead) <= end_ - begin_) {
    begin_ += static_cast<std::size_t>(ahead);
  } else {
    if (gzseek(file_.get(), static_cast<z_off_t>(place.offset), SEEK_SET) != place.offset)
      throw std::runtime_error("the file can no longer be repositioned");
    begin_ = end_ = 0;
    exhausted_ = false;
  }
  following_ = place;
}

ParsedLine parse_point_line(std::string_view line) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  constexpr std::array names{"mass", "x", "y", "z"};
  if (line.starts_with(byte_order_mark)) line.remove_prefix(byte_order_mark.size());
  ParsedLine parsed;
  std::string_view rest = line;
  for (std::size_t n = 0; n < names.size(); ++n) {
    const std::string_view word = take_word(rest);
    if (word.empty() && n == 0) return parsed;
    if (word.empty()) return wrong(fmt::format("expected four numbers, mass x y z, found {}", n));
    if (!to_number(word, parsed.values[n]))
      return wrong(fmt::format("{}: expected a number, found `{}`", names[n], printable(word)));
    if (is_subnormal(parsed.values[n]))
      return wrong(fmt::format("{}: {} is too small for double precision; write 0, or choose other units",
                               names[n], printable(word)));
  }
  const std::string_view extra = take_word(rest);
  if (!extra.empty())
    return wrong(fmt::format("expected four numbers, mass x y z, found more: `{}`", printable(extra)));
  if (!(parsed.values[0] > 0))
    return wrong(fmt::format("mass: expected more than 0, found {}", parsed.values[0]));
  parsed.kind = LineKind::point;
  return parsed;
}

}  // namespace mpm::core
