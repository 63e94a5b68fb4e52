#include "io/output/hdf5_driver.hpp"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <span>

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include "io/output/file.hpp"
#include "io/output/hdf5.hpp"

namespace mpm::io::hdf5 {

namespace {

constexpr haddr_t largest_address = (haddr_t{1} << 63) - 1;

/// Settings that the access list passes to open().
struct Settings {
  Failure* failure;
};

/// HDF5 owns the base part and passes it to every call.
struct OpenFile : H5FD_t {
  OpenFile(const char* path, File::Mode mode, Failure f)
      : H5FD_t{}, file(path, mode), failure(std::move(f)), end(file.size()) {}
  File file;
  Failure failure;
  haddr_t end;            // end of the file's contents
  haddr_t allocated = 0;  // end of the space that HDF5 has allocated
};

OpenFile& of(H5FD_t* file) { return *static_cast<OpenFile*>(file); }
const OpenFile& of(const H5FD_t* file) { return *static_cast<const OpenFile*>(file); }

/// True if f() did not throw; the first exception is recorded.
template <class F>
bool succeeds(std::string& failure, F f) {
  try {
    f();
    return true;
  } catch (const std::exception& e) {
    if (failure.empty()) failure = e.what();
    return false;
  }
}

/// H5Fcreate first tests whether the file exists.
H5FD_t* open(const char* path, unsigned flags, hid_t access_list, haddr_t) {
  const Failure& failure = *static_cast<const Settings*>(H5Pget_driver_info(access_list))->failure;
  failure->clear();
  std::unique_ptr<OpenFile> opened;
  succeeds(*failure, [&] {
    if ((flags & H5F_ACC_TRUNC) != 0) File(path, File::Mode::write_anew);
    const bool change = (flags & H5F_ACC_RDWR) != 0;
    opened = std::make_unique<OpenFile>(path, change ? File::Mode::change : File::Mode::read, failure);
  });
  return opened.release();
}

herr_t close(H5FD_t* file) {
  const std::unique_ptr<OpenFile> opened(&of(file));
  succeeds(*opened->failure, [&] { opened->file.close(); });
  return 0;
}

/// Buffering as for a plain file; any other single-file driver can read the result.
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

/// Bytes beyond the end read as zero. A failure is returned like HDF5's own.
herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* buffer) {
  const OpenFile& opened = of(file);
  const std::span<std::byte> into(static_cast<std::byte*>(buffer), size);
  const auto there = static_cast<std::size_t>(at < opened.end ? std::min<haddr_t>(size, opened.end - at) : 0);
  std::string failure;
  if (!succeeds(failure, [&] { opened.file.read_at(into.first(there), at); })) {
    H5Epush2(H5E_DEFAULT, __FILE__, __func__, __LINE__, H5E_ERR_CLS, H5E_IO, H5E_READERROR, "%s",
             failure.c_str());
    return -1;
  }
  std::fill(into.begin() + static_cast<std::ptrdiff_t>(there), into.end(), std::byte{0});
  return 0;
}

herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* bytes) {
  OpenFile& opened = of(file);
  if (!opened.failure->empty()) return 0;
  succeeds(*opened.failure, [&] {
    opened.file.write_at({static_cast<const char*>(bytes), size}, at);
    opened.end = std::max(opened.end, at + size);
  });
  return 0;
}

/// When closed, a file is truncated to the space that HDF5 has allocated; until then it keeps its reserved
/// space.
herr_t truncate(H5FD_t* file, hid_t, hbool_t closing) {
  OpenFile& opened = of(file);
  const bool right = closing ? opened.end == opened.allocated : opened.end >= opened.allocated;
  if (right || !opened.failure->empty()) return 0;
  succeeds(*opened.failure, [&] {
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
  d.fapl_size = sizeof(Settings);
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

void use_driver(hid_t access_list, Failure& failure) {
  static const H5FD_class_t all = description();
  static const hid_t id = H5FDregister(&all);
  const Settings settings{&failure};
  check(H5Pset_driver(access_list, id, &settings), "choose the driver for files");
}

}  // namespace mpm::io::hdf5
