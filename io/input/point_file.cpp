#include "io/input/point_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

#include "core/scene/errors.hpp"
#include "io/input/text.hpp"

namespace mpm::io {

std::string why_unreadable(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    return error && error.value() != ENOENT ? error.message() : "no such file";
  if (std::filesystem::is_directory(status)) return "this is a folder, not a file";
  if (!std::filesystem::is_regular_file(status)) return "not a regular file";
  std::FILE* const opened = std::fopen(file.c_str(), "rb");
  if (!opened) return std::strerror(errno);
  std::fclose(opened);
  return {};
}

struct PointFile::Stream {
  std::string path;
  gzFile file = nullptr;
  std::vector<char> buffer = std::vector<char>(std::size_t{1} << 18);
  std::size_t begin = 0, end = 0;  ///< what of the buffer is still to be read
  int line = 0;

  ~Stream() {
    if (file) gzclose_r(file);
  }
};

PointFile::PointFile(const std::filesystem::path& file) : stream_(std::make_unique<Stream>()) {
  stream_->path = file.string();
  if (const std::string wrong = why_unreadable(file); !wrong.empty()) fail(wrong);
  stream_->file = gzopen(file.c_str(), "rb");
  if (!stream_->file) fail(std::strerror(errno));
}

PointFile::~PointFile() = default;
PointFile::PointFile(PointFile&&) noexcept = default;
PointFile& PointFile::operator=(PointFile&&) noexcept = default;

void PointFile::fail(const std::string& message) const {
  throw core::InputErrors(core::SourceLocation{stream_->path, stream_->line}, {}, message);
}

bool PointFile::next_line(std::string_view& line) {
  Stream& s = *stream_;
  ++s.line;
  for (;;) {
    char* const begin = s.buffer.data() + s.begin;
    const std::size_t held = s.end - s.begin;
    if (const void* newline = std::memchr(begin, '\n', held)) {
      const auto length = static_cast<std::size_t>(static_cast<const char*>(newline) - begin);
      line = {begin, length};
      s.begin += length + 1;
      return true;
    }
    if (held == s.buffer.size()) fail("a line longer than 256 KiB; expected `mass x y z`");
    std::memmove(s.buffer.data(), begin, held);
    s.begin = 0;
    const int count = gzread(s.file, s.buffer.data() + held, static_cast<unsigned>(s.buffer.size() - held));
    int code = Z_OK;
    const char* const message = gzerror(s.file, &code);
    if (count < 0 || (code != Z_OK && code != Z_STREAM_END)) fail(fmt::format("cannot be read: {}", message));
    s.end = held + static_cast<std::size_t>(count);
    if (count == 0) {
      line = {s.buffer.data(), held};
      s.begin = s.end;
      return held > 0;
    }
  }
}

bool PointFile::next(core::PointMass& point) {
  std::string_view line;
  while (next_line(line)) {
    line = trim(line);
    if (line.empty() || line.front() == '#') continue;
    std::array<double, 4> values{};
    for (double& value : values) {
      const std::string_view word = line.substr(0, line.find_first_of(" \t,"));
      const std::optional<double> number = parse_real(word);
      if (!number) fail(fmt::format("expected four numbers `mass x y z`, found '{}'", shortened(word, 40)));
      value = *number;
      line.remove_prefix(word.size());
      line = line.substr(std::min(line.find_first_not_of(" \t,"), line.size()));
    }
    if (!line.empty())
      fail(fmt::format("expected four numbers `mass x y z`, found '{}' after them", shortened(line, 40)));
    if (!(values[0] > 0)) fail(fmt::format("the mass {} of a particle is not positive", values[0]));
    point = {values[0], {values[1], values[2], values[3]}};
    return true;
  }
  return false;
}

}  // namespace mpm::io
