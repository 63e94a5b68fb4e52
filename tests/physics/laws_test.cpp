// What holds for every law, over the samples of tests/physics/samples.cpp: nothing here knows a law's name,
// so a law that is added is tested by the same statements (physics/checks).

#include <catch2/catch.hpp>

#include "physics/checks/law_checks.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

namespace {

void holds_for_every_law(std::string_view name) {
  const physics::LawCheck& check = physics::law_check(name);
  for (const Sample& s : samples()) {
    for (const std::string& fault : check.failures(of(s), physics::built_in_laws()))
      FAIL_CHECK(s.label << ": " << fault);
  }
  SUCCEED();
}

}  // namespace

TEST_CASE("scalar and vector instances of every law agree to round-off", "[physics][laws]") {
  holds_for_every_law("instances");
}
TEST_CASE("without strain there is no stress", "[physics][laws]") { holds_for_every_law("rest"); }
TEST_CASE("every law goes on from its columns alone, to the last bit", "[physics][laws]") {
  holds_for_every_law("restart");
}
TEST_CASE("every law gives the same answer in SI and in mm-g-ms", "[physics][laws]") {
  holds_for_every_law("units");
}
TEST_CASE("the result of a particle does not depend on its lane or its neighbours", "[physics][laws]") {
  holds_for_every_law("neighbours");
}
TEST_CASE("columns that are not declared are neither read nor written", "[physics][columns]") {
  holds_for_every_law("undeclared");
}
TEST_CASE("columns that are declared are used", "[physics][columns]") { holds_for_every_law("declared"); }
TEST_CASE("plastic laws end each step on or below their yield surface", "[physics][laws]") {
  holds_for_every_law("yield");
}
TEST_CASE("plastic flow and viscous flow never release energy", "[physics][laws]") {
  holds_for_every_law("dissipation");
}
TEST_CASE("every law converges with first order or better as the step is refined",
          "[physics][laws][numbers]") {
  holds_for_every_law("convergence");
}
TEST_CASE("every law is objective under ten superposed turns", "[physics][objectivity][numbers]") {
  holds_for_every_law("objectivity");
}
TEST_CASE("internal energy is the work of all stresses, viscous ones included once", "[physics][energy]") {
  holds_for_every_law("energy");
}
TEST_CASE("the wave speed of every law is not below its tangent's", "[physics][wave]") {
  holds_for_every_law("wave");
}
TEST_CASE("the tangent of every law that has one is the derivative of its stress", "[physics][tangent]") {
  holds_for_every_law("tangent");
}
TEST_CASE("the tangent changes nothing and depends on no neighbour", "[physics][tangent]") {
  holds_for_every_law("pure");
}

}  // namespace mpm::tests
