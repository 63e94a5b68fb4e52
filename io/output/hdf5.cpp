#include "io/output/hdf5.hpp"

#include <fmt/format.h>

namespace mpm::io::hdf5 {

namespace {

herr_t keep_innermost(unsigned n, const H5E_error2_t* error, void* text) {
  if (n == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

[[noreturn]] void fail(const std::string& doing) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &reason);
  H5Eclear2(H5E_DEFAULT);
  throw FileError(fmt::format("cannot {}: {}", doing, reason.empty() ? "HDF5 reports no reason" : reason));
}

Handle properties(hid_t cls) { return Handle(H5Pcreate(cls), H5Pclose, "create a property list"); }

Handle access_properties(Failure& failure) {
  [[maybe_unused]] static const herr_t silent = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  Handle list = properties(H5P_FILE_ACCESS);
  // Locks fail on some parallel file systems and would prevent viewers from reading a file during writing.
  check(H5Pset_file_locking(list, false, true), "disable file locks");
  use_driver(list, failure);
  return list;
}

/// Properties of groups with links in their header. HDF5 does this only if it tracks the order of creation.
Handle group_properties() {
  constexpr unsigned most_links = 256;
  Handle list = properties(H5P_GROUP_CREATE);
  check(H5Pset_link_creation_order(list, H5P_CRT_ORDER_TRACKED), "keep the order of links");
  check(H5Pset_link_phase_change(list, most_links, 0), "keep links in the header");
  return list;
}

Handle simple_space(std::span<const hsize_t> shape) {
  return Handle(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose,
                "create a dataspace");
}

template <class T>
void write_whole(hid_t parent, const std::string& name, hid_t file_type, hid_t memory_type,
                 std::span<const T> values) {
  const hsize_t n = values.size();
  const Handle dataset = create_dataset(parent, name, file_type, std::span(&n, 1));
  if (n == 0) return;
  check(H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        "write dataset '" + name + "'");
}

template <class Container>
Container read_whole(hid_t parent, const std::string& name, hid_t memory_type) {
  const Handle dataset = open_dataset(parent, name);
  const std::vector<hsize_t> shape = shape_of(dataset);
  Container values;
  if (shape.size() != 1) throw FileError("dataset '" + name + "' does not have one dimension");
  values.resize(shape[0]);
  if (values.empty()) return values;
  check(H5Dread(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
        "read dataset '" + name + "'");
  return values;
}

template <class T>
void write_scalar(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type, const T* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "create a dataspace");
  const Handle attribute(H5Acreate2(object, name.c_str(), file_type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, "create attribute '" + name + "'");
  check(H5Awrite(attribute, memory_type, value), "write attribute '" + name + "'");
}

Handle open_attribute(hid_t object, const std::string& name) {
  return Handle(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "open attribute '" + name + "'");
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "create a string type");
  check(H5Tset_size(type, length), "set the length of a string");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "set the encoding of a string");
  return type;
}

}  // namespace

Handle::Handle(hid_t id, Close closer, const std::string& doing, Failure failure)
    : id_(id), close_(closer), failure_(std::move(failure)) {
  if (id < 0 && failure_ && !failure_->empty()) throw FileError(*failure_);
  if (id < 0) fail(doing);
}

Handle& Handle::operator=(Handle&& other) noexcept {
  if (this != &other) {
    reset();
    id_ = std::exchange(other.id_, -1);
    close_ = other.close_;
    failure_ = std::move(other.failure_);
  }
  return *this;
}

void Handle::reset() noexcept {
  if (id_ >= 0) close_(id_);
  id_ = -1;
}

void Handle::close(const std::string& doing) {
  if (id_ < 0) return;
  const herr_t status = close_(std::exchange(id_, -1));
  if (failure_ && !failure_->empty()) throw FileError(*failure_);
  check(status, doing);
}

void check(herr_t status, const std::string& doing) {
  if (status < 0) fail(doing);
}

Handle open_file(const std::string& path, Access access) {
  Failure failure = std::make_shared<std::string>();
  const Handle list = access_properties(failure);
  const unsigned flags = access == Access::read ? H5F_ACC_RDONLY : H5F_ACC_RDWR;
  return Handle(H5Fopen(path.c_str(), flags, list), H5Fclose, "open '" + path + "'", failure);
}

Handle create_file(const std::string& path, hsize_t user_block, bool links) {
  Failure failure = std::make_shared<std::string>();
  const Handle list = access_properties(failure);
  const Handle creation = properties(H5P_FILE_CREATE);
  check(H5Pset_userblock(creation, user_block), "set the user block");
  if (links) {
    constexpr unsigned half_node = 512, tree = 16;  // links in half a leaf, branches in half a node
    constexpr std::size_t bytes_of_names = 32768;
    check(H5Pset_sym_k(creation, tree, half_node), "reserve space for links");
    check(H5Pset_local_heap_size_hint(creation, bytes_of_names), "reserve space for names");
  }
  return Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, list), H5Fclose, "create '" + path + "'",
                failure);
}

Handle create_group(hid_t parent, const std::string& name) {
  const Handle list = group_properties();
  return Handle(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, list, H5P_DEFAULT), H5Gclose,
                "create group '" + name + "'");
}

Handle open_group(hid_t parent, const std::string& name) {
  return Handle(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, "open group '" + name + "'");
}

Handle create_dataset(hid_t parent, const std::string& name, hid_t type, std::span<const hsize_t> shape) {
  const Handle space = simple_space(shape);
  const Handle list = properties(H5P_DATASET_CREATE);
  check(H5Pset_layout(list, H5D_CONTIGUOUS), "choose a contiguous layout");
  check(H5Pset_alloc_time(list, H5D_ALLOC_TIME_EARLY), "choose early allocation");
  check(H5Pset_fill_time(list, H5D_FILL_TIME_NEVER), "disable fill values");
  // Without creation times, so that the same content gives the same bytes.
  check(H5Pset_obj_track_times(list, false), "disable time stamps of datasets");
  return Handle(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, list, H5P_DEFAULT), H5Dclose,
                "create dataset '" + name + "'");
}

Handle open_dataset(hid_t parent, const std::string& name) {
  return Handle(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose, "open dataset '" + name + "'");
}

std::vector<hsize_t> shape_of(hid_t dataset) {
  const Handle space(H5Dget_space(dataset), H5Sclose, "get a dataspace");
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1) fail("get a dataset's shape");
  std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
  check(H5Sget_simple_extent_dims(space, shape.data(), nullptr), "get a dataset's shape");
  return shape;
}

Extent extent_of(hid_t dataset) {
  const hsize_t size = H5Dget_storage_size(dataset);
  if (size == 0) return {};
  const haddr_t offset = H5Dget_offset(dataset);
  if (offset == HADDR_UNDEF) fail("locate a dataset");
  return {offset, size};
}

bool has_link(hid_t parent, const std::string& name) {
  const htri_t found = H5Lexists(parent, name.c_str(), H5P_DEFAULT);
  if (found < 0) fail("look for '" + name + "'");
  return found > 0;
}

void rename_link(hid_t file, const std::string& from, const std::string& to) {
  check(H5Lmove(file, from.c_str(), H5L_SAME_LOC, to.c_str(), H5P_DEFAULT, H5P_DEFAULT),
        "rename '" + from + "' to '" + to + "'");
}

void write_all(hid_t parent, const std::string& name, std::span<const std::uint64_t> values) {
  write_whole(parent, name, H5T_STD_U64LE, H5T_NATIVE_UINT64, values);
}
void write_all(hid_t parent, const std::string& name, std::span<const std::int64_t> values) {
  write_whole(parent, name, H5T_STD_I64LE, H5T_NATIVE_INT64, values);
}
void write_all(hid_t parent, const std::string& name, std::span<const double> values) {
  write_whole(parent, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values);
}
void write_all(hid_t parent, const std::string& name, std::string_view bytes) {
  write_whole(parent, name, H5T_STD_U8LE, H5T_NATIVE_UCHAR, std::span<const char>(bytes));
}
std::vector<std::uint64_t> read_all_uint64(hid_t parent, const std::string& name) {
  return read_whole<std::vector<std::uint64_t>>(parent, name, H5T_NATIVE_UINT64);
}
std::vector<std::int64_t> read_all_int64(hid_t parent, const std::string& name) {
  return read_whole<std::vector<std::int64_t>>(parent, name, H5T_NATIVE_INT64);
}
std::vector<double> read_all_double(hid_t parent, const std::string& name) {
  return read_whole<std::vector<double>>(parent, name, H5T_NATIVE_DOUBLE);
}
std::string read_all_bytes(hid_t parent, const std::string& name) {
  return read_whole<std::string>(parent, name, H5T_NATIVE_UCHAR);
}

void write_attribute(hid_t object, const std::string& name, const std::string& value) {
  constexpr std::size_t longest = 60000;  // HDF5 holds attributes of less than 64 KiB
  const std::string text = value.substr(0, longest);
  const Handle type = text_type(text.size() + 1);
  write_scalar(object, name, type, type, text.c_str());
}
void write_attribute(hid_t object, const std::string& name, double value) {
  write_scalar(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}
void write_attribute(hid_t object, const std::string& name, std::int64_t value) {
  write_scalar(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}
void write_attribute(hid_t object, const ProvenanceLines& lines) {
  for (const auto& [name, value] : lines) write_attribute(object, name, value);
}

std::string read_string(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, "get the type of attribute '" + name + "'");
  std::string value(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, value.data()), "read attribute '" + name + "'");
  value.resize(std::min(value.find('\0'), value.size()));
  return value;
}
double read_double(hid_t object, const std::string& name) {
  double value = 0;
  check(H5Aread(open_attribute(object, name), H5T_NATIVE_DOUBLE, &value), "read attribute '" + name + "'");
  return value;
}
bool has_attribute(hid_t object, const std::string& name) { return H5Aexists(object, name.c_str()) > 0; }

std::int64_t read_int64(hid_t object, const std::string& name) {
  std::int64_t value = 0;
  check(H5Aread(open_attribute(object, name), H5T_NATIVE_INT64, &value), "read attribute '" + name + "'");
  return value;
}

}  // namespace mpm::io::hdf5
