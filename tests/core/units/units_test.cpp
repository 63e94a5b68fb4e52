#include "core/units/units.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace mpm::core;

std::string message(const std::function<void()>& f) {
  try {
    f();
  } catch (const UnitError& error) { return error.what(); }
  return "no error";
}

TEST_CASE("dimensions in the words of the laws' tables", "[units]") {
  struct Row {
    std::string_view text;
    Dimension dimension;
  };
  for (const Row& row : {Row{"1", {}},
                         {"degree", {}},
                         {"stress", {-1, 1, -2, 0}},
                         {"stress time", {-1, 1, -1, 0}},
                         {"density", {-3, 1, 0, 0}},
                         {"velocity", {1, 0, -1, 0}},
                         {"1/time", {0, 0, -1, 0}},
                         {"1/temperature", {0, 0, 0, -1}},
                         {"energy/(mass temperature)", {2, 0, -2, -1}},
                         {"power/(length temperature)", {1, 1, -3, -1}},
                         {"stress^2", {-2, 2, -4, 0}},
                         {"1/(stress time)", {1, -1, 1, 0}},
                         {"stress length^0.5", {-0.5, 1, -2, 0}}}) {
    INFO(row.text);
    CHECK(parse_dimension(row.text) == row.dimension);
    CHECK(parse_dimension(to_text(row.dimension)) == row.dimension);
  }
  const auto exponent = [](std::string_view name) {
    return name == "nn" ? std::optional(0.6) : std::nullopt;
  };
  CHECK(parse_dimension("stress time^nn", exponent) == Dimension{-1, 1, -2 + 0.6, 0});
  CHECK(message([&] { parse_dimension("stress time^k", exponent); }) ==
        "'stress time^k' has the unknown exponent 'k'");
  CHECK(message([] { parse_dimension("Stress"); }) == "'Stress' is no dimension; did you mean 'stress'?");
  CHECK(message([] { parse_dimension("energy/mass temperature"); }) ==
        "'energy/mass temperature' is ambiguous after the slash: put brackets around the denominator, as in "
        "J/(kg K)");
  CHECK(message([] { parse_dimension("(stress"); }) == "'(stress' lacks a closing bracket");
  CHECK(message([] { parse_dimension(" "); }) == "' ' is empty");
  CHECK(message([] { parse_dimension("stress/"); }) == "'stress/' ends too early");
  CHECK(message([] { parse_dimension("stress^"); }) == "'stress^' lacks an exponent after ^");
}

TEST_CASE("quantities in the units of a case", "[units]") {
  const UnitSystem si, impact = UnitSystem::parse("mm g ms"), explosive = UnitSystem::parse("us cm g");
  struct Row {
    std::string_view text;
    double in_si, in_mm_g_ms, in_cm_g_us;
  };
  // mm g ms has MPa and mJ, cm g us has Mbar: the usual systems of impact and of detonation.
  for (const Row& row : {Row{"0.31", 0.31, 0.31, 0.31},
                         {"8960 kg/m^3", 8960, 0.00896, 8.96},
                         {"90 MPa", 90e6, 90, 9e-4},
                         {"3.712 Mbar", 3.712e11, 371200, 3.712},
                         {"0.6930 cm/us", 6930, 6930, 0.693},
                         {"3.94 mm/\xC2\xB5s", 3940, 3940, 0.394},
                         {"383 J/(kg K)", 383, 383, 3.83e-6},
                         {"0.40 J/(g K)", 400, 400, 4e-6},
                         {"1 1/s", 1, 1e-3, 1e-6},
                         {"1 s^-1", 1, 1e-3, 1e-6},
                         {"2e-3 Pa s", 2e-3, 2e-6, 2e-8},
                         {"1356 K", 1356, 1356, 1356},
                         {"-171 GPa", -171e9, -171e3, -1.71},
                         {"1 psi", 6894.757293168361, 6894.757293168361e-6, 6894.757293168361e-11}}) {
    INFO(row.text);
    const Quantity q = parse_quantity(row.text);
    CHECK(si.value_of(q) == Approx(row.in_si).epsilon(1e-15));
    CHECK(impact.value_of(q) == Approx(row.in_mm_g_ms).epsilon(1e-15));
    CHECK(explosive.value_of(q) == Approx(row.in_cm_g_us).epsilon(1e-15));
    CHECK(convert(row.in_si, si, impact, q.unit.dimension) == Approx(row.in_mm_g_ms).epsilon(1e-15));
    CHECK(convert(impact.value_of(q), impact, explosive, q.unit.dimension) ==
          Approx(row.in_cm_g_us).epsilon(1e-14));
  }
  CHECK(impact.value_of(parse_quantity("8960 kg/m^3")) == 0.00896);  // the decimals of a table stay
  CHECK(message([] { parse_quantity("90MPa"); }) == "'90MPa' needs a blank between number and unit");
  CHECK(message([] { parse_quantity("MPa"); }) == "'MPa' does not begin with a number");
  CHECK(message([] { parse_quantity("90 Mpa"); }) == "'Mpa' is no unit; did you mean 'MPa'?");
}

TEST_CASE("names of systems and of their derived units", "[units]") {
  const UnitSystem impact = UnitSystem::parse("mm g ms");
  CHECK(impact == UnitSystem::parse(" ms, mm, g"));
  CHECK(impact == UnitSystem::parse("mm-g-ms-K"));
  CHECK(UnitSystem::parse("SI") == UnitSystem());
  CHECK(UnitSystem::parse("kg m s").name() == "m kg s");
  CHECK(UnitSystem::parse("cgs").name() == "cm g s");
  const auto name = [&](std::string_view dimension) { return impact.unit_name(parse_dimension(dimension)); };
  CHECK(name("stress") == "MPa");
  CHECK(name("energy") == "mJ");
  CHECK(name("density") == "g/mm^3");
  CHECK(name("velocity") == "mm/ms");
  CHECK(name("1/time") == "1/ms");
  CHECK(name("temperature") == "K");
  CHECK(name("1") == "1");
  CHECK(UnitSystem().unit_name(parse_dimension("stress")) == "Pa");
  CHECK(UnitSystem::parse("cm g us").unit_name(parse_dimension("stress")) == "Mbar");
  CHECK(UnitSystem::parse("cm g ms").unit_name(parse_dimension("stress")) == "bar");
  CHECK(UnitSystem::parse("in lb ms").unit_name(parse_dimension("stress")) == "lb/(in ms^2)");
  CHECK(message([] { UnitSystem::parse("mm g"); }) ==
        "'mm g' lacks a unit of time; three units are needed, as in \"mm g ms\"");
  CHECK(message([] { UnitSystem::parse("mm cm g ms"); }) ==
        "'mm cm g ms' names two units of length, mm and cm");
  CHECK(message([] { UnitSystem::parse("mm G ms"); }) ==
        "'G' is no unit of length, mass or time; did you mean 'g'?");
  CHECK(message([] { UnitSystem::parse("mm MPa ms"); }) ==
        "'MPa' is no unit of length, mass or time; known are m, dm, cm, mm, um, nm, km, in, ft, kg, g, mg, "
        "ug, t, tonne, lb, s, ms, us, ns, min, h");
}

}  // namespace
