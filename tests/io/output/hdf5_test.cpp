#include "io/output/hdf5.hpp"

#include <chrono>
#include <filesystem>
#include <numeric>
#include <thread>

#include <catch2/catch.hpp>

#include "io/output/file.hpp"
#include "tests/io/output/small_disk.hpp"
#include "tests/io/output/small_model.hpp"

using namespace mpm;
using namespace mpm::tests;
namespace hdf5 = mpm::io::hdf5;

namespace {

std::vector<double> numbers() {
  std::vector<double> values(2000);
  std::iota(values.begin(), values.end(), 0.5);
  return values;
}

void write_file(const std::string& path) {
  hdf5::Handle file = hdf5::create_file(path, 512);
  {
    const hdf5::Handle group = hdf5::create_group(file, "group");
    hdf5::write_attribute(group, "text", std::string(3000, 'x'));
    for (const char* name : {"a", "b", "c"}) hdf5::write_all(group, name, std::span<const double>(numbers()));
  }
  file.close("write '" + path + "'");
}

/// Files, groups and datasets that HDF5 holds open.
ssize_t held_open() { return H5Fget_obj_count(hid_t{H5F_OBJ_ALL}, H5F_OBJ_ALL); }

}  // namespace

TEST_CASE("Wherever a write inside HDF5 fails, it is reported with its reason, and HDF5 goes on") {
  const Folder folder("hdf5_full");
  write_file(folder / "good.h5");
  const std::uint64_t size = std::filesystem::file_size(folder / "good.h5");
  REQUIRE(size > 48000);
  for (std::uint64_t room = 0; room < size; room += 700) {
    CAPTURE(room, size);
    {
      const SmallDisk disk(room);
      CHECK_THROWS_WITH(write_file(folder / "bad.h5"),
                        Catch::StartsWith("cannot write '" + folder / "bad.h5" + "': File too large"));
    }
    CHECK(held_open() == 0);
  }
  write_file(folder / "bad.h5");
  CHECK((io::read_file(folder / "bad.h5") == io::read_file(folder / "good.h5")));
}

TEST_CASE("A file's bytes do not depend on when it was written") {
  const Folder folder("hdf5_times");
  write_file(folder / "early.h5");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 counts whole seconds
  write_file(folder / "late.h5");
  CHECK((io::read_file(folder / "early.h5") == io::read_file(folder / "late.h5")));
}

TEST_CASE("After a write has failed, nothing more is written to the file, whatever becomes of others") {
  const Folder folder("hdf5_order");
  write_file(folder / "a.h5");
  write_file(folder / "b.h5");
  const std::string good = io::read_file(folder / "a.h5");
  hdf5::Handle file = hdf5::open_file(folder / "a.h5", hdf5::Access::change);
  {
    const SmallDisk disk(good.size());
    hdf5::write_all(file, "more", std::span<const double>(numbers()));
  }
  {
    hdf5::Handle other = hdf5::open_file(folder / "b.h5", hdf5::Access::change);
    hdf5::write_all(other, "more", std::span<const double>(numbers()));
    hdf5::rename_link(file, "more", "most");
    other.close("write b");
  }
  CHECK_THROWS_WITH(file.close("write a"), Catch::Contains("a.h5': File too large"));
  CHECK(held_open() == 0);
  CHECK(io::read_file(folder / "a.h5") == good);
  CHECK(hdf5::read_all_double(hdf5::open_file(folder / "b.h5", hdf5::Access::read), "more") == numbers());
}

TEST_CASE("A file that is missing or is not of HDF5 is named") {
  const Folder folder("hdf5_open");
  CHECK_THROWS_WITH(hdf5::open_file(folder / "none.h5", hdf5::Access::read),
                    Catch::Contains("none.h5") && Catch::Contains("No such file"));
  io::replace_file(folder / "text.h5", "not a file of HDF5");
  CHECK_THROWS_WITH(hdf5::open_file(folder / "text.h5", hdf5::Access::read), Catch::Contains("text.h5"));
  CHECK(held_open() == 0);
  write_file(folder / "text.h5");
  CHECK(hdf5::read_all_double(hdf5::open_file(folder / "text.h5", hdf5::Access::read), "group/b") ==
        numbers());
}
