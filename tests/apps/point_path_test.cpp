// The path language of mpm_point, its table, picture and comparison.

#include "apps/common/point_path.hpp"

#include <fstream>

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "apps/common/point_table.hpp"
#include "io/input/material_reader.hpp"
#include "physics/catalogue.hpp"
#include "physics/material/material.hpp"

namespace {

using namespace mpm;
using physics::Leg;

std::vector<Leg> path(std::string_view text, int repeat = 1) {
  return apps::parse_path(text, {.rate = 2, .steps = 50, .repeat = repeat});
}

std::string fault(std::string_view text) {
  try {
    path(text);
  } catch (const apps::PathError& error) { return error.what(); }
  return "none";
}

/// A file that is gone afterwards.
struct TemporaryFile {
  std::string name = fmt::format("point_path_{}.txt", getpid());
  explicit TemporaryFile(std::string_view text) { std::ofstream(name) << text; }
  ~TemporaryFile() { std::remove(name.c_str()); }
};

TEST_CASE("legs of a path", "[path]") {
  const std::vector<Leg> one = path("uniaxial-stress 0.2 rate 1000 steps 10");
  REQUIRE(one.size() == 1);
  CHECK(one[0].kind == "uniaxial_stress");
  CHECK(*one[0].strain == 0.2);
  CHECK(one[0].rate == 1000);
  CHECK(one[0].steps == 10);
  CHECK(one[0].from_zero);
  CHECK(one[0].controls.size() == 1);

  // Several numbers and legs of one kind count from one zero; another kind has its own; a hold stands
  // between.
  const std::vector<Leg> run =
      path("uniaxial_stress 0.01 -0.01; hold time 3; uniaxial_stress 0.02; hydrostatic 0.1;");
  REQUIRE(run.size() == 5);
  CHECK(run[0].from_zero);
  for (const std::size_t i : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) CHECK(!run[i].from_zero);
  CHECK(run[4].from_zero);
  CHECK(run[0].rate == 2);
  CHECK(run[0].steps == 50);
  CHECK(*run[2].time == 3);
  CHECK(path("uniaxial_stress 0.01 -0.01", 3).size() == 6);

  // The lateral pressure comes first, once.
  const std::vector<Leg> triaxial = path("triaxial -0.1 confining 10; triaxial -0.05 confining 10");
  REQUIRE(triaxial.size() == 3);
  CHECK(triaxial[0].kind == "pressure");
  CHECK(*triaxial[0].time == Approx(0.1 / 2));
  CHECK(triaxial[0].controls[0].target == -10);
  CHECK(triaxial[1].from_zero);
  CHECK(triaxial[1].controls[0].target == -10);
  CHECK(!triaxial[2].from_zero);
  CHECK(path("triaxial -0.1 confining 10; triaxial -0.1 confining 20").size() == 4);

  const std::vector<Leg> by_stress = path("uniaxial_stress stress 100 time 5");
  REQUIRE(by_stress[0].controls.size() == 2);
  CHECK(by_stress[0].controls[0].target == 100);
  CHECK(by_stress[0].controls[0].ramp);
  CHECK(!by_stress[0].strain);

  const std::vector<Leg> mixed = path("mixed e_xx=0.01 s_yy=-20 e_xy=0.003 s_zz=0 time 2");
  CHECK(mixed[0].direction.xx == 0.01);
  CHECK(mixed[0].direction.xy == 0.003);
  CHECK(mixed[0].direction.yx == 0.003);
  CHECK(mixed[0].controls.size() == 2);
  CHECK(mixed[0].controls[0].target == -20);
}

TEST_CASE("faults about a path", "[path]") {
  CHECK(fault("uniaxal_stress 1") ==
        "path \"uniaxal_stress 1\": unknown path 'uniaxal_stress'; did you mean 'uniaxial_stress'?; expected "
        "one of uniaxial_stress, uniaxial_strain, triaxial, biaxial, equibiaxial, simple_shear, hydrostatic, "
        "pressure, mixed, hold, table");
  CHECK(fault("uniaxial_stress") ==
        "path \"uniaxial_stress\": expected: uniaxial_stress E [E...] [rate R | time T] [steps N]");
  CHECK(fault("uniaxial_stress 0.1 rat 1") ==
        "path \"uniaxial_stress 0.1 rat 1\": 'rat' is neither a number nor an option; did you mean 'rate'?");
  CHECK(fault("uniaxial_stress 0.1 rate") ==
        "path \"uniaxial_stress 0.1 rate\": 'rate' must be followed by a number");
  CHECK(fault("hydrostatic 0.1; uniaxial_stress 0.1 rate 0") ==
        "path \"uniaxial_stress 0.1 rate 0\": rate 0 must be greater than 0");
  CHECK(fault("uniaxial_stress 0.1 rate 1 time 1") ==
        "path \"uniaxial_stress 0.1 rate 1 time 1\": has both a rate and a time: give one of them");
  CHECK(fault("uniaxial_stress 0.1 steps 1.5") ==
        "path \"uniaxial_stress 0.1 steps 1.5\": steps 1.5 must be a whole number of at least 1");
  CHECK(fault("uniaxial_stress stress 1") ==
        "path \"uniaxial_stress stress 1\": a leg that ends at a stress requires a time (or a rate of the "
        "stress)");
  CHECK(fault("uniaxial_stress 0.1 stress 1 time 1") ==
        "path \"uniaxial_stress 0.1 stress 1 time 1\": gives both a strain and a stress as the end: give one "
        "of them");
  CHECK(fault("hydrostatic 0.1 confining 1") ==
        "path \"hydrostatic 0.1 confining 1\": only triaxial and biaxial have a confining pressure");
  CHECK(
      fault("hydrostatic stress 1 time 1") ==
      "path \"hydrostatic stress 1 time 1\": only uniaxial_stress and simple_shear end at a stress; 'mixed' "
      "prescribes any other");
  CHECK(fault("triaxial 0.1") ==
        "path \"triaxial 0.1\": requires the lateral pressure, as in: triaxial -0.05 confining 10");
  CHECK(fault("pressure 5 rate 1") ==
        "path \"pressure 5 rate 1\": a leg that ends at a pressure takes a time, not a rate");
  CHECK(fault("mixed e_xx=1") == "path \"mixed e_xx=1\": requires a time");
  CHECK(fault("mixed 1 time 1") == "path \"mixed 1 time 1\": expected: mixed e_xx=0.01 s_yy=-10 ... time T");
  CHECK(fault("mixed e_xx=1 s_xx=2 time 1") == "path \"mixed e_xx=1 s_xx=2 time 1\": xx is prescribed twice");
  CHECK(fault("mixed v_xx=1 time 1") ==
        "path \"mixed v_xx=1 time 1\": 'v_xx' is not a component; expected e_ (strain) or s_ (stress) "
        "followed by xx, yy, zz, xy, yz or xz");
  CHECK(fault("hold 5") == "path \"hold 5\": expected: hold time T");
  CHECK(fault("table") == "path \"table\": expected: table FILE");
  CHECK(fault("table none.csv") == "table none.csv: cannot be read");
  CHECK(fault(" ; ") == "the path is empty; as in: --path \"uniaxial_stress 0.2 rate 1000\"");
}

TEST_CASE("tables of deformation gradients", "[path]") {
  const auto said = [](std::string_view text) {
    const TemporaryFile file(text);
    const std::string message = fault("table " + file.name);
    const std::size_t at = message.find(file.name);
    return at == message.npos ? message : message.substr(at + file.name.size());
  };
  CHECK(said("t,F11\n0,1,0,0,0,1,0,0,0,1\n1 1 0.5 0 0 1 0 0 0 1\n") == "none");
  CHECK(said("0,1,0,0,0,1,0,0,0,1\n") == ": fewer than two rows of numbers");
  CHECK(said("0,1,0,0,0,1,0,0,0\n") == ", line 1: 9 numbers, expected time and nine of F");
  CHECK(said("0,1,0,0,0,x,0,0,0,1\n") == ", line 1: 'x' is not a number");
  CHECK(said("0,1,0,0,0,1,0,0,0,1\n0,1,0,0,0,1,0,0,0,1\n") == ", line 2: the time does not increase");
  CHECK(said("0,1.01,0,0,0,1,0,0,0,1\n1,1.02,0,0,0,1,0,0,0,1\n") ==
        ", line 1: the first F is not the identity, 1 0 0 0 1 0 0 0 1: begin with the undeformed material");
  CHECK(said("0,1,0,0,0,-1,0,0,0,1\n") == ", line 1: the determinant of F is not positive");
}

TEST_CASE("the table has names, units and values in one order", "[path]") {
  const auto choice = io::library_material("OFHC-Cu-JC", "mm g ms", physics::catalogue());
  const auto material = physics::make_material(choice.material);
  physics::PointDriver point(*material, {.extra_columns = {core::Column::yield_stress}});
  const apps::PointTable table(point, choice.units);
  std::string text = table.heading();
  std::vector<apps::PointSample> samples;
  REQUIRE(physics::walk(point, path("uniaxial_stress 0.1"), [&](const physics::PathPoint& at) {
            text = table.heading() + table.row(at);
            samples.push_back(apps::sample(point, at));
          }).reached);
  std::vector<std::vector<std::string>> lines(1);
  for (const char c : text) {
    if (lines.back().empty()) lines.back().emplace_back();
    if (c == '\n') lines.emplace_back();
    if (c == ',') lines.back().emplace_back();
    if (c != '\n' && c != ',') lines.back().back() += c;
  }
  REQUIRE(lines.size() == 4);  // and the end of the last
  REQUIRE(lines[0].size() == lines[1].size());
  REQUIRE(lines[0].size() == lines[2].size());
  const auto cell = [&](std::string_view name) {
    for (std::size_t i = 0; i < lines[0].size(); ++i)
      if (lines[0][i] == name) return std::pair{lines[1][i], std::stod(lines[2][i])};
    FAIL("no column " << name);
    throw 0;
  };
  CHECK(cell("time") == std::pair<std::string, double>{"ms", point.time()});
  CHECK(cell("stress_xx") == std::pair<std::string, double>{"MPa", point.stress().xx});
  CHECK(cell("strain_xx").second == Approx(0.1));
  CHECK(cell("density") == std::pair<std::string, double>{"g/mm^3", point.density()});
  CHECK(cell("sound_speed").first == "mm/ms");
  CHECK(cell("temperature") == std::pair<std::string, double>{"K", point.value(core::Column::temperature)});
  CHECK(cell("leg").second == 1);
  CHECK(apps::PointTable(point, {}).unit("stress") == "stress");  // where the input does not say

  // Points of the curve itself have no misfit; points moved by d have the misfit d.
  const apps::Curve curve = apps::stress_strain(samples);
  CHECK(!curve.shear);
  std::vector<apps::Measurement> measured{curve.points[10], curve.points[20], {0.5, 1.0}};
  CHECK(apps::misfit(curve, measured).points == 2);
  CHECK(apps::misfit(curve, measured).rms < 1e-12 * curve.points[20].stress);
  for (apps::Measurement& m : measured) m.stress += 7;
  CHECK(apps::misfit(curve, measured).rms == Approx(7));

  const std::string svg = apps::plot("a <b> & c", samples, measured, "MPa");
  CHECK(svg.find("a &lt;b&gt; &amp; c") != svg.npos);
  for (const char* piece : {"stress_xx (MPa)", "von Mises stress q (MPa)", "volume V/V0", "</svg>"})
    CHECK(svg.find(piece) != svg.npos);
  std::size_t curves = 0, marks = 0;
  for (std::size_t at = 0; (at = svg.find("<polyline", at)) != svg.npos; ++at) ++curves;
  for (std::size_t at = 0; (at = svg.find("<circle", at)) != svg.npos; ++at) ++marks;
  CHECK(curves == 3);
  CHECK(marks == 3);
  CHECK(svg.find("nan") == svg.npos);
}

TEST_CASE("measurements from a file", "[path]") {
  const auto read = [](std::string_view text) {
    const TemporaryFile file(text);
    return apps::read_measurements(file.name);
  };
  const auto rows = read("strain,stress\n0.1,100\n0.2;200 extra\n\n.3\t300\n");
  REQUIRE(rows.size() == 3);
  CHECK(rows[2].strain == 0.3);
  CHECK(rows[2].stress == 300);
  CHECK(read("stress,time,strain\n5,6,7\n")[0].strain == 7);
  CHECK(read("stress,time,strain\n5,6,7\n")[0].stress == 5);
  CHECK_THROWS_WITH(read("strain,stress\n"), Catch::Contains("no line of strain and stress"));
  CHECK_THROWS_WITH(read("0.1\n"), Catch::Contains("line 1: expected strain and stress"));
  CHECK_THROWS_WITH(apps::read_measurements("none.csv"), Catch::Contains("cannot be read"));
}

}  // namespace
