#include "io/output/status_file.hpp"

#include <sstream>

#include <catch2/catch.hpp>

#include "io/output/file.hpp"
#include "tests/io/output/small_model.hpp"

using namespace mpm;
using namespace mpm::tests;

namespace {

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;

  explicit Table(const std::string& path) {
    std::istringstream in(io::read_file(path));
    std::string head;
    for (std::string line; std::getline(in, line);) {
      if (line.front() == '#') {
        head = line;
        continue;
      }
      std::istringstream numbers(line);
      rows.emplace_back();
      for (std::string n; numbers >> n;) rows.back().push_back(std::strtod(n.c_str(), nullptr));
    }
    std::istringstream names(head.substr(1));
    for (std::string n; names >> n;) columns.push_back(n);
  }
  double at(std::size_t row, const std::string& column) const {
    const auto found = std::find(columns.begin(), columns.end(), column);
    REQUIRE(found != columns.end());
    return rows.at(row).at(static_cast<std::size_t>(found - columns.begin()));
  }
};

}  // namespace

TEST_CASE("The columns of .sta are named, and its numbers are exact") {
  const Folder folder("sta");
  core::SoloCommunication solo;
  auto scene = small_scene();
  scene->output.statistics = {true, true};
  core::Model model = prepared_model(scene);
  fill(model, solo);
  const core::Totals totals = core::compute_totals(model, solo);
  io::StatusFile file(folder / "a.sta", model, {}, solo);
  file.add(model, totals, solo);
  file.add(model, totals, solo);
  CHECK(file.rows_added() == 2);

  const Table table(folder / "a.sta");
  REQUIRE(table.rows.size() == 2);
  CHECK(table.rows[0].size() == table.columns.size());
  CHECK(table.columns.size() == 11 + 8 * (3 + 2) + 3);
  CHECK(table.at(0, "step") == 120);
  CHECK(table.at(0, "time") == 0.25);
  CHECK(table.at(0, "dt") == 1e-3);
  CHECK(table.at(0, "kinetic") == totals.kinetic);
  CHECK(table.at(0, "internal") == totals.internal);
  CHECK(table.at(0, "total") == totals.kinetic + totals.internal);
  CHECK(table.at(0, "external_work") == 1e20);
  CHECK(table.at(0, "relative_drift") == core::energy_balance(totals, 1e6).relative_drift);
  CHECK(table.at(0, "pz") == totals.momentum.z);
  CHECK(table.at(0, "py[body:wall__&__floor]") == totals.bodies[1].momentum.y);
  CHECK(table.at(0, "vx[body:bar]") == totals.bodies[0].velocity.x);
  CHECK(table.at(0, "kinetic[material:copper]") == totals.bodies[0].kinetic + totals.bodies[2].kinetic);
  CHECK(table.at(0, "internal[material:wax]") == totals.bodies[1].internal);
  CHECK(table.at(0, "memory_max") > 1e6);
  CHECK(table.at(0, "cell_occupancy") > 0.1);
  CHECK(table.at(0, "cell_occupancy") <= 601.0 / (12 * 12 * 12));
}

TEST_CASE("Bodies whose names differ by characters alone that no name of a column has") {
  const Folder folder("sta_names");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  model.bodies[0].name = "a b";
  model.bodies[1].name = "a_b";
  model.bodies[2].name = "a/b";
  io::StatusFile file(folder / "a.sta", model, {}, solo);
  const std::vector<std::string> columns = Table(folder / "a.sta").columns;
  for (const char* column : {"px[body:a_b_body0]", "px[body:a_b_body1]", "px[body:a_b_body2]"})
    CHECK(std::count(columns.begin(), columns.end(), column) == 1);
}

TEST_CASE(".sta of a run that goes on keeps the rows up to its start") {
  const Folder folder("sta_continue");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  const core::Totals totals = core::compute_totals(model, solo);
  {
    io::StatusFile file(folder / "a.sta", model, {}, solo);
    for (const int step : {0, 10, 20, 30}) {
      model.clock.step = step;
      file.add(model, totals, solo);
    }
  }
  // A last line that was cut short is dropped, whatever its number.
  io::File(folder / "a.sta", io::File::Mode::append).write("      1");
  {
    io::StatusFile file(folder / "a.sta", model, io::TableContinuation{20, {}}, solo);
    model.clock.step = 25;
    file.add(model, totals, solo);
  }
  const Table table(folder / "a.sta");
  REQUIRE(table.rows.size() == 4);
  CHECK(table.rows[2][0] == 20);
  CHECK(table.rows[3][0] == 25);
}

TEST_CASE(".sta with other columns is put aside") {
  const Folder folder("sta_other");
  core::SoloCommunication solo;
  core::Model model = small_model(solo);
  io::StatusFile(folder / "a.sta", model, {}, solo).add(model, core::compute_totals(model, solo), solo);
  model.bodies.pop_back();
  io::StatusFile(folder / "a.sta", model, io::TableContinuation{1000, {}}, solo);
  CHECK(Table(folder / "a.sta").rows.empty());
  CHECK(Table(folder / "a.sta.old").rows.size() == 1);
}
