#include "io/output/hdf5_driver.hpp"

#include <algorithm>
#include <cstring>
#include <memory>

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include "io/output/file.hpp"

namespace mpm::io::hdf5 {

namespace {

constexpr haddr_t largest_address = (haddr_t{1} << 63) - 1;

std::string first_failure;

/// HDF5 keeps its own part, and hands it back at every call.
struct OpenFile : H5FD_t {
  OpenFile(const char* path, File::Mode mode) : H5FD_t{}, file(path, mode), end(file.size()) {}
  File file;
  haddr_t end;            // of what is in the file
  haddr_t allocated = 0;  // end of what HDF5 has given out
};

OpenFile& of(H5FD_t* file) { return *static_cast<OpenFile*>(file); }
const OpenFile& of(const H5FD_t* file) { return *static_cast<const OpenFile*>(file); }

/// Whether f() did not throw; the first that does is remembered.
template <class F>
bool succeeds(F f) {
  try {
    f();
    return true;
  } catch (const std::exception& e) {
    if (first_failure.empty()) first_failure = e.what();
    return false;
  }
}

H5FD_t* open(const char* path, unsigned flags, hid_t, haddr_t) {
  first_failure.clear();
  std::unique_ptr<OpenFile> opened;
  succeeds([&] {
    if ((flags & H5F_ACC_TRUNC) != 0) File(path, File::Mode::write_anew);
    const bool change = (flags & H5F_ACC_RDWR) != 0;
    opened = std::make_unique<OpenFile>(path, change ? File::Mode::change : File::Mode::read);
  });
  return opened.release();
}

herr_t close(H5FD_t* file) {
  const std::unique_ptr<OpenFile> opened(&of(file));
  succeeds([&] { opened->file.close(); });
  return 0;
}

/// As of HDF5's own driver for one file.
herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t end_of_allocated(const H5FD_t* file, H5FD_mem_t) { return of(file).allocated; }
herr_t allocate_to(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  of(file).allocated = end;
  return 0;
}
haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) { return of(file).end; }

/// What lies beyond the end is zero.
herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* buffer) {
  const OpenFile& opened = of(file);
  const std::span<std::byte> into(static_cast<std::byte*>(buffer), size);
  const auto there = static_cast<std::size_t>(at < opened.end ? std::min<haddr_t>(size, opened.end - at) : 0);
  if (!succeeds([&] { opened.file.read_at(into.first(there), at); })) return -1;
  std::fill(into.begin() + static_cast<std::ptrdiff_t>(there), into.end(), std::byte{0});
  return 0;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* bytes) {
  if (!first_failure.empty()) return 0;
  OpenFile& opened = of(file);
  succeeds([&] {
    opened.file.write_at({static_cast<const char*>(bytes), size}, at);
    opened.end = std::max(opened.end, at + size);
  });
  return 0;
}

/// HDF5 lets a file end where what it has given out ends.
herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  OpenFile& opened = of(file);
  if (!first_failure.empty() || opened.end == opened.allocated) return 0;
  succeeds([&] {
    opened.file.truncate(opened.allocated);
    opened.end = opened.allocated;
  });
  return 0;
}

H5FD_class_t description() {
  H5FD_class_t d{};
#if H5_VERSION_GE(1, 13, 0)
  d.version = H5FD_CLASS_VERSION;
  d.value = H5_VFD_RESERVED;
#endif
  d.name = "mpm";
  d.maxaddr = largest_address;
  d.fc_degree = H5F_CLOSE_WEAK;
  d.open = open;
  d.close = close;
  d.query = query;
  d.get_eoa = end_of_allocated;
  d.set_eoa = allocate_to;
  d.get_eof = end_of_file;
  d.read = read;
  d.write = write;
  d.truncate = truncate;
  constexpr H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(map), std::end(map), d.fl_map);
  return d;
}

}  // namespace

hid_t driver() {
  static const H5FD_class_t all = description();
  static const hid_t id = H5FDregister(&all);
  return id;
}

std::string& failure() { return first_failure; }

}  // namespace mpm::io::hdf5
