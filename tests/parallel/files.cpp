// Files that all ranks write and read together: the same contents on any number of ranks, and errors that all
// ranks report alike.
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <catch2/catch.hpp>

#include "core/step/totals.hpp"
#include "io/output/file.hpp"
#include "io/output/h5part.hpp"
#include "io/output/hdf5.hpp"
#include "io/output/history_file.hpp"
#include "io/output/particle_order.hpp"
#include "io/output/shared_rows.hpp"
#include "io/output/status_file.hpp"
#include "io/output/vtu.hpp"
#include "io/restart/restart.hpp"
#include "parallel/communication.hpp"
#include "tests/io/output/small_disk.hpp"
#include "tests/io/output/small_model.hpp"
#include "tests/parallel/world.hpp"

using namespace mpm;
using namespace mpm::tests;
using namespace mpm::parallel::test;

namespace {

/// One folder for all ranks.
class SharedFolder {
 public:
  SharedFolder(const std::string& name, core::Communication& exchange) : exchange_(exchange) {
    if (exchange.reductions.rank() == 0) mine_ = std::make_unique<Folder>(name);
    path_ = exchange.reductions.gather(mine_ ? mine_->path() : "").front();
  }
  ~SharedFolder() {
    exchange_.reductions.any(false);  // every rank has finished
  }
  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }

 private:
  core::Communication& exchange_;
  std::unique_ptr<Folder> mine_;
  std::string path_;
};

/// f() throws a FileError with the same text on every rank; the text.
template <class F>
std::string common_error(F f) {
  std::string text = "nothing was thrown";
  try {
    f();
  } catch (const io::FileError& e) { text = e.what(); }
  CHECK(same_on_all(text));
  return text;
}

std::string rows_of(const std::string& path) {
  std::istringstream in(io::read_file(path));
  std::string rows;
  for (std::string line; std::getline(in, line);) {
    if (line.front() != '#') rows += line + '\n';
  }
  return rows;
}

std::shared_ptr<core::Scene> scene_with_histories() {
  auto scene = small_scene();
  core::TimeHistoryInput& history = scene->output.histories.emplace_back();
  history.variables = {"seqv", "kelv", "velocity_2"};
  history.particles = {{1, 2, 3}, {11, 11, 11}, {6, 6, 6}};
  history.points = {{2, 2, 2}, {5, 7, 3}};
  return scene;
}

}  // namespace

TEST_CASE("A restart file is the same on any number of ranks, and is read on any") {
  parallel::MpiCommunication exchange(world());
  core::SoloCommunication solo;
  const SharedFolder folder("parallel_restart", exchange);
  const core::Model together = small_model(exchange), alone = small_model(solo);
  const std::uint64_t hash = io::state_hash(alone, solo);
  CHECK(io::state_hash(together, exchange) == hash);
  const std::string path =
      io::write_restart(folder.path(), "small", together, {"<PeneBlast/>", {4, 2}, {}}, exchange);
  CHECK(io::restart_state_hash(path) == hash);
  CHECK(io::read_restart_scene(path).text == "<PeneBlast/>");

  core::Model by_one = prepared_model(small_scene());
  io::read_restart(path, by_one, solo);
  CHECK(io::state_hash(by_one, solo) == hash);
  CHECK(by_one.ledger.external_work.value() == alone.ledger.external_work.value());
  CHECK(by_one.ledger.eroded == 5);

  core::Model by_all = prepared_model(small_scene());
  const io::RestartResult result = io::read_restart(path, by_all, exchange);
  CHECK(io::state_hash(by_all, exchange) == hash);
  CHECK(result.extra.tracked == std::vector<std::uint64_t>{4, 2});
  CHECK(core::compute_totals(by_all, exchange).eroded == 5);
  CHECK(core::compute_totals(by_all, exchange).external_work == alone.ledger.external_work.value());
  std::vector<std::string> notices;
  CHECK(io::find_newest_restart(folder.path(), "small", exchange, notices).value_or("") == path);
}

TEST_CASE("On another grid the state is the same on any number of ranks") {
  parallel::MpiCommunication exchange(world());
  core::SoloCommunication solo;
  const SharedFolder folder("parallel_regrid", exchange);
  const std::string path = io::write_restart(folder.path(), "small", small_model(exchange), {}, exchange);
  SmallSetup larger;
  larger.cells = 20;
  auto scene = small_scene();
  scene->components[1].bodies[0].deactivated = true;
  core::Model together = prepared_model(scene, larger), alone = prepared_model(scene, larger);
  io::read_restart(path, together, exchange);
  io::read_restart(path, alone, solo);
  CHECK(io::state_hash(together, exchange) == io::state_hash(alone, solo));
  const core::Totals a = core::compute_totals(together, exchange), b = core::compute_totals(alone, solo);
  CHECK(a.removed_kinetic == b.removed_kinetic);
  CHECK(a.removed_kinetic > 0);
}

TEST_CASE("Totals have the same bits on any number of ranks") {
  parallel::MpiCommunication exchange(world());
  core::SoloCommunication solo;
  const core::Model together = small_model(exchange), alone = small_model(solo);
  const core::Totals a = core::compute_totals(together, exchange), b = core::compute_totals(alone, solo);
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  CHECK(same(a.kinetic, b.kinetic));
  CHECK(same(a.internal, b.internal));
  CHECK(a.particles == b.particles);
  CHECK(a.failed == b.failed);
  for (int i = 0; i < 3; ++i) {
    CHECK(same(a.momentum[i], b.momentum[i]));
    CHECK(same(a.angular_momentum[i], b.angular_momentum[i]));
    CHECK(same(a.bodies[1].lower[i], b.bodies[1].lower[i]));
    CHECK(same(a.bodies[0].centre[i], b.bodies[0].centre[i]));
  }
  CHECK(core::compute_energies(together, exchange).internal == b.internal);
  CHECK(core::occupied_cells(together, exchange) == core::occupied_cells(alone, solo));
}

TEST_CASE("An .h5part file holds the same on any number of ranks") {
  parallel::MpiCommunication exchange(world());
  core::SoloCommunication solo;
  const SharedFolder folder("parallel_h5part", exchange);
  core::Model together = small_model(exchange), alone = small_model(solo);
  together.bodies[0].no_output = alone.bodies[0].no_output = true;
  const auto variables = io::variables_of({"tria", "com", "SigmaXY"});
  io::H5PartWriter writer({folder / "all.h5part", variables, false, {}}, together, exchange);
  for (int i = 0; i < 3; ++i) writer.write(together, exchange);
  std::string mark = exchange.reductions.gather(writer.mark(exchange)).front();
  writer.write(together, exchange);
  const io::H5PartWriter again({folder / "all.h5part", variables, false, mark}, together, exchange);
  CHECK(again.times() == 3);
  CHECK(again.notice().empty());
  if (world().rank() == 0) {
    io::H5PartWriter by_one({folder / "one.h5part", variables, false, {}}, alone, solo);
    for (int i = 0; i < 3; ++i) by_one.write(alone, solo);
    // Checksums included.
    CHECK(io::H5PartMark::from(by_one.mark(solo))->rows.back().checksum ==
          io::H5PartMark::from(mark)->rows.back().checksum);
    const io::hdf5::Handle all = io::hdf5::open_file(folder / "all.h5part", io::hdf5::Access::read);
    const io::hdf5::Handle one = io::hdf5::open_file(folder / "one.h5part", io::hdf5::Access::read);
    for (const char* name : {"x", "y", "velocity_2", "id", "body", "tria", "com", "SigmaXY"}) {
      const auto expected = io::hdf5::read_all_double(one, std::string("Step#0/") + name);
      CHECK(expected.size() == 301);
      CHECK(io::hdf5::read_all_double(all, std::string("Step#0/") + name) == expected);
      CHECK(io::hdf5::read_all_double(all, std::string("Step#2/") + name) == expected);
    }
  }
}

TEST_CASE("Ranks without particles write no .vtu piece") {
  parallel::MpiCommunication exchange(world());
  const SharedFolder folder("parallel_vtu", exchange);
  const core::Model model = small_model(exchange);
  io::VtuWriter({folder.path(), "small", true, {}, false, {}}, model, exchange).write(model, exchange);
  // The last body is one particle.
  const std::string index = io::read_file(folder / "small_vtu/small_dust_120.pvtu");
  CHECK(index.find("<Piece") == index.rfind("<Piece"));
  std::int64_t mine = std::filesystem::exists(
      folder / ("small_vtu/small_dust_120_" + std::to_string(world().rank()) + ".vtu"));
  exchange.reductions.sum(std::span(&mine, 1));
  CHECK(mine == 1);
}

TEST_CASE("Tables have the same rows on any number of ranks") {
  parallel::MpiCommunication exchange(world());
  core::SoloCommunication solo;
  const SharedFolder folder("parallel_tables", exchange);
  const auto scene = scene_with_histories();
  core::Model together = prepared_model(scene), alone = prepared_model(scene);
  fill(together, exchange);
  fill(alone, solo);
  io::HistoryFile history(folder / "all_curv.dat", together, {}, exchange);
  history.add(together, exchange);
  history.flush(exchange);
  io::StatusFile(folder / "all.sta", together, {}, exchange)
      .add(together, core::compute_totals(together, exchange), exchange);
  io::HistoryFile other(folder / ("one_curv.dat" + std::to_string(world().rank())), alone, {}, solo);
  other.add(alone, solo);
  other.flush(solo);
  CHECK(history.tracked() == other.tracked());
  io::StatusFile(folder / ("one.sta" + std::to_string(world().rank())), alone, {}, solo)
      .add(alone, core::compute_totals(alone, solo), solo);
  if (world().rank() == 0) {
    CHECK(rows_of(folder / "all_curv.dat") == rows_of(folder / "one_curv.dat0"));
    CHECK(rows_of(folder / "all.sta") == rows_of(folder / "one.sta0"));
  }
}

TEST_CASE("A full disk is the same error on every rank, and the last good file stays") {
  parallel::MpiCommunication exchange(world());
  const SharedFolder folder("parallel_full", exchange);
  core::Model model = small_model(exchange);
  const std::string good = io::write_restart(folder.path(), "small", model, {}, exchange);
  io::H5PartWriter writer({folder / "small.h5part", {}, false, {}}, model, exchange);
  writer.write(model, exchange);
  const std::uint64_t hash = io::restart_state_hash(good);
  model.clock.step = 240;
  {
    const SmallDisk disk(50000);
    CHECK_THAT(common_error([&] { io::write_restart(folder.path(), "small", model, {}, exchange); }),
               Catch::Contains("small_240.pe.part': File too large"));
    CHECK_THAT(common_error([&] { writer.write(model, exchange); }),
               Catch::Contains("small.h5part': File too large"));
  }
  CHECK(io::restart_state_hash(good) == hash);
  CHECK_FALSE(std::filesystem::exists(folder / "small_240.pe.part"));
  writer.write(model, exchange);
  CHECK(writer.times() == 2);
  // On one rank alone.
  io::VtuWriter vtu({folder.path(), "small", false, {}, false, {}}, model, exchange);
  const bool last_has_particles = model.local_particles() > 0;
  std::unique_ptr<SmallDisk> disk;
  if (world().rank() == world().size() - 1) disk = std::make_unique<SmallDisk>(100);
  if (exchange.reductions.any(disk && last_has_particles)) {
    CHECK_THAT(common_error([&] { vtu.write(model, exchange); }),
               Catch::Contains("_" + std::to_string(world().size() - 1) + ".vtu': File too large"));
  }
}

TEST_CASE("A write by all ranks together that fails, wherever it does, is an error on every rank") {
  parallel::MpiCommunication exchange(world());
  const SharedFolder folder("parallel_rows", exchange);
  const std::string path = folder / "a.h5";
  constexpr hsize_t rows_per_rank = 4000;
  const auto rank = static_cast<hsize_t>(world().rank());
  const hsize_t all = rows_per_rank * static_cast<hsize_t>(world().size());
  std::vector<io::RowBatch> batches;
  for (const hsize_t half : {hsize_t{0}, rows_per_rank / 2})
    batches.push_back({{{rank * rows_per_rank + half, rows_per_rank / 2}}, {}, rows_per_rank / 2});
  const io::SharedRows rows{"rows", sizeof(double), batches,
                            [](const io::RowBatch& batch, std::byte* memory) {
                              for (std::size_t i = 0; i < batch.particles; ++i) {
                                const double value = static_cast<double>(batch.rows[0].first + i);
                                std::memcpy(memory + i * sizeof value, &value, sizeof value);
                              }
                            }};
  const auto write = [&] { io::write_together(path, std::span(&rows, 1), exchange); };
  const auto make = [&] {
    io::together(exchange, [&] {
      if (rank != 0) return;
      io::hdf5::Handle file = io::hdf5::create_file(path);
      io::hdf5::create_dataset(file, "rows", H5T_IEEE_F64LE, std::span(&all, 1));
      file.close("write '" + path + "'");
    });
  };
  for (std::size_t room = 3000; room < sizeof(double) * all; room += 15000) {
    CAPTURE(room);
    make();
    {
      const SmallDisk disk(room);
      CHECK_THAT(common_error(write), Catch::StartsWith("cannot write '" + path + "'"));
    }
    CHECK(H5Fget_obj_count(hid_t{H5F_OBJ_ALL}, H5F_OBJ_ALL) == 0);
  }
  make();
  if (world().size() > 1) {
    // As if something else were in the file.
    io::SharedRows other = rows;
    other.fill = [&, calls = 0](const io::RowBatch& batch, std::byte* memory) mutable {
      rows.fill(batch, memory);
      if (calls++ == 0 && rank == 1) memory[77] ^= std::byte{1};
    };
    CHECK_THAT(common_error([&] { io::write_together(path, std::span(&other, 1), exchange); }),
               Catch::Contains("the data read back from 'rows' differ"));
  }
  write();
  io::together(exchange, [&] {
    const io::hdf5::Handle file = io::hdf5::open_file(path, io::hdf5::Access::read);
    const std::vector<double> found = io::hdf5::read_all_double(file, "rows");
    for (std::size_t i = 0; i < all; ++i) REQUIRE(found.at(i) == static_cast<double>(i));
  });
}

TEST_CASE("A damaged or missing restart file is the same error on every rank") {
  parallel::MpiCommunication exchange(world());
  const SharedFolder folder("parallel_damage", exchange);
  const std::string path = io::write_restart(folder.path(), "small", small_model(exchange), {}, exchange);
  const std::string bytes = io::read_file(path);
  core::Model copy = prepared_model(small_scene());
  const double x = small_particle(copy.bodies[0].pool->layout(), 7)[5];
  std::string bad = bytes;
  ++bad[bad.find(std::string(reinterpret_cast<const char*>(&x), sizeof x))];
  exchange.reductions.any(false);  // all have read it
  if (world().rank() == 0) std::ofstream(path, std::ios::binary) << bad;
  exchange.reductions.any(false);
  CHECK_THAT(common_error([&] { io::verify_restart(path, exchange); }),
             Catch::Contains("fail their checksum"));
  CHECK_THAT(common_error([&] { io::read_restart(path, copy, exchange); }),
             Catch::Contains("the particles of body 'bar' in brick ("));
  CHECK_THAT(common_error([&] { io::read_restart(folder / "none.pe", copy, exchange); }),
             Catch::Contains("none.pe': No such file"));
}
