// Expressions in place of numbers: what is read, what comes back as text, and what is refused.

#include <catch2/catch.hpp>

#include "io/input/echo.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;

constexpr std::string_view velocity = "<InitialVelocity vx=\"0\" vy=\"0\" vz=\"-190\"/>";

std::string with(std::string_view loads) { return test::replaced(test::bar, velocity, loads); }

const core::BodyInput& body_of(const core::Scene& scene) { return scene.components[0].bodies[0]; }

void check_faults(std::string_view loads, const std::vector<std::string>& messages) {
  INFO(loads);
  CHECK(test::faults(with(loads)) == messages);
}

TEST_CASE("an expression stands in place of a number") {
  const core::Scene scene =
      test::parse(with("<InitialVelocity vx='0.1*sin(pi*x/25)' vy='2*pi' vz='-190'/>\n"
                       "<BodyForce by='if(X &lt; 1, 2, 3)*t'/>\n"
                       "<Traction tx='1' ty='x' tz='0'\n pressure='t' normal='1'/>"));
  const core::BodyInput& body = body_of(scene);
  CHECK(body.initial_velocity == core::Vec3<double>{0, 2 * 3.14159265358979323846, -190});
  REQUIRE(body.initial_velocity_expressions.size() == 1);
  const core::Expression& vx = body.initial_velocity_expressions[0];
  CHECK(vx.component == 0);
  CHECK(in_words(vx) == "case.xmp:14: <InitialVelocity vx=\"0.1*sin(pi*x/25)\">");
  REQUIRE(body.body_force);
  CHECK(body.body_force->number == core::Vec3<double>{});
  REQUIRE(body.body_force->expressions.size() == 1);
  CHECK(in_words(body.body_force->expressions[0]) == "case.xmp:15: <BodyForce by=\"if(X < 1, 2, 3)*t\">");
  REQUIRE(body.surface_loads.size() == 1);
  const core::SurfaceLoad& load = body.surface_loads[0];
  CHECK(load.traction == core::Vec3<double>{1, 0, 0});
  REQUIRE(load.expressions.size() == 2);
  CHECK(load.expressions[0].component == 1);
  CHECK(load.expressions[1].component == core::SurfaceLoad::pressure_component);
  CHECK(load.expressions[1].source.line == 17);

  const std::string text = io::to_text(scene);
  for (const char* piece : {"<InitialVelocity vx=\"0.1*sin(pi*x/25)\" vy=\"6.283185307179586\" vz=\"-190\"/>",
                            "<BodyForce bx=\"0\" by=\"if(X &lt; 1, 2, 3)*t\" bz=\"0\"/>",
                            "<Traction pressure=\"t\" tx=\"1\" ty=\"x\" tz=\"0\" normal=\"1\""}) {
    INFO(text);
    CHECK(text.find(piece) != text.npos);
  }
  CHECK(io::to_text(test::parse(text)) == text);
}

TEST_CASE("a pressure or a traction may be an expression alone") {
  check_faults("<Traction pressure='x'/>", {"ok"});
  check_faults("<Traction tx='x' normal='0'/>", {"ok"});
  check_faults("<Traction tx='x'/>",
               {"line 14: <Traction>: normal is the axis of the traction tx, ty, tz: give both or neither"});
}

TEST_CASE("a wrong expression is refused with what is wrong in it, all at once") {
  const std::string expected =
      "expected a number, written like 1.5e-3, or an expression in x, y, z, X, Y, Z, t; ";
  const std::string at_start =
      "expected a number, written like 1.5e-3, or an expression in x, y, z, X, Y, Z; ";
  const std::string of_load = "expected a number, written like 1.5e-3, or an expression in x, y, z, t; ";
  check_faults(
      "<InitialVelocity vx='0.1*sine(x)' vy='t*x' vz='(1+x'/>\n<BodyForce bx='1/0' by='T' bz='x=2'/>\n"
      "<Traction pressure='X + Y*t'/>",
      {"line 14: <InitialVelocity vx=\"0.1*sine(x)\">: " + at_start +
           "unknown name 'sine' at character 5; did you mean 'sin'?",
       "line 14: <InitialVelocity vy=\"t*x\">: " + at_start + "t is not available here",
       "line 14: <InitialVelocity vz=\"(1+x\">: " + at_start + "a closing parenthesis is missing",
       "line 15: <BodyForce bx=\"1/0\">: " + expected + "this is infinite",
       "line 15: <BodyForce by=\"T\">: " + expected + "unknown name 'T' at character 1; did you mean 't'?",
       "line 15: <BodyForce bz=\"x=2\">: " + expected + "'=' is an assignment; use == for equality",
       "line 16: <Traction pressure=\"X + Y*t\">: " + of_load + "X, Y are not available here"});
  check_faults(
      "<PrescribedAcceleration ax='x' ay='0' az='0' arx='0' ary='0' arz='0'><Coefficient time='0' "
      "cx='1' cy='0' cz='0' crx='0' cry='0' crz='0'/></PrescribedAcceleration>",
      {"line 14: <PrescribedAcceleration ax=\"x\">: expected a number, written like 1.5e-3"});
}

TEST_CASE("expressions where a body cannot follow them are refused") {
  check_faults("<PrescribedVelocity vx='t' vy='0' vz='X'/>", {"ok"});
  check_faults("<PrescribedVelocity vx='t' vy='0' vz='X'/><BodyForce bx='1'/>",
               {"line 14: <BodyForce>: has no effect on a body whose velocity is prescribed or constrained"});
  check_faults("<InitialVelocity vx='x' vy='0' vz='0'/><ConstrainRigidPosition value='1'/>",
               {"line 14: <InitialVelocity vx=\"x\">: ConstrainRigidPosition keeps one velocity for the "
                "whole body: expected a number; or use PrescribedVelocity"});
}

}  // namespace
