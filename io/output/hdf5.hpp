// Thin RAII wrappers of the C interface of HDF5: handles, attributes, datasets. On this rank only. Every
// return code is checked; a failure is a FileError with the system's reason or the library's innermost
// message. Failed writes are reported when the file is closed (hdf5_driver.hpp). A failed write corrupts a
// file, so space is reserved (File::reserve) before HDF5 writes. HDF5 creates the structure and gives the
// offsets of the values; all ranks write the particles' rows there without it (shared_rows.hpp).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "io/output/file.hpp"
#include "io/output/hdf5_driver.hpp"
#include "io/output/provenance.hpp"

namespace mpm::io::hdf5 {

class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  /// Throws if `id` is not valid; `doing` describes the attempt: "open dataset 'x'".
  /// `failure`: of a file.
  Handle(hid_t id, Close closer, const std::string& doing, Failure failure = nullptr);
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, -1)), close_(other.close_), failure_(std::move(other.failure_)) {}
  Handle& operator=(Handle&& other) noexcept;
  ~Handle() { reset(); }

  operator hid_t() const { return id_; }
  /// Closing a file writes the remaining data. Throws the first failure since it was opened.
  void close(const std::string& doing);

 private:
  void reset() noexcept;
  hid_t id_ = -1;
  Close close_ = nullptr;
  Failure failure_;
};

void check(herr_t status, const std::string& doing);

enum class Access { read, change };
Handle open_file(const std::string& path, Access access);
/// A new file. With `links` the root group has space for about a thousand links, so that another link changes
/// few places of the file and needs no new space.
Handle create_file(const std::string& path, hsize_t user_block = 0, bool links = false);

/// The links of the group are stored in its header.
Handle create_group(hid_t parent, const std::string& name);
Handle open_group(hid_t parent, const std::string& name);
/// Contiguous, allocated at once and not filled. `shape` has one or two entries.
Handle create_dataset(hid_t parent, const std::string& name, hid_t type, std::span<const hsize_t> shape);
Handle open_dataset(hid_t parent, const std::string& name);
std::vector<hsize_t> shape_of(hid_t dataset);
/// Offset of a contiguous dataset's values in the file.
Extent extent_of(hid_t dataset);

bool has_link(hid_t parent, const std::string& name);
/// Renames an object without reading it.
void rename_link(hid_t file, const std::string& from, const std::string& to);

/// Complete one-dimensional datasets, for data of one rank.
void write_all(hid_t parent, const std::string& name, std::span<const std::uint64_t> values);
void write_all(hid_t parent, const std::string& name, std::span<const std::int64_t> values);
void write_all(hid_t parent, const std::string& name, std::span<const double> values);
void write_all(hid_t parent, const std::string& name, std::string_view bytes);
std::vector<std::uint64_t> read_all_uint64(hid_t parent, const std::string& name);
std::vector<std::int64_t> read_all_int64(hid_t parent, const std::string& name);
std::vector<double> read_all_double(hid_t parent, const std::string& name);
std::string read_all_bytes(hid_t parent, const std::string& name);

void write_attribute(hid_t object, const std::string& name, const std::string& value);
void write_attribute(hid_t object, const std::string& name, double value);
void write_attribute(hid_t object, const std::string& name, std::int64_t value);
void write_attribute(hid_t object, const ProvenanceLines& lines);
std::string read_string(hid_t object, const std::string& name);
double read_double(hid_t object, const std::string& name);
std::int64_t read_int64(hid_t object, const std::string& name);
/// Whether the object has an attribute of this name.
bool has_attribute(hid_t object, const std::string& name);

}  // namespace mpm::io::hdf5
