#include "io/output/file.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace mpm::io {

namespace {

int flags_of(File::Mode mode) {
  switch (mode) {
    case File::Mode::read: return O_RDONLY;
    case File::Mode::write_anew: return O_WRONLY | O_CREAT | O_TRUNC;
    case File::Mode::append: return O_WRONLY | O_CREAT | O_APPEND;
    case File::Mode::change: return O_RDWR;
    case File::Mode::fill: return O_WRONLY;
  }
  return O_RDONLY;
}

void sync_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int handle = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return;  // a folder may be written to without being readable
  ::fsync(handle);
  ::close(handle);
}

}  // namespace

File::File(const std::string& path, Mode mode) : path_(path) {
  handle_ = ::open(path.c_str(), flags_of(mode) | O_CLOEXEC, 0666);
  if (handle_ < 0) fail(mode == Mode::read ? "read" : "write", errno);
}

File::~File() {
  if (handle_ >= 0) ::close(handle_);
}

void File::fail(const char* doing, int error) const { throw system_error(doing, path_, error); }

void File::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(handle_, bytes.data(), bytes.size());
    if (n < 0 && errno != EINTR) fail("write", errno);
    if (n > 0) bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void File::write_at(std::string_view bytes, std::uint64_t offset) {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(handle_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno != EINTR) fail("write", errno);
    if (n <= 0) continue;
    bytes.remove_prefix(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

void File::read_at(std::span<std::byte> into, std::uint64_t offset) const {
  while (!into.empty()) {
    const ssize_t n = ::pread(handle_, into.data(), into.size(), static_cast<off_t>(offset));
    if (n < 0 && errno != EINTR) fail("read", errno);
    if (n == 0) throw FileError("cannot read '" + path_ + "': unexpected end of file");
    if (n < 0) continue;
    into = into.subspan(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

std::uint64_t File::size() const {
  struct stat status {};
  if (::fstat(handle_, &status) != 0) fail("read", errno);
  return static_cast<std::uint64_t>(status.st_size);
}

void File::truncate(std::uint64_t size) {
  if (::ftruncate(handle_, static_cast<off_t>(size)) != 0) fail("write", errno);
}

void File::reserve(std::uint64_t size) {
  const std::uint64_t old = this->size();
  int error = EINTR;
  // From the start: the file may have holes.
  while (error == EINTR) error = ::fallocate(handle_, 0, 0, static_cast<off_t>(size)) == 0 ? 0 : errno;
  if (error == 0) return;
  if (error == EOPNOTSUPP || error == ENOSYS) {
    struct stat status {};
    struct statvfs system {};
    if (::fstat(handle_, &status) != 0 || ::fstatvfs(handle_, &system) != 0) return;
    const std::uint64_t there = 512 * static_cast<std::uint64_t>(status.st_blocks);
    if (size <= there + std::uint64_t{system.f_bavail} * system.f_frsize) return;
    error = ENOSPC;
  }
  if (::ftruncate(handle_, static_cast<off_t>(old)) != 0) fail("write", errno);
  fail("write", error);
}

void File::sync() {
  if (::fsync(handle_) != 0 && errno != EINVAL && errno != EROFS) fail("write", errno);
}

void File::close() {
  const int handle = handle_;
  handle_ = -1;
  if (handle >= 0 && ::close(handle) != 0 && errno != EINTR) fail("write", errno);
}

std::string read_file(const std::string& path) {
  const File file(path, File::Mode::read);
  std::string bytes(file.size(), '\0');
  file.read_at(std::as_writable_bytes(std::span(bytes)), 0);
  return bytes;
}

std::string part_name(const std::string& path) { return path + ".part"; }

void replace_file(const std::string& path, std::string_view bytes) {
  const std::string part = part_name(path);
  try {
    File file(part, File::Mode::write_anew);
    file.write(bytes);
    file.sync();
    file.close();
  } catch (const FileError&) {
    remove_file(part);
    throw;
  }
  rename_file(part, path);
}

void rename_file(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) throw system_error("write", to, errno);
  sync_folder_of(to);
}

void remove_file(const std::string& path) noexcept { ::unlink(path.c_str()); }

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw system_error("create the folder", path, error.value());
}

}  // namespace mpm::io
