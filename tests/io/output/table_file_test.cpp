#include "io/output/table_file.hpp"

#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/io/output/small_model.hpp"

using namespace mpm;
using namespace mpm::tests;

namespace {

constexpr const char* head = "#    step value";

/// Ten rows of steps 0, 2, ... 18; `mark`: as after step 12.
struct Written {
  explicit Written(const std::string& file) : path(file) {
    io::TableFile table(file, "# comment\n", {}, head, {}, solo);
    for (int step = 0; step < 20; step += 2) {
      table.add(step, std::string("    ") + std::to_string(step) + " 1.5");
      if (step == 12) mark = table.mark();
    }
    table.sync(solo);
    good = io::read_file(path);
  }
  io::TableCut cut(std::int64_t last, bool with_mark = true) const {
    return io::cut_table(path, {}, head, {last, with_mark ? std::optional(mark) : std::nullopt});
  }
  void put(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }
  /// The table after the row of this step.
  std::string up_to(int step) const {
    const std::size_t at = good.find("    " + std::to_string(step) + " 1.5\n");
    return good.substr(0, good.find('\n', at) + 1);
  }

  std::string path;
  core::SoloCommunication solo;
  io::TableMark mark;
  std::string good;
};

}  // namespace

TEST_CASE("A table goes on after the row that its mark names") {
  const Folder folder("table_mark");
  Written table(folder / "a.sta");
  CHECK(io::TableMark::from(table.mark.text()) == table.mark);
  CHECK_FALSE(io::TableMark::from(""));
  const io::TableCut cut = table.cut(100);
  CHECK(cut.append);
  CHECK(cut.notice.empty());
  CHECK(cut.kept == table.mark);
  CHECK(io::read_file(table.path) == table.up_to(12));
  // What is kept of the rows up to an earlier step has a mark of its own, with which it goes on.
  const io::TableCut earlier = table.cut(9);
  CHECK(earlier.notice.empty());
  CHECK(earlier.kept.step == 8);
  CHECK(io::read_file(table.path) == table.up_to(8));
  table.mark = earlier.kept;
  CHECK(table.cut(9).notice.empty());
}

TEST_CASE("A table of a restart file without a mark is cut by its steps") {
  const Folder folder("table_plain");
  const Written table(folder / "a.sta");
  io::File(table.path, io::File::Mode::append).write("     1");
  CHECK(table.cut(7, false).notice.empty());
  CHECK(io::read_file(table.path) == table.up_to(6));
}

TEST_CASE("A table that was cut or emptied, or is gone, is said to be") {
  const Folder folder("table_cut");
  const Written table(folder / "a.sta");
  table.put(table.up_to(6) + "    8 1.");
  CHECK_THAT(table.cut(12).notice, Catch::Contains("a.sta' has 4 row(s) up to step 6, but had 7 row(s) up to "
                                                   "step 12 when the restart file was written"));
  CHECK(io::read_file(table.path) == table.up_to(6));
  table.put(std::string("# comment\n") + head + "\n");
  CHECK_THAT(table.cut(12).notice, Catch::Contains("has no rows, but had 7 row(s)"));
  table.put("");
  CHECK_THAT(table.cut(12).notice, Catch::Contains("a.sta' is empty; it had 7 row(s) up to step 12"));
  CHECK_FALSE(table.cut(12).append);
  table.put("# another\n#  step others\n 1 2\n");
  CHECK_THAT(table.cut(12).notice, Catch::Contains("does not have this run's columns: it has been renamed"));
  CHECK(std::filesystem::exists(table.path + ".old"));
  CHECK_THAT(table.cut(12).notice, Catch::Contains("a.sta' is missing; it had 7 row(s) up to step 12"));
}

TEST_CASE("A changed bit in a row is said, and the table goes on after its rows") {
  const Folder folder("table_bit");
  const Written table(folder / "a.sta");
  const std::size_t first = table.good.find("    0 1.5"), end = table.up_to(12).size();
  int unnoticed = 0, beyond = 0, lost = 0;
  for (std::size_t at = first; at < end; ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bad = table.good;
      bad[at] = static_cast<char>(bad[at] ^ (1 << bit));
      table.put(bad);
      const io::TableCut cut = table.cut(12);
      unnoticed += cut.notice.empty();
      beyond += cut.kept.step > 12;
      lost += std::filesystem::file_size(table.path) < table.up_to(10).size();
    }
  }
  CHECK(unnoticed == 0);
  CHECK(beyond == 0);
  CHECK(lost == 0);
}
