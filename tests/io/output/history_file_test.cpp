#include "io/output/history_file.hpp"

#include <cmath>
#include <sstream>

#include <catch2/catch.hpp>

#include "core/step/stepper.hpp"
#include "core/step/totals.hpp"
#include "io/output/file.hpp"
#include "tests/io/output/small_model.hpp"

using namespace mpm;
using namespace mpm::tests;
using core::Column;

namespace {

std::vector<std::vector<double>> rows_of(const std::string& path) {
  std::istringstream in(io::read_file(path));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.front() == '#') continue;
    std::istringstream numbers(line);
    rows.emplace_back();
    for (std::string n; numbers >> n;) rows.back().push_back(std::strtod(n.c_str(), nullptr));
  }
  return rows;
}

core::TimeHistoryInput two_and_three() {
  core::TimeHistoryInput history;
  history.variables = {"pres", "posx"};
  history.particles = {{0.5, 0.5, 0.5}, {11, 11, 11}};
  history.points = {{0.25, 0.5, 0.5}, {6.5, 6.5, 6.5}, {-1, 0, 0}};
  return history;
}

/// Two particles in one cell and one in another, with the pressures 1, 2 and 3.
core::Model three_particles(core::SoloCommunication& solo, const std::array<core::Vec3<double>, 3>& positions,
                            const core::TimeHistoryInput& history = two_and_three()) {
  auto scene = small_scene();
  scene->output.histories.push_back(history);
  core::Model model = prepared_model(scene);
  std::vector<core::BrickCount> counts;
  for (const auto& x : positions) counts.push_back({model.grid->geometry().brick_at(x), 1});
  solo.bricks.partition(*model.grid, counts, {});
  for (std::size_t i = 0; i < 3; ++i) {
    const core::ColumnLayout& layout = model.bodies[0].pool->layout();
    std::vector<double> columns(static_cast<std::size_t>(layout.columns()));
    const auto set = [&](Column c, double v) {
      columns[static_cast<std::size_t>(layout.offset(c) / core::block_lanes)] = v;
    };
    for (int a = 0; a < 3; ++a) set(core::next(Column::position_x, a), positions[i][a]);
    set(Column::mass, static_cast<double>(i + 1));
    set(Column::pressure, static_cast<double>(i + 1));
    set(Column::identity, static_cast<double>(10 - i));
    auto& tiles = model.grid->brick(model.grid->find(counts[i].brick)).tiles;
    if (tiles.empty()) tiles.emplace_back().body = 0;
    core::append(*model.bodies[0].pool, tiles.back(), columns.data());
  }
  return model;
}

constexpr std::array<core::Vec3<double>, 3> at_start{{{0.25, 0.5, 0.5}, {0.75, 0.5, 0.5}, {10, 10, 10}}};

void set_position(core::Model& model, std::size_t brick, double x) {
  core::ParticleTile& tile = model.grid->bricks()[brick].tiles[0];
  core::BlockPool& pool = *model.bodies[0].pool;
  pool.block(tile.blocks[0])[pool.layout().offset(Column::position_x)] = x;
}

}  // namespace

TEST_CASE("Histories follow the nearest particles, and points average their cell") {
  const Folder folder("curv");
  core::SoloCommunication solo;
  core::Model model = three_particles(solo, at_start);
  io::HistoryFile file(folder / "a_curv.dat", model, {}, solo);
  // Both particles of the first cell are as near to the first point: the lower identity wins.
  CHECK(file.chosen_late().empty());
  file.add(model, solo);
  file.flush(solo);

  const std::vector<double> row = rows_of(folder / "a_curv.dat").at(0);
  const core::Energies energies = core::compute_energies(model, solo);
  // Weights 1 * 1 and 2 * 0.5 at the first point; nothing near the second; the third is outside.
  const std::vector<double> expected{
      0, 0, energies.kinetic, energies.internal, 2, 0.75, 1, 3, 10, 1, 1.5, 0.5, 0, 0, 0, 0};
  CHECK(row == expected);
  CHECK_THAT(io::read_file(folder / "a_curv.dat"),
             Catch::Contains("pres[particle2]") && Catch::Contains("posx[point3]") &&
                 Catch::Contains("# particle1: identity 9, nearest to (0.5, 0.5, 0.5)"));
}

TEST_CASE("A particle is followed into other bricks, and lost when it is gone") {
  const Folder folder("curv_follow");
  core::SoloCommunication solo;
  core::Model model = three_particles(solo, at_start);
  io::HistoryFile file(folder / "a_curv.dat", model, {}, solo);
  file.add(model, solo);
  // The particle that was far away jumps to the other end of the grid, and then vanishes.
  core::Model elsewhere = three_particles(solo, {{{0.25, 0.5, 0.5}, {4.5, 0.5, 0.5}, {1, 9, 1}}});
  file.add(elsewhere, solo);
  core::ParticleTile& tile = elsewhere.grid->brick(elsewhere.grid->find({0, 2, 0})).tiles[0];
  core::remove_swapping(*elsewhere.bodies[0].pool, tile, 0);
  file.add(elsewhere, solo);
  file.add(elsewhere, solo);
  file.flush(solo);
  const auto rows = rows_of(folder / "a_curv.dat");
  REQUIRE(rows.size() == 4);
  CHECK(rows[1][5] == 4.5);
  CHECK(rows[1][6] == 1);
  CHECK(rows[1][7] == 3);
  CHECK(rows[1][8] == 1);
  CHECK(rows[1][9] == 1);
  for (const std::size_t gone : {std::size_t{2}, std::size_t{3}}) {
    CHECK(rows[gone][7] == 3);  // what it was
    CHECK(rows[gone][8] == 1);
    CHECK(rows[gone][9] == 0);
    CHECK(rows[gone][5] == 4.5);
    CHECK(rows[gone][6] == 1);
  }
}

TEST_CASE("A particle that is gone stays so through a restart, and the log learns of it once") {
  const Folder folder("curv_gone");
  core::SoloCommunication solo;
  core::Model model = three_particles(solo, at_start);
  std::vector<std::uint64_t> tracked;
  {
    io::HistoryFile file(folder / "a_curv.dat", model, {}, solo);
    file.add(model, solo);
    CHECK(file.gone().empty());
    core::ParticleTile& tile = model.grid->bricks()[0].tiles[0];
    core::remove_swapping(*model.bodies[0].pool, tile, 1);  // identity 9
    model.clock.step = 1;
    file.add(model, solo);
    REQUIRE(file.gone().size() == 1);
    CHECK_THAT(file.gone()[0],
               Catch::Contains("step 1") && Catch::Contains("particle1") && Catch::Contains("(identity 9)"));
    file.add(model, solo);
    CHECK(file.gone().empty());
    tracked = file.tracked();
  }
  model.clock.step = 2;
  io::HistoryFile file(folder / "a_curv.dat", model, io::HistoryFile::Continuation{{1, {}}, tracked}, solo);
  CHECK(file.tracked() == tracked);
  file.add(model, solo);
  file.flush(solo);
  CHECK(file.gone().empty());
  const auto rows = rows_of(folder / "a_curv.dat");
  const std::vector<double> last(rows.back().begin() + 4, rows.back().begin() + 7);
  CHECK(last == std::vector<double>{2, 0.75, 0});
}

TEST_CASE("Without histories the file has the energies, and values beyond all numbers are cut") {
  const Folder folder("curv_energies");
  core::SoloCommunication solo;
  const core::Model plain = small_model(solo);
  io::HistoryFile energies(folder / "b_curv.dat", plain, {}, solo);
  CHECK_FALSE(energies.each_step());
  energies.add(plain, {3, 4}, solo);
  energies.flush(solo);
  CHECK(rows_of(folder / "b_curv.dat") == std::vector<std::vector<double>>{{120, 0.25, 3, 4}});

  core::Model model = three_particles(solo, at_start);
  io::HistoryFile file(folder / "a_curv.dat", model, {}, solo);
  CHECK(file.each_step());
  core::ParticleTile& tile = model.grid->bricks()[0].tiles[0];
  core::BlockPool& pool = *model.bodies[0].pool;
  for (int lane = 0; lane < 2; ++lane)
    pool.block(tile.blocks[0])[pool.layout().offset(Column::pressure) + lane] = 1.7e308;
  file.add(model, solo);
  pool.block(tile.blocks[0])[pool.layout().offset(Column::velocity_x)] = 1e200;
  CHECK_THROWS_AS(file.add(model, solo), core::NumericalFailure);
  file.flush(solo);
  const auto rows = rows_of(folder / "a_curv.dat");
  REQUIRE(rows.size() == 1);
  for (const double value : rows[0]) CHECK(std::isfinite(value));
  CHECK(rows[0][4] == 1.7e308);
}

TEST_CASE("Histories of a run that goes on follow the same particles") {
  const Folder folder("curv_continue");
  core::SoloCommunication solo;
  core::Model model = three_particles(solo, at_start);
  std::vector<std::uint64_t> tracked;
  {
    io::HistoryFile file(folder / "a_curv.dat", model, {}, solo);
    for (int step = 0; step < 5; ++step) {
      model.clock.step = step;
      file.add(model, solo);
    }
    tracked = file.tracked();
  }
  set_position(model, 0, 0.4);  // nearest now, but not then
  model.clock.step = 3;
  io::HistoryFile file(folder / "a_curv.dat", model, io::HistoryFile::Continuation{{2, {}}, tracked}, solo);
  CHECK(file.tracked() == tracked);
  file.add(model, solo);
  file.flush(solo);
  const auto rows = rows_of(folder / "a_curv.dat");
  REQUIRE(rows.size() == 4);
  CHECK(rows[3][0] == 3);
  CHECK(rows[3][4] == 2);
}

TEST_CASE("A run that goes on with another input follows the particles that it knows by their places") {
  const Folder folder("curv_other");
  core::SoloCommunication solo;
  const std::string path = folder / "a_curv.dat";
  core::Model before = three_particles(solo, at_start);
  io::HistoryFile first(path, before, {}, solo);
  first.add(before, solo);
  first.flush(solo);
  const io::HistoryFile::Continuation from{{0, {}}, first.tracked()};

  // Nearest to the first place is identity 10 now.
  const std::array<core::Vec3<double>, 3> later{{{0.4, 0.5, 0.5}, {3, 0.5, 0.5}, {10, 10, 10}}};
  core::TimeHistoryInput history = two_and_three();
  std::vector<std::string> legend;
  std::size_t chosen = 0;
  SECTION("in another order, and with a new one") {
    history.particles = {{11, 11, 11}, {0.5, 0.5, 0.5}, {0.25, 0.5, 0.5}};
    legend = {"particle1: identity 8,", "particle2: identity 9,", "particle3: identity 10,"};
    chosen = 1;
  }
  SECTION("a moved one is another") {
    history.particles[1] = {0.25, 0.5, 0.5};
    legend = {"particle1: identity 9,", "particle2: identity 10, nearest to (0.25, 0.5, 0.5)"};
    chosen = 1;
  }
  SECTION("a moved point") {
    history.points[0] = {0.75, 0.5, 0.5};
    legend = {"particle1: identity 9,", "point1: the cell around (0.75, 0.5, 0.5)"};
  }
  SECTION("with more variables") {
    history.variables.push_back("posy");
    legend = {"particle1: identity 9,", "particle2: identity 8,"};
  }
  core::Model model = three_particles(solo, later, history);
  model.clock.step = 1;
  io::HistoryFile file(path, model, from, solo);
  CHECK(file.chosen_late().size() == chosen);
  file.add(model, solo);
  file.flush(solo);
  // The columns mean other places: a new file.
  CHECK(rows_of(path).size() == 1);
  CHECK(rows_of(path + ".old").size() == 1);
  CHECK_THAT(file.notice(), Catch::Contains("does not have this run's"));
  for (const std::string& line : legend) CHECK_THAT(io::read_file(path), Catch::Contains(line));
}
