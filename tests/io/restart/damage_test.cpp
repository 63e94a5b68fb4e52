// Bad luck: damaged, cut and foreign files, full disks, runs that were killed while writing.
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>
#include <omp.h>
#include <signal.h>
#include <sys/wait.h>

#include "io/output/file.hpp"
#include "io/output/particle_order.hpp"
#include "io/restart/restart.hpp"
#include "tests/io/output/small_disk.hpp"
#include "tests/io/output/small_model.hpp"
#include "tests/support/effort.hpp"

using namespace mpm;
using namespace mpm::tests;

namespace {

core::Model at_step(core::Communication& exchange, std::int64_t step, int particles = 40) {
  SmallSetup setup;
  setup.particles = particles;
  core::Model model = prepared_model(small_scene(), setup);
  fill(model, exchange, setup);
  model.clock.step = step;
  return model;
}

std::string fault(const std::string& path) {
  core::SoloCommunication solo;
  core::Model copy = prepared_model(small_scene());
  try {
    io::read_restart(path, copy, solo);
  } catch (const io::FileError& e) { return e.what(); }
  return {};
}

std::vector<std::string> files_in(const Folder& folder) {
  std::vector<std::string> names;
  for (const auto& e : std::filesystem::directory_iterator(folder.path()))
    names.push_back(e.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void wait_for(const std::string& path) {
  for (int i = 0; i < 20000 && !std::filesystem::exists(path); ++i) ::usleep(10000);
}

}  // namespace

TEST_CASE("No byte of a restart file can change unnoticed") {
  const Folder folder("restart_bytes");
  core::SoloCommunication solo;
  const std::string path =
      io::write_restart(folder.path(), "small", at_step(solo, 1), {"<PeneBlast/>", {1}, {{"a", "2"}}}, solo);
  const std::string good = io::read_file(path);
  REQUIRE(fault(path).empty());
  REQUIRE(good.size() > 20000);
  int unnoticed = 0, tried = 0;
  constexpr std::size_t in_head = brief_tests ? 7 : 1, elsewhere = brief_tests ? 199 : 23;
  for (std::size_t at = 0; at < good.size(); at += at < 600 ? in_head : elsewhere, ++tried) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ (1 << (at % 8)));
    std::ofstream(path, std::ios::binary) << bad;
    const std::string text = fault(path);
    if (text.find("small_1.pe") == std::string::npos || text.find("damaged") == std::string::npos)
      ++unnoticed;
  }
  CHECK(tried > (brief_tests ? 150 : 1000));
  CHECK(unnoticed == 0);
}

TEST_CASE("A restart file that was cut anywhere says so") {
  const Folder folder("restart_cut");
  core::SoloCommunication solo;
  const std::string path = io::write_restart(folder.path(), "small", at_step(solo, 1), {}, solo);
  const std::uint64_t size = std::filesystem::file_size(path);
  std::filesystem::resize_file(path, size - 1);
  CHECK_THAT(fault(path), Catch::Contains("is damaged: it has " + std::to_string(size - 1) +
                                          " bytes instead of " + std::to_string(size)));
  std::filesystem::resize_file(path, 600);
  CHECK_THAT(fault(path), Catch::Contains("has 600 bytes instead of"));
  std::filesystem::resize_file(path, 100);
  CHECK_THAT(fault(path), Catch::Contains("has 100 bytes, too few"));
  std::filesystem::resize_file(path, 0);
  CHECK_THAT(fault(path), Catch::Contains("has 0 bytes, too few"));
}

TEST_CASE("Each part of a restart file has a fault of its own") {
  const Folder folder("restart_parts");
  core::SoloCommunication solo;
  const std::string path =
      io::write_restart(folder.path(), "small", at_step(solo, 1), {"here is the scene", {}, {}}, solo);
  const std::string good = io::read_file(path);
  const auto after_change_at = [&](std::size_t at) {
    std::string bad = good;
    ++bad[at];
    std::ofstream(path, std::ios::binary) << bad;
    return fault(path);
  };
  CHECK_THAT(after_change_at(30), Catch::Contains("its first block fails its checksum"));
  CHECK_THAT(after_change_at(good.find("here is the scene")),
             Catch::Contains("its tables fail their checksum"));
  const double x = small_particle(prepared_model(small_scene()).bodies[0].pool->layout(), 0)[5];
  const std::size_t row = good.find(std::string(reinterpret_cast<const char*>(&x), sizeof x));
  REQUIRE(row != std::string::npos);
  CHECK_THAT(after_change_at(row), Catch::Contains("the particles of body 'bar' in brick (") &&
                                       Catch::Contains("fail their checksum"));
  std::ofstream(path, std::ios::binary) << std::string(5000, 'x');
  CHECK_THAT(fault(path), Catch::Contains("is not a restart file, or its first block is damaged"));
  CHECK_THAT(fault(folder / "nothing.pe"), Catch::Contains("nothing.pe': No such file"));
}

TEST_CASE("The newest two restart files are kept") {
  const Folder folder("restart_two");
  core::SoloCommunication solo;
  std::ofstream(folder / "small_3.pe.part") << "left by a run that was killed";
  std::ofstream(folder / "small_x.pe") << "somebody else's";
  std::ofstream(folder / "small_2_3.pe") << "another job's";
  for (const int step : {10, 20, 30})
    io::write_restart(folder.path(), "small", at_step(solo, step), {}, solo);
  CHECK(files_in(folder) ==
        std::vector<std::string>{"small_20.pe", "small_2_3.pe", "small_30.pe", "small_x.pe"});
  // Written last counts, not the number: the run was started again from an earlier step.
  io::write_restart(folder.path(), "small", at_step(solo, 5), {}, solo);
  CHECK(files_in(folder) ==
        std::vector<std::string>{"small_2_3.pe", "small_30.pe", "small_5.pe", "small_x.pe"});
  std::vector<std::string> notices;
  CHECK(io::find_newest_restart(folder.path(), "small", solo, notices) == folder / "small_5.pe");
  CHECK(notices.empty());
}

TEST_CASE("The newest restart file that is whole is found") {
  const Folder folder("restart_find");
  core::SoloCommunication solo;
  std::vector<std::string> notices;
  CHECK_FALSE(io::find_newest_restart(folder.path(), "small", solo, notices));
  io::write_restart(folder.path(), "small", at_step(solo, 10), {}, solo);
  const std::string newest = io::write_restart(folder.path(), "small", at_step(solo, 20), {}, solo);
  // One bit of the last particle: only the checksum of its rows can tell.
  std::string bytes = io::read_file(newest);
  const double x = small_particle(prepared_model(small_scene()).bodies[1].pool->layout(), 41)[4];
  ++bytes[bytes.find(std::string(reinterpret_cast<const char*>(&x), sizeof x))];
  std::ofstream(newest, std::ios::binary) << bytes;
  CHECK(io::find_newest_restart(folder.path(), "small", solo, notices) == folder / "small_10.pe");
  REQUIRE(notices.size() == 1);
  CHECK_THAT(notices[0],
             Catch::Contains("skipped: the restart file") && Catch::Contains("small_20.pe' is damaged"));
}

TEST_CASE("On a full disk the last good restart file stays, and nothing half-written") {
  const Folder folder("restart_full");
  core::SoloCommunication solo;
  const std::string good = io::write_restart(folder.path(), "small", at_step(solo, 10), {}, solo);
  const std::uint64_t hash = io::restart_state_hash(good);
  const std::uint64_t size = std::filesystem::file_size(good);
  for (const std::uint64_t room : {std::uint64_t{0}, std::uint64_t{300}, size / 2, size - 1}) {
    const SmallDisk disk(room);
    CHECK_THROWS_WITH(io::write_restart(folder.path(), "small", at_step(solo, 20), {}, solo),
                      Catch::Contains("small_20.pe.part") && Catch::Contains("File too large"));
  }
  CHECK(files_in(folder) == std::vector<std::string>{"small_10.pe"});
  CHECK(io::restart_state_hash(good) == hash);
  io::write_restart(folder.path(), "small", at_step(solo, 30), {}, solo);
  CHECK(fault(folder / "small_30.pe").empty());
}

TEST_CASE("A full file system is survived, too") {
  const FullFileSystem disk(2000000);
  if (!disk) {
    WARN("skipped: " << disk.reason());
    return;
  }
  core::SoloCommunication solo;
  std::string newest;
  // Two are kept, a third does not fit beside them.
  CHECK_THROWS_WITH(
      [&] {
        for (const int step : {10, 20, 30})
          newest = io::write_restart(disk.path(), "small", at_step(solo, step, 2000), {}, solo);
      }(),
      Catch::Contains("small_30.pe.part': No space left on device"));
  std::vector<std::string> notices;
  CHECK(io::find_newest_restart(disk.path(), "small", solo, notices).value_or("") ==
        disk.path() + "/small_20.pe");
  CHECK(notices.empty());
}

TEST_CASE("A run that is killed while it writes leaves the earlier file") {
  const Folder folder("restart_killed");
  core::SoloCommunication solo;
  io::write_restart(folder.path(), "small", at_step(solo, 1), {}, solo);
  const core::Model model = at_step(solo, 2, 5000);
  std::optional<std::string> found;
  for (int i = 0; i < 20; ++i) {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      omp_set_num_threads(1);  // the other threads have stayed behind
      for (;;) io::write_restart(folder.path(), "small", model, {}, solo);
    }
    if (i == 19) wait_for(folder / "small_2.pe");
    ::usleep(static_cast<useconds_t>(3000 + 1700 * i));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    std::vector<std::string> notices;
    found = io::find_newest_restart(folder.path(), "small", solo, notices);
    REQUIRE(found);
    CHECK(notices.empty());
    CHECK(fault(*found).empty());
  }
  CHECK(*found == folder / "small_2.pe");  // it was really writing
}
