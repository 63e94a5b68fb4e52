// Ogive and Bool bodies in the input: what reaches the scene, and one wrong input per rule.

#include <chrono>

#include <catch2/catch.hpp>

#include "core/discretise/seeds.hpp"
#include "io/input/echo.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;
using Lines = std::vector<std::string>;

/// The bar's scene with these bodies in the place of its own; the first is on line 12.
std::string with_bodies(const std::string& bodies) {
  std::string text(test::bar);
  const std::size_t begin = text.find("    <Body"), end = text.find("  </Component>");
  return text.replace(begin, end - begin, bodies);
}

std::string operand(const std::string& name, const std::string& type, const std::string& geometry) {
  return "<Body name='" + name + "' material='cu' type='" + type + "' ForBoolBody='1'><Geometry " + geometry +
         "/></Body>\n";
}

std::string difference(const std::string& name, const std::string& a, const std::string& b,
                       const std::string& more = {}) {
  return "<Body name='" + name + "' material='cu' type='Bool' BoolType='subtract' BoolBodyA='" + a +
         "' BoolBodyB='" + b + "'" + more + "/>\n";
}

const std::string cube = operand("cube", "Block", "dp='0.5' x0='0' y0='0' z0='0' lx='4' ly='4' lz='4'");
const std::string ball = operand("ball", "Sphere", "dp='0.5' x0='0' y0='0' z0='0' Outer_Radius='3'");

std::string ogive(const std::string& radii) {
  return "<Body name='nose' material='cu' type='Ogive'><Geometry x0='5' y0='5' z0='5' dp_bottom='0.2' "
         "dp_top='0.2' " +
         radii + "/></Body>\n";
}

Lines complaints_about(const std::string& bodies) { return test::faults(with_bodies(bodies)); }

TEST_CASE("an ogive reaches the scene") {
  const core::Scene scene = test::parse(with_bodies(ogive("Ogive_Radius='3' End_Radius='1' angle='90'")));
  const core::BodyInput& nose = scene.components[0].bodies[0];
  const auto& g = std::get<core::OgiveGeometry>(nose.geometry);
  CHECK((g.ogive_radius == 3 && g.end_radius == 1 && g.angle == 90));
  CHECK(core::make_seed_source(scene, nose)->expected_particles() > 100);
}

TEST_CASE("Bool bodies reach the scene, with operands before and behind them, and the echo keeps them") {
  const core::Scene scene = test::parse(with_bodies(difference("both", "cube", "rest") + cube +
                                                    difference("rest", "cube", "ball", " ForBoolBody='1'") +
                                                    "</Component><Component name='c2'>" + ball));
  const auto& both = std::get<core::BoolGeometry>(scene.components[0].bodies[0].geometry);
  CHECK(core::body_at(scene, both.minuend).name == "cube");
  CHECK(core::body_at(scene, both.subtrahend).name == "rest");
  const auto& rest = std::get<core::BoolGeometry>(scene.components[0].bodies[2].geometry);
  CHECK((rest.subtrahend.component == 1 && rest.subtrahend.body == 0));
  CHECK(core::active_bodies(scene).size() == 1);
  const std::string echo = io::to_text(scene);
  CHECK(io::to_text(test::parse(echo)) == echo);
}

TEST_CASE("wrong ogives") {
  CHECK(
      complaints_about(ogive("Ogive_Radius='0.9' End_Radius='1'")) ==
      Lines{
          "line 12: <Geometry Ogive_Radius=\"0.9\">: expected at least End_Radius, 1: the arc starts at the "
          "rim of the base, in the direction of the axis; an arc of smaller radius does not reach the axis"});
  CHECK(complaints_about(ogive("Ogive_Radius='1' End_Radius='1'")) == Lines{"ok"});
  CHECK(
      complaints_about(ogive("Ogive_Radius='1001' End_Radius='1'")) ==
      Lines{
          "line 12: <Geometry Ogive_Radius=\"1001\">: expected at most 1000 times End_Radius, 1; a Cylinder "
          "with Top_Outer_Radius=\"0\" gives a longer tip"});
  CHECK(complaints_about(ogive("Ogive_Radius='3' End_Radius='0'")) ==
        Lines{"line 12: <Geometry End_Radius=\"0\">: expected a number greater than 0"});
  CHECK(complaints_about(ogive("Ogive_Radius='-3' End_Radius='-1' angle='361'")) ==
        Lines{"line 12: <Geometry Ogive_Radius=\"-3\">: expected a number greater than 0",
              "line 12: <Geometry End_Radius=\"-1\">: expected a number greater than 0",
              "line 12: <Geometry angle=\"361\">: expected a number in (0, 360]"});
  CHECK(complaints_about(ogive("End_Radius='1'")) ==
        Lines{"line 12: <Geometry>: attribute 'Ogive_Radius' is missing: a number greater than 0 (radius of "
              "the arc, whose centre is in the plane of the base; from 1 to 1000 times End_Radius)"});
  CHECK(complaints_about(ogive("Ogive_Radius='0.03' End_Radius='0.01'")) ==
        Lines{"line 12: <Geometry>: the body has no particles: its shape is smaller than the particle "
              "spacing; expected a smaller spacing"});
  CHECK(complaints_about(test::replaced(ogive("Ogive_Radius='3' End_Radius='1'"), "z0='5'", "z0='50'"))[0]
            .starts_with(
                "line 12: <Body name=\"nose\">: the body is outside the grid: its z ranges from 50 to 52"));
  CHECK(complaints_about(
            test::replaced(ogive("Ogive_Radius='3' End_Radius='1'"), "dp_bottom='0.2'", "dp_bottom='1e-12'"))
            .size() == 1);
}

TEST_CASE("wrong Bool bodies") {
  CHECK(complaints_about(cube + ball + difference("rest", "cube", "ball")) == Lines{"ok"});
  CHECK(complaints_about(cube + ball + difference("rest", "cube", "bal")) ==
        Lines{"line 14: <Body BoolBodyB=\"bal\">: there is no body of this name; did you mean 'ball'?"});
  CHECK(
      complaints_about(cube + "<Body name='rest' material='cu' type='Bool'/>\n") ==
      Lines{"line 13: <Body>: attribute 'BoolType' is missing: 'subtract' (the operation: the particles of A "
            "outside the shape of B; the intersection is A minus (A minus B))",
            "line 13: <Body>: attribute 'BoolBodyA' is missing: a text (body from which is subtracted, of "
            "type Point, Block, Sphere, Cylinder, Ogive or Bool, with ForBoolBody 1)",
            "line 13: <Body>: attribute 'BoolBodyB' is missing: a text (body that is subtracted, of the same "
            "types, with ForBoolBody 1; for a Point body, the positions within half a particle spacing of a "
            "point)"});
  CHECK(complaints_about(cube + test::replaced(ball, " ForBoolBody='1'", "") +
                         test::replaced(difference("rest", "cube", "ball"), "subtract", "add")) ==
        Lines{"line 14: <Body BoolType=\"add\">: expected 'subtract'",
              "line 14: <Body BoolBodyB=\"ball\">: body 'ball', on line 13, requires ForBoolBody=\"1\""});
  CHECK(complaints_about(cube +
                         test::replaced(difference("rest", "cube", "cube"), "/>", "><Geometry/></Body>")) ==
        Lines{"line 13: <Geometry>: not available with type Bool",
              "line 13: <Body BoolBodyB=\"cube\">: the body has no particles: no particle of body 'cube' is "
              "outside the subtracted body"});
  CHECK(complaints_about(cube + difference("rest", "rest", "cube", " ForBoolBody='1'")) ==
        Lines{"line 13: <Body BoolBodyA=\"rest\">: the body is an operand of itself: rest -> rest; expected "
              "operands that do not contain it"});
  // Two that are made of each other; a third that uses one of them adds no fault.
  CHECK(complaints_about(cube + difference("a", "cube", "b", " ForBoolBody='1'") +
                         difference("b", "a", "cube", " ForBoolBody='1'") + difference("c", "cube", "a")) ==
        Lines{"line 13: <Body BoolBodyB=\"b\">: the body is an operand of itself: a -> b -> a; expected "
              "operands that do not contain it",
              "line 14: <Body BoolBodyA=\"a\">: the body is an operand of itself: b -> a -> b; expected "
              "operands that do not contain it"});
  const std::string bars =
      "<Body name='bars' material='cu' type='LineForBar' ForBoolBody='1'><Geometry sectional_area='1' "
      "element_size='1' nb_lines='2' extend_direction='0' expand_direction='1' length='5' internal='1' "
      "x0='0' "
      "y0='0' z0='0'/></Body>\n";
  CHECK(complaints_about(cube + bars + difference("rest", "cube", "bars"))[1] ==
        "line 14: <Body BoolBodyB=\"bars\">: a body of type LineForBar cannot be an operand; expected one of "
        "Point, Block, Sphere, Cylinder, Ogive, Bool");
}

TEST_CASE("all that is wrong with several shapes comes at once, each about what is wrong alone") {
  CHECK(
      complaints_about(operand("a", "Block", "dp='0.5' x0='0' y0='0' z0='0' lx='-4' ly='4' lz='4'") +
                       operand("b", "Sphere",
                               "dp='0.5' x0='0' y0='0' z0='0' Outer_Radius='1' "
                               "Inner_Radius='2' half='1'") +
                       difference("rest", "a", "b") + ogive("Ogive_Radius='1' End_Radius='2'")) ==
      Lines{
          "line 12: <Geometry lx=\"-4\">: expected a number greater than 0",
          "line 13: <Geometry Outer_Radius=\"1\">: expected more than Inner_Radius, 2",
          "line 13: <Geometry half=\"1\">: requires angle=\"90\", not 360",
          "line 15: <Geometry Ogive_Radius=\"1\">: expected at least End_Radius, 2: the arc starts at the "
          "rim of the base, in the direction of the axis; an arc of smaller radius does not reach the axis"});
}

TEST_CASE("what an operand states without effect is said") {
  std::vector<core::Diagnostic> notes;
  const std::string moving =
      test::replaced(cube, "/></Body>", "/><InitialVelocity vx='1' vy='0' vz='0'/></Body>");
  test::parse(with_bodies(moving + ball + difference("rest", "cube", "ball") +
                          operand("spare", "Block", "dp='0.5' x0='0' y0='0' z0='0' lx='4' ly='4' lz='4'")),
              {.notes = &notes});
  REQUIRE(notes.size() == 3);
  CHECK(notes[0].element == "WorkPlane");  // which the bar named
  CHECK(notes[1].line == 12);
  CHECK(notes[1].message == "no effect: an operand of Bool bodies takes no part in the run");
  CHECK(notes[2].line == 15);
  CHECK(notes[2].message == "no effect: no Bool body uses this body, and it takes no part in the run");
}

TEST_CASE("operands are found in the same time each, however many bodies there are") {
  const auto seconds = [](int bodies) {
    std::string text = cube;
    for (int i = 0; i < bodies; ++i) {
      const std::string name = std::to_string(i);
      text += operand("o" + name, "Sphere", "dp='1' x0='0' y0='0' z0='0' Outer_Radius='1'");
      text += difference("d" + name, "cube", "o" + name);
    }
    const std::string input = with_bodies(text);
    double best = 1e9;
    for (int repeat = 0; repeat < 3; ++repeat) {
      const auto start = std::chrono::steady_clock::now();
      CHECK(test::parse(input).components[0].bodies.size() == static_cast<std::size_t>(2 * bodies + 1));
      best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
  };
  // Linear: 8 times; each name compared with each: 64 times. Twice linear for a busy machine.
  CHECK(seconds(8000) < 20 * seconds(1000));
}

}  // namespace
