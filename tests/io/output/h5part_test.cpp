#include "io/output/h5part.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
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
  core::SoloCommunication solo;
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
  core::SoloCommunication solo;
  const core::Model model = small_model(solo);
  io::H5PartWriter({folder / "a.h5part", {}, true, {}}, model, solo).write(model, solo);
  const hdf5::Handle file = hdf5::open_file(folder / "a.h5part", hdf5::Access::read);
  const std::vector<double> id = column(file, 0, "id"), y = column(file, 0, "y");
  CHECK(y[0] == small_particle(model.bodies[0].pool->layout(), static_cast<std::uint64_t>(id[0]))[1]);
}

TEST_CASE("What a 32-bit real does not hold is cut, counted and said once") {
  const Folder folder("h5part_cut");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  const core::ColumnLayout& layout = model.bodies[0].pool->layout();
  core::ParticleTile* tile = nullptr;
  for (core::Brick& brick : model.grid->bricks()) {
    if (!brick.tiles.empty() && brick.tiles[0].body == 0) tile = &brick.tiles[0];
  }
  double* block = model.bodies[0].pool->block(tile->blocks[0]);
  const auto id = static_cast<std::int64_t>(block[layout.offset(core::Column::identity)]);
  block[layout.offset(core::Column::pressure)] = -1e300;
  block[layout.offset(core::Column::s_xx)] = 1e200;  // whose square is beyond all numbers
  for (const bool double_precision : {false, true}) {
    io::H5PartWriter writer(
        {folder / "a.h5part", io::variables_of({"pres", "seqv", "tria", "epef"}), double_precision, {}},
        model, solo);
    writer.write(model, solo);
    CHECK_THAT(writer.warning(), Catch::Contains("step 120") && Catch::Contains("1 value(s) of seqv") &&
                                     !Catch::Contains("epef"));
    CHECK((writer.warning().find("of pres") == std::string::npos) == double_precision);
    writer.write(model, solo);
    CHECK(writer.warning().empty());
    CHECK_THAT(writer.cut_values().total("a"), Catch::Contains("2 value(s) of seqv"));

    const hdf5::Handle file = hdf5::open_file(folder / "a.h5part", hdf5::Access::read);
    for (const char* name : {"pres", "seqv", "tria", "epef"}) {
      for (const double value : column(file, 0, name)) CHECK(std::isfinite(value));
    }
    const std::vector<double> ids = column(file, 0, "id"), pressure = column(file, 0, "pres");
    const auto at = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin());
    CHECK(pressure[at] == (double_precision ? -1e300 : -double{std::numeric_limits<float>::max()}));
  }
}

TEST_CASE("Bodies without output are left out, and no particles at all are no error") {
  const Folder folder("h5part_left_out");
  core::SoloCommunication solo;
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

namespace {

/// A file of times 0, 0.5, ...; `mark`: as after the second.
struct Series {
  explicit Series(const std::string& file, int times) : path(file), model(small_model(solo)) {
    io::H5PartWriter writer({file, {}, false, {}}, model, solo);
    for (int n = 0; n < times; ++n) {
      write(writer, n);
      if (n == 1) {
        mark = writer.mark(solo);
        bytes = io::read_file(path);
      }
    }
  }
  void write(io::H5PartWriter& writer, int n) {
    model.clock.time = 0.5 * n;
    model.clock.step = 10 * n;
    writer.write(model, solo);
  }
  io::H5PartWriter go_on() { return {{path, {}, false, mark}, model, solo}; }
  void put(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }

  std::string path;
  core::SoloCommunication solo;
  core::Model model;
  std::string mark, bytes;
};

}  // namespace

TEST_CASE("A run that goes on makes the file what it was") {
  const Folder folder("h5part_continue");
  Series series(folder / "a.h5part", 4);
  REQUIRE(io::read_file(series.path).size() > series.bytes.size());
  io::H5PartWriter writer = series.go_on();
  CHECK(writer.times() == 2);
  CHECK(writer.last_step() == 10);
  CHECK(writer.notice().empty());
  CHECK(io::read_file(series.path) == series.bytes);
  series.write(writer, 3);
  writer.finish(series.solo);
  const hdf5::Handle file = hdf5::open_file(series.path, hdf5::Access::read);
  CHECK(names_in(file) == std::set<std::string>{"Step#0", "Step#1", "Step#2"});
  CHECK(hdf5::read_double(hdf5::open_group(file, "Step#2"), "TimeValue") == 1.5);
}

TEST_CASE("What a killed run left unfinished is gone from a file that goes on") {
  const Folder folder("h5part_unfinished");
  Series series(folder / "a.h5part", 2);
  {
    hdf5::Handle file = hdf5::open_file(series.path, hdf5::Access::change);
    const hdf5::Handle half = hdf5::create_group(file, "unfinished/step");
    const hsize_t rows = 1000;
    hdf5::create_dataset(half, "x", H5T_IEEE_F32LE, std::span(&rows, 1));
  }
  io::File(series.path, io::File::Mode::append).write(std::string(50000, 'x'));
  io::H5PartWriter writer = series.go_on();
  CHECK(writer.notice().empty());
  CHECK(io::read_file(series.path) == series.bytes);
}

TEST_CASE("No damage to an .h5part file reaches HDF5 or goes unnoticed") {
  const Folder folder("h5part_damage");
  Series series(folder / "a.h5part", 3);
  const std::string good = io::read_file(series.path);
  int repaired = 0, aside = 0, wrong = 0;
  // Every byte of what HDF5 needs in the file's head and a few hundred others.
  for (std::size_t at = 0; at < series.bytes.size(); at += at < 256 ? 5 : 997) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ (1 << (at % 8)));
    series.put(bad);
    const io::H5PartWriter writer = series.go_on();
    const bool as_it_was = io::read_file(series.path) == series.bytes;
    if (writer.notice().empty() && as_it_was && writer.times() == 2) {
      ++repaired;
    } else if (writer.times() == 0 && io::read_file(series.path + ".damaged") == bad &&
               writer.notice().find("fail their checksum") != std::string::npos) {
      ++aside;
    } else {
      ++wrong;
    }
  }
  CHECK(wrong == 0);
  CHECK(repaired > 100);  // tables
  CHECK(aside > 20);      // values
}

TEST_CASE("A file that cannot go on is put aside, whole") {
  const Folder folder("h5part_damaged");
  Series series(folder / "a.h5part", 2);
  for (const std::string& bad : {std::string("no HDF5"), std::string(), series.bytes.substr(0, 100000)}) {
    series.put(bad);
    io::H5PartWriter writer = series.go_on();
    CHECK(writer.times() == 0);
    CHECK_THAT(writer.notice(), Catch::Contains("a.h5part' has " + std::to_string(bad.size()) + " bytes") &&
                                    Catch::Contains("a.h5part.damaged', and a new file is started"));
    CHECK(io::read_file(series.path + ".damaged") == bad);
    series.write(writer, 0);
    CHECK(writer.times() == 1);
  }
  std::filesystem::remove(series.path);
  CHECK_THAT(series.go_on().notice(), Catch::Contains("a.h5part' is missing; it had 2 time(s)"));
}

TEST_CASE("A file with another history than the restart file's is put aside") {
  const Folder folder("h5part_other");
  Series series(folder / "a.h5part", 2);
  const std::string mark = series.mark;
  {
    // From an earlier restart file on, under other loads: the same times, other values.
    io::H5PartWriter writer({series.path, {}, false, {}}, series.model, series.solo);
    series.write(writer, 0);
    core::ParticleTile& tile = series.model.grid->brick(0).tiles[0];
    core::Body& body = series.model.bodies[static_cast<std::size_t>(tile.body)];
    body.pool->block(tile.blocks[0])[body.pool->layout().offset(core::Column::velocity_x)] += 1;
    series.write(writer, 1);
    series.write(writer, 2);
  }
  CHECK_THAT(series.go_on().notice(), Catch::Contains("does not belong to the restart file"));
}
