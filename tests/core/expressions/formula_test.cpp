#include "core/expressions/formula.hpp"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "core/setup/start_velocity.hpp"

using namespace mpm::core;

namespace {

const PlaceAndTime somewhere{{0.3, -1.7, 2.5}, {0.1, -2, 3}, 0.75};

double value_of(const char* text) {
  INFO(text);
  REQUIRE(Formula::check(text).error.empty());
  return Formula(text)(somewhere);
}

std::string error_of(const char* text) { return Formula::check(text).error; }

}  // namespace

TEST_CASE("Formulas give what the same lines of C++ give, to the last bit") {
  const double x = 0.3, y = -1.7, z = 2.5, first_x = 0.1, first_y = -2, first_z = 3, t = 0.75;
  constexpr double pi = std::numbers::pi;
  CHECK(value_of("x") == x);
  CHECK(value_of("-y/z") == -y / z);
  CHECK(value_of("0.1*sin(pi*x/25)") == 0.1 * std::sin(pi * x / 25));
  CHECK(value_of("X + 10*Y + 100*Z") == first_x + 10 * first_y + 100 * first_z);
  CHECK(value_of("exp(-t) * ln(z) + sqrt(z)") == std::exp(-t) * std::log(z) + std::sqrt(z));
  CHECK(value_of("log(z)") == std::log(z));
  CHECK(value_of("atan2(y, x)") == std::atan2(y, x));
  CHECK(value_of("if(x > 0, 2, 3)") == 2);
  CHECK(value_of("if(x > 0 && t > 1, 2, 3)") == 3);
  CHECK(value_of("if(x < 1 || sqrt(y) > 0, 2, 3)") == 2);
  CHECK(value_of("t <= 0.75 ? x : y") == x);
  CHECK(value_of("min(x, y, z) + max(x, y, z) + abs(y)") == y + z - y);
  CHECK(value_of("1.5e-3*t") == 1.5e-3 * t);
  CHECK(std::isnan(value_of("sqrt(y)")));
  CHECK(std::isinf(value_of("1/(t - 0.75)")));
}

TEST_CASE("The check of a formula names its variables, its constant value or its fault") {
  CHECK(in_words(Formula::check("x*t + X").uses) == "x, X, t");
  CHECK_FALSE(Formula::check("x*t + X").constant);
  CHECK(Formula::check("2*pi").constant == 2 * std::numbers::pi);
  CHECK(Formula::check("if(1 == 1, 4, 5)").constant == 4);
  CHECK(std::isinf(*Formula::check("1/0").constant));

  CHECK(error_of("1d3") == "unknown name 'd3' at character 2");
  CHECK(Formula::check("sine(x)").unknown_name == "sine");
  CHECK(error_of("2*sin") == "function 'sin' at character 3 needs its arguments in parentheses: sin(...)");
  CHECK(error_of("if + 1") == "function 'if' at character 1 needs its arguments in parentheses: if(...)");
  CHECK(error_of("5 GPa") == "unknown name 'GPa' at character 3");
  CHECK(error_of("3x") == "unexpected 'x' at character 2");
  CHECK(error_of("x^^2") == "unexpected '^' at character 3");
  CHECK(error_of("(x") == "a closing parenthesis is missing");
  CHECK(error_of("x)") == "unexpected ')' at character 2");
  CHECK(error_of("x +") == "unexpected end of the expression");
  CHECK(error_of("") == "empty");
  CHECK(error_of("sin(x, 1)") == "too many arguments of 'sin'");
  CHECK(error_of("if(x, 1)") == "too few arguments of 'if'");
  CHECK(error_of("x, y") == "a comma is outside of a function call");
  CHECK(error_of(std::string(200'000, '(').c_str()) == "the expression is too long");
  CHECK(error_of(("1" + std::string(90, 'e')).c_str()) ==
        "unknown name '1" + std::string(39, 'e') + "...' at character 1");
  for (const char* text : {"x = 3", "3 == (x = 4)", "= x"})
    CHECK(error_of(text) == "'=' is an assignment; use == for equality");
  for (const char* text : {"x == 3", "x <= 3", "x >= 3", "x != 3"}) CHECK(error_of(text).empty());
}

TEST_CASE("Particles start with the values of their body's expressions at their places") {
  BodyInput body;
  body.initial_velocity = {0, 3, 0};
  body.initial_velocity_expressions = {{0, "0.1*sin(pi*x/25)", "InitialVelocity", "vx", {}},
                                       {2, "1/(X - 2)", "InitialVelocity", "vz", {}}};
  StartVelocity initial(body, 0);
  CHECK(initial.varies());
  CHECK(initial.at({4, 5, 6}) == Vec3<double>{0.1 * std::sin(std::numbers::pi * 4 / 25), 3, 0.5});
  CHECK_FALSE(initial.first_not_finite({4, 5, 6}));
  const auto fault = initial.first_not_finite({2, 5, 6});
  REQUIRE(fault);
  CHECK(fault->expression == 1);
  CHECK(not_finite_in_words(fault->value) == "infinite");

  body.prescribed_velocity = Vec3<double>{1, 0, 2};
  body.prescribed_velocity_expressions = {{1, "y*t", "PrescribedVelocity", "vy", {}}};
  CHECK(StartVelocity(body, 0.5).at({4, 5, 6}) == Vec3<double>{1, 2.5, 2});
}
