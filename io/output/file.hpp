// File access by system calls, so that errors have a reason: writing, atomic replacement, reservation of
// space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/output/file_error.hpp"

namespace mpm::io {

/// Bytes [offset, offset + size) of a file.
struct Extent {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
};

/// An open file. Every failure throws FileError.
class File {
 public:
  /// `fill` writes into an existing file and never reads, so data written by other machines stays intact.
  enum class Mode { read, write_anew, append, change, fill };
  File(const std::string& path, Mode mode);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void write(std::string_view bytes);
  void write_at(std::string_view bytes, std::uint64_t offset);
  void write_at(std::span<const std::byte> bytes, std::uint64_t offset) {
    write_at({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, offset);
  }
  /// Reads exactly as many bytes as `into` holds; a shorter file is an error.
  void read_at(std::span<std::byte> into, std::uint64_t offset) const;
  std::uint64_t size() const;
  void truncate(std::uint64_t size);
  /// Ensures that the file can grow to `size` bytes, without changing its contents. If the file system cannot
  /// reserve space, the free space is checked.
  void reserve(std::uint64_t size);
  /// Syncs to disk.
  void sync();
  /// A failure to close counts as a failure to write.
  void close();

 private:
  [[noreturn]] void fail(const char* doing, int error) const;
  std::string path_;
  int handle_ = -1;
};

std::string read_file(const std::string& path);

/// Replaces the file atomically: it holds either these bytes or its previous contents. The folder must exist.
void replace_file(const std::string& path, std::string_view bytes);
/// Renames a complete file, replacing any file of that name, and syncs the folder.
void rename_file(const std::string& from, const std::string& to);
/// Does nothing if there is no such file.
void remove_file(const std::string& path) noexcept;
void make_folder(const std::string& path);
/// Name of a file under construction, in the same folder; ends in `.part`.
std::string part_name(const std::string& path);

}  // namespace mpm::io
