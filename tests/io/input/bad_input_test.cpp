// What holds for every element and attribute: one wrong input per rule, with all the faults that it must
// bring, and how faults are written down.

#include <catch2/catch.hpp>

#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;
using test::check_faults;

TEST_CASE("the unchanged input is right") {
  CHECK(test::faults(test::bar) == std::vector<std::string>{"ok"});
}

TEST_CASE("names and occurrences") {
  check_faults({
      {"<Solution>",
       "<Sollution/><Solution>",
       {"line 25: <Sollution>: no such element in <PeneBlast>; did you mean 'Solution'?"}},
      {"<Solution>",
       "<solution/><Solution>",
       {"line 25: <solution>: no such element in <PeneBlast>; did you mean 'Solution'?"}},
      {"<Solution>",
       "<Gravity ax='0' ay='0' az='1'/><Solution>",
       {"line 25: <Gravity>: belongs in <Solution>, not in <PeneBlast>"}},
      {"<Solution>",
       "<Contact enable='0'/><Contact enable='0'/><Solution>",
       {"line 25: <Contact>: may occur only once in <PeneBlast>; the first is on line 25"}},
      {"<Solution><EndTime value=\"0.08\"/></Solution>",
       "",
       {"line 2: <PeneBlast>: element <Solution> is missing"}},
      {"<EndTime value=\"0.08\"/>", "", {"line 25: <Solution>: element <EndTime> is missing"}},
      {"<ReferenceDensity value=\"8.93e-3\"/>",
       "",
       {"line 4: <Material>: element <ReferenceDensity> is missing"}},
      {"<ZMax value",
       "<XMax value",
       {"line 18: <Cell>: element <ZMax> is missing",
        "line 21: <XMax>: may occur only once in <Cell>; the first is on line 19"}},
      {"<Solution>",
       "<Solution colour=\"red\">",
       {"line 25: <Solution colour=\"red\">: no such attribute; expected algorithm, near_boundary_stop, "
        "Integration, transfer, flip_fraction, xpic_order, xpic_interval, mass"}},
      {"dp=\"0.38\"",
       "Dp=\"0.38\"",
       {"line 13: <Geometry Dp=\"0.38\">: no such attribute; expected dp, x0, y0, z0, lx, ly, lz; did you "
        "mean "
        "'dp'?"}},
      {"dp=\"0.38\"",
       "",
       {"line 13: <Geometry>: attribute 'dp' is missing: a number greater than 0 (distance of neighbouring "
        "particles; element size for BlockForFEM)"}},
      {"dp=\"0.38\"",
       "dp=\"0.38\" Outer_Radius=\"1\"",
       {"line 13: <Geometry Outer_Radius=\"1\">: not available with type Block, only with Sphere"}},
      {"dp=\"0.38\"",
       "dp=\"0.38\"\n\n colour='red'",
       {"line 15: <Geometry colour=\"red\">: no such attribute; expected dp, x0, y0, z0, lx, ly, lz"}},
      {"lz=\"19\"/>",
       "lz=\"19\"><Point mass='1' x='0' y='0' z='0'/></Geometry>",
       {"line 13: <Point>: not available with type Block",
        "line 13: <Point mass=\"1\">: not available with type Block, only with Point"}},
      {"<FailureModel type",
       "<FailureModel xmlns=\"a\" type",
       {"line 8: <FailureModel xmlns=\"\">: no such attribute; expected type, Erosion"}},
      {"<Solution>", "<Solution>text", {"line 25: <Solution>: text is not allowed here: 'text'"}},
      {"<Solution>", "<Solution><![CDATA[text]]>", {"line 25: <Solution>: text is not allowed here: 'text'"}},
      {"version=\"1.0\">", "version=\"2.0\">", {"line 2: <PeneBlast version=\"2.0\">: expected '1.0'"}},
      {"<Header>", "<HarmExcit/><Header>", {"line 3: <HarmExcit>: belongs in <Body>, not in <PeneBlast>"}},
  });
  CHECK(test::faults("<peneblast/>") ==
        std::vector<std::string>{"line 1: <peneblast>: the root of an input file is <PeneBlast>"});
}

TEST_CASE("spellings of the manual that are refused") {
  check_faults({
      {"<EndTime", "<FESMSetting/><EndTime", {"line 25: <FESMSetting>: the right spelling is 'FEMSetting'"}},
      {"</PeneBlast>",
       "<Output><PostProcessing time_interval='1' h5art='1'/></Output></PeneBlast>",
       {"line 26: <PostProcessing h5art=\"1\">: the right spelling is 'h5part'"}},
      {"</PeneBlast>",
       "<Output><PostProcessing time_internal='1'/></Output></PeneBlast>",
       {"line 26: <PostProcessing time_internal=\"1\">: the right spelling is 'time_interval'"}},
      {"</PeneBlast>",
       "<Output><Restart time_internal='1'/></Output></PeneBlast>",
       {"line 26: <Restart time_internal=\"1\">: the right spelling is 'time_interval'"}},
      {"</Cell>",
       "<MovingGrid y_min='0' y_min='1'/></Cell>",
       {"line 23: not well-formed XML: Attribute y_min redefined; the second is spelled 'y_max'"}},
      {"</Cell>",
       "<MovingGrid z_min='0' z_min='1'/></Cell>",
       {"line 23: not well-formed XML: Attribute z_min redefined; the second is spelled 'z_max'"}},
      {"<XMin value=\"0\"",
       "<XMin value=\"0\" value=\"1\"",
       {"line 19: not well-formed XML: Attribute value redefined"}},
  });
}

TEST_CASE("values") {
  const std::string velocity =
      "expected a number, written like 1.5e-3, or an expression in x, y, z, X, Y, Z; ";
  const std::string beyond =
      "out of the range of double precision (0, or magnitudes from 2.3e-308 to 1.7e308); write 0, or choose "
      "other units";
  check_faults({
      {"value=\"8.93e-3\"",
       "value=\"-8.93e-3\"",
       {"line 5: <ReferenceDensity value=\"-8.93e-3\">: expected a number greater than 0"}},
      {"value=\"8.93e-3\"",
       "value=\"nan\"",
       {"line 5: <ReferenceDensity value=\"nan\">: expected a number greater than 0, written like 1.5e-3"}},
      {"value=\"8.93e-3\"", "value=\"1e999\"", {"line 5: <ReferenceDensity value=\"1e999\">: " + beyond}},
      {"value=\"8.93e-3\"", "value=\"1e-310\"", {"line 5: <ReferenceDensity value=\"1e-310\">: " + beyond}},
      {"vz=\"-190\"", "vz=\"-4.9e-324\"", {"line 14: <InitialVelocity vz=\"-4.9e-324\">: " + beyond}},
      {"vz=\"-190\"", "vz=\"1e-400\"", {"line 14: <InitialVelocity vz=\"1e-400\">: " + beyond}},
      {"vz=\"-190\"", "vz=\"2.3e-308\"", {"ok"}},
      {"vz=\"-190\"",
       "vz=\"-1d3\"",
       {"line 14: <InitialVelocity vz=\"-1d3\">: " + velocity + "unknown name 'd3' at character 3"}},
      {"vz=\"-190\"", "vz=\"\"", {"line 14: <InitialVelocity vz=\"\">: " + velocity + "empty"}},
      {"<InitialVelocity",
       "<InitialTemperature value='0'/><InitialVelocity",
       {"line 14: <InitialTemperature value=\"0\">: expected a number greater than 0"}},
      {"<InitialVelocity",
       "<InitialTemperature value='inf'/><InitialVelocity",
       {"line 14: <InitialTemperature value=\"inf\">: expected a number greater than 0, written like "
        "1.5e-3"}},
      {"<InitialVelocity",
       "<InitialTemperature/><InitialVelocity",
       {"line 14: <InitialTemperature>: attribute 'value' is missing: a number greater than 0 "
        "(temperature; the material must have one)"}},
      {"dp=\"0.38\"", "dp=\"0\"", {"line 13: <Geometry dp=\"0\">: expected a number greater than 0"}},
      {"boundary=\"2\"", "boundary=\"5\"", {"line 19: <XMin boundary=\"5\">: expected one of 0, 1, 2, 3, 4"}},
      {"boundary=\"2\"",
       "boundary=\"two\"",
       {"line 19: <XMin boundary=\"two\">: expected one of 0, 1, 2, 3, 4"}},
      {"<Solution>",
       "<Solution near_boundary_stop=\"yes\">",
       {"line 25: <Solution near_boundary_stop=\"yes\">: expected 0 or 1"}},
      {"<Solution>",
       "<Solution algorithm=\"musl\">",
       {"line 25: <Solution algorithm=\"musl\">: expected one of auto, MUSL, USL, USF, USAVG; did you mean "
        "'MUSL'?"}},
      {"<EndTime",
       "<TimeStep factor=\"1.1\"/><EndTime",
       {"line 25: <TimeStep factor=\"1.1\">: expected a number in (0, 1]"}},
      {"<EndTime",
       "<TimeStep factor=\"0\"/><EndTime",
       {"line 25: <TimeStep factor=\"0\">: expected a number in (0, 1]"}},
      {"<EndTime",
       "<OpenMPSetting nthread=\"0\"/><EndTime",
       {"line 25: <OpenMPSetting nthread=\"0\">: expected a whole number in [1, 1024]"}},
      {"<EndTime",
       "<OpenMPSetting nthread=\"99999999999\"/><EndTime",
       {"line 25: <OpenMPSetting nthread=\"99999999999\">: expected a whole number in [1, 1024]"}},
      {"value=\"0.08\"", "value=\"0\"", {"line 25: <EndTime value=\"0\">: expected a number greater than 0"}},
      {"<EndTime",
       "<Warn type=\"ie|vole\"/><EndTime",
       {"line 25: <Warn type=\"ie|vole\">: 'vole': expected one or more of ie, vol, grid, joined by |; did "
        "you "
        "mean 'vol'?"}},
      {"<EndTime",
       "<Warn type=\"\"/><EndTime",
       {"line 25: <Warn type=\"\">: expected one or more of ie, vol, grid, joined by |"}},
      {"<EndTime",
       "<Warn type=\"ie||vol\"/><EndTime",
       {"line 25: <Warn type=\"ie||vol\">: '': expected one or more of ie, vol, grid, joined by |"}},
      {"</PeneBlast>",
       "<Output><Restart time_interval=\"0\"/></Output></PeneBlast>",
       {"line 26: <Restart time_interval=\"0\">: expected a number greater than 0"}},
      {"name=\"rod\"", "name=\" \"", {"line 12: <Body name=\" \">: expected a text"}},
      {"<EndTime",
       "<Volume update_type=\"5\"/><EndTime",
       {"line 25: <Volume update_type=\"5\">: expected one of 0, 1, 2, 3, 4"}},
  });
}

TEST_CASE("all faults come at once, in the order of the lines") {
  std::string text = test::replaced(test::bar, "dz=\"0.76\"", "dz=\"-1\"");
  text = test::replaced(text, "value=\"8.93e-3\"", "value=\"0\"");
  text = test::replaced(text, "material=\"cu\"", "material=\"ag\"");
  text = test::replaced(text, "<Solution>", "<Solution speed=\"high\">");
  CHECK(test::faults(text) ==
        std::vector<std::string>{
            "line 5: <ReferenceDensity value=\"0\">: expected a number greater than 0",
            "line 12: <Body material=\"ag\">: there is no material of this name",
            "line 22: <DCell dz=\"-1\">: expected a number greater than 0",
            "line 25: <Solution speed=\"high\">: no such attribute; expected algorithm, near_boundary_stop, "
            "Integration, transfer, flip_fraction, xpic_order, xpic_interval, mass"});
}

TEST_CASE("the text of a fault") {
  const core::Diagnostic full{"a.xmp", 3, "Grid", "gimp", "2", "expected 0 or 1"};
  CHECK(to_text(full) == "a.xmp:3: <Grid gimp=\"2\">: expected 0 or 1");
  CHECK(to_text(core::Diagnostic{"a.xmp", 0, "", "", "", "no such file"}) == "a.xmp: no such file");
  CHECK(to_text(core::Diagnostic{"a", 1, "E", "b", "x\ny" + std::string(200, 'z'), "m"}) ==
        "a:1: <E b=\"x y" + std::string(117, 'z') + "...\">: m");
}

TEST_CASE("a flood of faults is cut, and says so") {
  std::string flood;
  for (int i = 0; i < 5000; ++i) flood += "<Wrong/>";
  const auto found = test::faults(test::replaced(test::bar, "<Solution>", flood + "<Solution>"));
  CHECK(found.size() == 1001);
  CHECK(found.back() == "and 4000 more");
}

}  // namespace
