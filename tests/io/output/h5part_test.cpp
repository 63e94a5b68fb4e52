#include "io/output/h5part.hpp"

#include <cstring>
#include <fstream>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "io/output/file.hpp"
#include "io/output/hdf5.hpp"
#include "tests/io/output/small_model.hpp"

using namespace mpm;
using namespace mpm::tests;
namespace hdf5 = mpm::io::hdf5;

namespace {

std::vector<double> column(hid_t file, int step, const std::string& name) {
  return hdf5::read_all_double(file, "Step#" + std::to_string(step) + "/" + name);
}

/// Class and bytes of a dataset's type.
std::pair<H5T_class_t, std::size_t> type_of(hid_t file, const std::string& name) {
  const hdf5::Handle data = hdf5::open_dataset(file, name);
  const hdf5::Handle type(H5Dget_type(data), H5Tclose, "get a type");
  return {H5Tget_class(type), H5Tget_size(type)};
}

std::set<std::string> names_in(hid_t group) {
  std::set<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t {
    static_cast<std::set<std::string>*>(to)->insert(name);
    return 0;
  };
  hdf5::check(H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &names), "list a group");
  return names;
}

}  // namespace

TEST_CASE("An h5part file holds every particle of every time") {
  const Folder folder("h5part");
  core::SoloExchange solo;
  core::Model model = small_model(solo);
  io::H5PartWriter writer(
      {folder / "a.h5part", io::variables_of({"seqv", "fail", "velocity_1", "body"}), false, {}}, model,
      solo);
  writer.write(model, solo);
  model.clock.time = 0.5;
  model.clock.step = 240;
  writer.write(model, solo);

  const hdf5::Handle file = hdf5::open_file(folder / "a.h5part", hdf5::Access::read);
  CHECK(names_in(file) == std::set<std::string>{"Step#0", "Step#1", "unfinished"});
  CHECK(hdf5::read_string(file, "input_hash") == "0123456789abcdef");
  CHECK(hdf5::read_string(file, "length_unit") == "mm");
  const hdf5::Handle second = hdf5::open_group(file, "Step#1");
  CHECK(hdf5::read_double(second, "TimeValue") == 0.5);
  CHECK(hdf5::read_int64(second, "step") == 240);
  CHECK(names_in(second) == std::set<std::string>{"x", "y", "z", "velocity_0", "velocity_1", "velocity_2",
                                                  "id", "body", "seqv", "fail"});
  CHECK(type_of(second, "x") == std::pair{H5T_FLOAT, std::size_t{4}});
  CHECK(type_of(second, "id") == std::pair{H5T_INTEGER, std::size_t{8}});
  CHECK(type_of(second, "body") == std::pair{H5T_INTEGER, std::size_t{4}});

  const std::vector<double> id = column(file, 1, "id"), x = column(file, 1, "x"),
                            body = column(file, 1, "body");
  const std::vector<double> v = column(file, 0, "velocity_2");
  REQUIRE(id.size() == 601);
  CHECK(std::set<double>(id.begin(), id.end()).size() == 601);
  CHECK(std::is_sorted(body.begin(), body.end()));
  for (std::size_t i = 0; i < id.size(); ++i) {
    const auto b = static_cast<std::size_t>(id[i] / 300);
    const std::vector<double> p =
        small_particle(model.bodies[b].pool->layout(), static_cast<std::uint64_t>(id[i]));
    if (body[i] != static_cast<double>(b) || x[i] != static_cast<float>(p[0]) ||
        v[i] != static_cast<float>(p[5])) {
      FAIL("particle " << id[i]);
    }
  }
}

TEST_CASE("Reals are in double precision when asked for") {
  const Folder folder("h5part_double");
  core::SoloExchange solo;
  const core::Model model = small_model(solo);
  io::H5PartWriter({folder / "a.h5part", {}, true, {}}, model, solo).write(model, solo);
  const hdf5::Handle file = hdf5::open_file(folder / "a.h5part", hdf5::Access::read);
  const std::vector<double> id = column(file, 0, "id"), y = column(file, 0, "y");
  CHECK(y[0] == small_particle(model.bodies[0].pool->layout(), static_cast<std::uint64_t>(id[0]))[1]);
}

TEST_CASE("Bodies without output are left out, and no particles at all are no error") {
  const Folder folder("h5part_left_out");
  core::SoloExchange solo;
  core::Model model = small_model(solo);
  model.bodies[0].no_output = true;
  io::H5PartWriter writer({folder / "a.h5part", {}, false, {}}, model, solo);
  writer.write(model, solo);
  model.bodies[1].no_output = model.bodies[2].no_output = true;
  writer.write(model, solo);
  const hdf5::Handle file = hdf5::open_file(folder / "a.h5part", hdf5::Access::read);
  CHECK(column(file, 0, "id").size() == 301);
  CHECK(column(file, 0, "id").front() >= 300);
  CHECK(column(file, 1, "id").empty());
}

TEST_CASE("A run that goes on keeps the times up to its start and drops later ones") {
  const Folder folder("h5part_continue");
  core::SoloExchange solo;
  core::Model model = small_model(solo);
  {
    io::H5PartWriter writer({folder / "a.h5part", {}, false, {}}, model, solo);
    for (const double t : {0.0, 0.5, 1.0, 1.5}) {
      model.clock.time = t;
      writer.write(model, solo);
    }
  }
  io::H5PartWriter writer({folder / "a.h5part", {}, false, 0.5}, model, solo);
  CHECK(writer.times() == 2);
  CHECK(writer.notice().empty());
  model.clock.time = 0.75;
  writer.write(model, solo);
  const hdf5::Handle file = hdf5::open_file(folder / "a.h5part", hdf5::Access::read);
  CHECK(names_in(file) == std::set<std::string>{"Step#0", "Step#1", "Step#2", "lost#0", "unfinished"});
  CHECK(hdf5::read_double(hdf5::open_group(file, "Step#2"), "TimeValue") == 0.75);
}

TEST_CASE("A file that cannot be continued is put aside") {
  const Folder folder("h5part_damaged");
  core::SoloExchange solo;
  const core::Model model = small_model(solo);
  std::ofstream(folder / "a.h5part") << "no HDF5";
  io::H5PartWriter writer({folder / "a.h5part", {}, false, 1.0}, model, solo);
  CHECK(writer.times() == 0);
  CHECK_THAT(writer.notice(), Catch::Contains("a.h5part.damaged"));
  CHECK(io::read_file(folder / "a.h5part.damaged") == "no HDF5");
  writer.write(model, solo);
  CHECK(writer.times() == 1);
}
