// A Specification.xml of the user's: what it forbids, what it adds, and mistakes in it.

#include "io/input/user_specification.hpp"

#include <catch2/catch.hpp>

#include "physics/catalogue.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;
using test::bar;
using test::replaced;

/// What the bar uses, in the manual's notation.
constexpr std::string_view small = R"(<PeneBlast spec="REQUIRED" attribute1="version, REQUIRED, STRING">
  <Header spec="OPTIONAL, NO_DATA"><Name spec="OPTIONAL" attribute1="value, OPTIONAL, STRING"/></Header>
  <Material spec="REQUIRED_MULTIPLE" attribute1="name, REQUIRED, STRING">
    <ReferenceDensity spec="REQUIRED" attribute1="value, REQUIRED, DOUBLE, positive"/>
    <StrengthModel spec="REQUIRED" attribute1="type, REQUIRED, STRING, IsoHarden|Clay"
      attribute2="Young, OPTIONAL, DOUBLE, positive" attribute3="Poisson, OPTIONAL, DOUBLE, 0:0.4"
      attribute4="Yield0, REQUIRED, DOUBLE, , ForTypes: IsoHarden" attribute5="TangMod, REQUIRED, DOUBLE, , ForTypes: IsoHarden"
      attribute6="moisture, REQUIRED, DOUBLE, 0:1, ForTypes: Clay"/>
    <EquationOfState spec="OPTIONAL" attribute1="type, REQUIRED, STRING, Gruneisen" attribute2="C0, REQUIRED, DOUBLE"
      attribute3="S1, REQUIRED, DOUBLE" attribute4="gamma0, REQUIRED, DOUBLE"/>
    <FailureModel spec="OPTIONAL" attribute1="type, REQUIRED, STRING"/>
  </Material>
  <WorkPlane spec="OPTIONAL_MULTIPLE" attribute1="name, REQUIRED, STRING" attribute2="r0z, OPTIONAL, DOUBLE"/>
  <Component spec="REQUIRED_MULTIPLE" attribute1="name, REQUIRED, STRING">
    <Body spec="REQUIRED_MULTIPLE" attribute1="name, REQUIRED, STRING" attribute2="material, REQUIRED, STRING"
      attribute3="type, REQUIRED, STRING, Block" attribute4="workPlane, OPTIONAL, STRING" attribute5="colour, OPTIONAL, STRING, red|blue">
      <Geometry spec="REQUIRED" attribute1="dp, REQUIRED, DOUBLE" attribute2="x0, REQUIRED, DOUBLE" attribute3="y0, REQUIRED, DOUBLE"
        attribute4="z0, REQUIRED, DOUBLE" attribute5="lx, REQUIRED, DOUBLE" attribute6="ly, REQUIRED, DOUBLE" attribute7="lz, REQUIRED, DOUBLE"/>
      <InitialVelocity spec="OPTIONAL" attribute1="vx, REQUIRED, DOUBLE" attribute2="vy, REQUIRED, DOUBLE" attribute3="vz, REQUIRED, DOUBLE, -200:0"/>
      <Magnet spec="OPTIONAL" attribute1="strength, REQUIRED, DOUBLE, positive"/>
    </Body>
  </Component>
  <Grid spec="REQUIRED" attribute1="shape, OPTIONAL, STRING"><Cell spec="REQUIRED" attribute1="type, REQUIRED, STRING">
    <XMin spec="REQUIRED" attribute1="value, REQUIRED, DOUBLE" attribute2="boundary, REQUIRED, INTEGER, 0:4"/>
    <XMax spec="REQUIRED" attribute1="value, REQUIRED, DOUBLE" attribute2="boundary, REQUIRED, INTEGER, 0:4"/>
    <YMin spec="REQUIRED" attribute1="value, REQUIRED, DOUBLE" attribute2="boundary, REQUIRED, INTEGER, 0:4"/>
    <YMax spec="REQUIRED" attribute1="value, REQUIRED, DOUBLE" attribute2="boundary, REQUIRED, INTEGER, 0:4"/>
    <ZMin spec="REQUIRED" attribute1="value, REQUIRED, DOUBLE" attribute2="boundary, REQUIRED, INTEGER, 0:4"/>
    <ZMax spec="REQUIRED" attribute1="value, REQUIRED, DOUBLE" attribute2="boundary, REQUIRED, INTEGER, 0:4"/>
    <DCell spec="REQUIRED" attribute1="dx, REQUIRED, DOUBLE" attribute2="dy, REQUIRED, DOUBLE" attribute3="dz, REQUIRED, DOUBLE"/>
  </Cell></Grid>
  <Solution spec="REQUIRED"><EndTime spec="REQUIRED" attribute1="value, REQUIRED, DOUBLE, positive"/></Solution>
</PeneBlast>)";

/// ErrorList, or the foreign names after an "ok".
std::vector<std::string> checked(std::string_view text, std::string_view specification = small) {
  const io::UserSpecification users{"Specification.xml", io::parse_specification(specification)};
  const io::ElementSpec language = io::with_additions(io::language(physics::catalogue()), users.root);
  std::vector<core::Diagnostic> foreign;
  std::vector<std::string> lines;
  try {
    io::parse_scene(text, "case.xmp", language, {.users = &users, .foreign = &foreign});
    lines.push_back("ok");
  } catch (const core::InputErrors& errors) { foreign = errors.diagnostics(); }
  for (core::Diagnostic d : foreign) {
    d.file.clear();
    lines.push_back(to_text(d));
  }
  return lines;
}

using Lines = std::vector<std::string>;

TEST_CASE("an input is checked against the user's Specification and against the program's") {
  CHECK(checked(bar) == Lines{"ok"});
  CHECK(checked(replaced(bar, "Poisson=\".35\"", "Poisson='0.45'")) ==
        Lines{"line 6: <StrengthModel Poisson=\"0.45\">: expected a number in [0, 0.4]"});
  CHECK(checked(replaced(bar, "vz=\"-190\"", "vz='-201'")) ==
        Lines{"line 14: <InitialVelocity vz=\"-201\">: expected a number in [-200, 0]"});
  CHECK(checked(replaced(bar, "<EndTime", "<Gravity ax='0' ay='0' az='1'/><EndTime")) ==
        Lines{"line 25: <Gravity>: no such element in <Solution>"});
  // What both refuse is said once, in the program's words.
  CHECK(checked(replaced(bar, "value=\"0.08\"", "value='-1'")) ==
        Lines{"line 25: <EndTime value=\"-1\">: expected a number greater than 0"});
  // What the program alone refuses stays refused.
  CHECK(checked(replaced(bar, "dp=\"0.38\"", "dp='0'")) ==
        Lines{"line 13: <Geometry dp=\"0\">: expected a number greater than 0"});
}

TEST_CASE("keywords that the user's Specification adds are let pass and named") {
  const std::string known =
      "defined in the Specification, but not in this program: mpm_run rejects the input";
  CHECK(checked(replaced(bar, "<InitialVelocity", "<Magnet strength='3'/><InitialVelocity")) ==
        Lines{"ok", "line 14: <Magnet>: " + known});
  CHECK(checked(replaced(bar, "<InitialVelocity", "<Magnet strength='-3'/><InitialVelocity")) ==
        Lines{"line 14: <Magnet strength=\"-3\">: expected a number of at least 0"});
  CHECK(checked(replaced(bar, "<InitialVelocity", "<Magnet/><InitialVelocity")) ==
        Lines{"line 14: <Magnet>: attribute 'strength' is missing: a number of at least 0"});
  CHECK(checked(replaced(bar, "name=\"rod\"", "name=\"rod\" colour='red'")) ==
        Lines{"ok", "line 12: <Body colour=\"red\">: " + known});
  CHECK(checked(replaced(bar, "name=\"rod\"", "name=\"rod\" colour='green'")) ==
        Lines{"line 12: <Body colour=\"green\">: expected one of red, blue"});
  CHECK(checked(replaced(bar,
                         "type=\"IsoHarden\" Young=\"117e3\" Poisson=\".35\" Yield0=\"400\" TangMod=\"100\"",
                         "type='Clay' Young='1' moisture='0.2'")) ==
        Lines{"ok", "line 6: <StrengthModel type=\"Clay\">: " + known,
              "line 6: <StrengthModel Young=\"1\">: " + known,
              "line 6: <StrengthModel moisture=\"0.2\">: " + known});
}

TEST_CASE("mistakes in the user's Specification are named by their lines, all at once") {
  const test::TemporaryFolder folder;
  const auto file = folder.write("Specification.xml",
                                 "<PeneBlast spec='REQUIRED'\n  attribute1='version, ALWAYS, STRING'\n"
                                 "  attribute2='x, REQUIRED, FLOAT'>\n<Grid/>\n</PeneBlast>\n");
  try {
    io::read_user_specification(file, {});
    FAIL("accepted");
  } catch (const core::InputErrors& errors) {
    REQUIRE(errors.diagnostics().size() == 3);
    CHECK(errors.diagnostics()[0].file == file.string());
    CHECK(errors.diagnostics()[0].line == 2);
    CHECK(errors.diagnostics()[0].message.starts_with("ALWAYS: not an occurrence; expected REQUIRED"));
    CHECK(errors.diagnostics()[1].line == 3);
    CHECK(errors.diagnostics()[1].message.starts_with("FLOAT: not a data type; expected STRING"));
    CHECK(errors.diagnostics()[2].line == 4);
    CHECK(errors.diagnostics()[2].message == "attribute 'spec' is missing");
  }
  CHECK_THROWS_WITH(io::read_user_specification(folder.write("S.xml", "<Grid spec='REQUIRED'/>"), {}),
                    Catch::Contains("the root of a Specification is <PeneBlast>"));
  CHECK_THROWS_WITH(io::read_user_specification(folder / "none.xml", {}), Catch::Contains("no such file"));
}

}  // namespace
