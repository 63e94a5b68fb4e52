// The files themselves: replaced as a whole, errors that say why, a disk that is full.
#include <csignal>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>
#include <sys/resource.h>

#include "io/output/file.hpp"
#include "io/output/h5part.hpp"
#include "io/output/log.hpp"
#include "io/output/provenance.hpp"
#include "io/output/status_file.hpp"
#include "io/output/vtu.hpp"
#include "tests/io/output/small_disk.hpp"
#include "tests/io/output/small_model.hpp"

using namespace mpm;
using namespace mpm::tests;

TEST_CASE("A file is replaced as a whole") {
  const Folder folder("replace");
  io::replace_file(folder / "a", "one");
  io::replace_file(folder / "a", "two");
  CHECK(io::read_file(folder / "a") == "two");
  CHECK_FALSE(std::filesystem::exists(folder / "a.part"));
}

TEST_CASE("An error names the file and the reason") {
  CHECK_THROWS_WITH(io::replace_file("/nowhere/a", ""),
                    "cannot write '/nowhere/a.part': No such file or directory");
  CHECK_THROWS_WITH(io::read_file("/nowhere/a"), "cannot read '/nowhere/a': No such file or directory");
  core::SoloCommunication solo;
  CHECK_THROWS_AS(io::Log("/nowhere/a.out", false, false, solo), io::FileError);
}

TEST_CASE("Reserving space leaves contents and errors leave nothing reserved") {
  const Folder folder("reserve");
  io::replace_file(folder / "a", "text");
  {
    io::File file(folder / "a", io::File::Mode::change);
    file.reserve(100000);
    CHECK(file.size() == 100000);
    file.truncate(4);
    const SmallDisk disk(50000);
    CHECK_THROWS_WITH(file.reserve(100000), Catch::Contains("File too large"));
    CHECK(file.size() == 4);
  }
  CHECK(io::read_file(folder / "a") == "text");
}

TEST_CASE("On a full disk the texts say so when they are flushed") {
  const Folder folder("full_text");
  core::SoloCommunication solo;
  io::Log log(folder / "a.out", false, false, solo);
  log.say("{} fits", 1);
  log.flush(solo);
  {
    const SmallDisk disk(1000);
    log.note("{}", std::string(2000, 'x'));
    CHECK_THROWS_WITH(log.flush(solo), Catch::Contains("a.out") && Catch::Contains("File too large"));
  }
  CHECK_THAT(io::read_file(folder / "a.out"), Catch::StartsWith("1 fits\n"));
}

TEST_CASE("On a full disk an .h5part file keeps its earlier times and may go on later") {
  const Folder folder("full_h5part");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  io::H5PartWriter writer({folder / "a.h5part", {}, false, {}}, model, solo);
  writer.write(model, solo);
  const std::string good = io::read_file(folder / "a.h5part");
  {
    const SmallDisk disk(good.size() + 20000);
    CHECK_THROWS_WITH(writer.write(model, solo),
                      Catch::Contains("a.h5part") && Catch::Contains("File too large"));
  }
  CHECK(io::read_file(folder / "a.h5part") == good);
  writer.write(model, solo);
  CHECK(writer.times() == 2);
  io::H5PartWriter again({folder / "a.h5part", {}, false, writer.mark(solo)}, model, solo);
  CHECK(again.times() == 2);
}

TEST_CASE("On a full disk the list of .vtu files names only what is whole") {
  const Folder folder("full_vtu");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  io::VtuWriter writer({folder.path(), "small", false, {}, false, {}}, model, solo);
  writer.write(model, solo);
  const std::string good = io::read_file(folder / "small.pvd");
  {
    const SmallDisk disk(10000);
    model.clock.step = 121;
    CHECK_THROWS_WITH(writer.write(model, solo), Catch::Contains("small_121_0.vtu"));
  }
  CHECK(io::read_file(folder / "small.pvd") == good);
  CHECK_FALSE(std::filesystem::exists(folder / "small_vtu/small_121_0.vtu"));
}

TEST_CASE("A file system that is really full") {
  const FullFileSystem disk(1 << 20);
  if (!disk) {
    WARN("skipped: " << disk.reason());
    return;
  }
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  io::H5PartWriter writer({disk.path() + "/a.h5part", {}, false, {}}, model, solo);
  int written = 0;
  try {
    for (;; ++written) writer.write(model, solo);
  } catch (const io::FileError& e) {
    CHECK_THAT(e.what(), Catch::Contains("No space left on device") && Catch::Contains("free disk space"));
  }
  CHECK(written > 10);
  io::H5PartWriter again({disk.path() + "/a.h5part", {}, false, writer.mark(solo)}, model, solo);
  CHECK(again.times() == written);
}

TEST_CASE("Facts for XML cannot break it") {
  const auto lines = io::provenance_of(*small_scene());
  const std::string comment = io::to_xml_comment(lines);
  CHECK(comment.find("--", 4) == comment.rfind("-->"));
  CHECK_THAT(comment, Catch::Contains("heading: A <small> model -_ of & for tests"));
  CHECK(io::xml_escaped("a<b>&\"c\n") == "a&lt;b&gt;&amp;&quot;c ");
  CHECK(io::safe_name("a/b c") == "a_b_c");
  CHECK(io::safe_name("..") == "_..");
  using Names = std::vector<std::string>;
  CHECK(io::distinct_names({"a b", "c", "a_b", "a/b"}, "body") ==
        Names{"a_b_body0", "c", "a_b_body2", "a_b_body3"});
  CHECK(io::distinct_names({"a b", "a_b", "a_b_body0"}, "body") ==
        Names{"a_b_body0_", "a_b_body1", "a_b_body0"});
  const std::string wide = "\u6e29";  // three bytes
  std::string word;
  for (int i = 0; i < 100; ++i) word += wide;
  const Names cut = io::distinct_names({word, "short"}, "body", 20);
  CHECK(cut == Names{wide + wide + wide + wide + "_body0", "short"});
}
