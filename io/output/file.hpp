// Files by the system's own calls, so that an error is known with its reason: writing, replacing as a whole,
// reserving space before it is needed.
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

/// An open file. Every failure is a FileError.
class File {
 public:
  /// `fill` writes into what is there and never reads: what other machines write beside it is left alone.
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
  /// Exactly as many bytes as `into` holds; fewer in the file are an error.
  void read_at(std::span<std::byte> into, std::uint64_t offset) const;
  std::uint64_t size() const;
  void truncate(std::uint64_t size);
  /// Make sure that the file may grow to `size` bytes, without changing what it holds. Where the file system
  /// cannot promise that, the free space decides.
  void reserve(std::uint64_t size);
  /// To the disk itself.
  void sync();
  /// A failure to close is a failure to write.
  void close();

 private:
  [[noreturn]] void fail(const char* doing, int error) const;
  std::string path_;
  int handle_ = -1;
};

std::string read_file(const std::string& path);

/// The file holds these bytes, or what it held before; never a part. The folder must exist.
void replace_file(const std::string& path, std::string_view bytes);
/// Give a complete file its name, replacing whatever had it, and make that last.
void rename_file(const std::string& from, const std::string& to);
/// Does nothing if there is no such file.
void remove_file(const std::string& path) noexcept;
void make_folder(const std::string& path);
/// A name for a file under construction, in the same folder; `.part` at its end.
std::string part_name(const std::string& path);

}  // namespace mpm::io
