#include "io/input/file_access.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

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

}  // namespace mpm::io
