// Notes of what a body's shape becomes that the input does not say.

#include <algorithm>

#include <catch2/catch.hpp>

#include "core/has_shape.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;
using test::bar;
using test::notes_of;
using test::replaced;

TEST_CASE("a block whose spacing does not divide its edges") {
  const auto notes = [](const std::string& dp) {
    return notes_of(replaced(bar, "dp=\"0.38\" x0=\"0\" y0=\"0\" z0=\"0\" lx=\"3.8\" ly=\"3.8\" lz=\"19\"",
                             "dp=\"" + dp + "\" x0=\"0\" y0=\"0\" z0=\"0\" lx=\"2\" ly=\"2\" lz=\"2\""));
  };
  CHECK(notes("0.5").empty());
  CHECK(notes("0.501").empty());  // 0.6 % more mass
  CHECK(notes("0.7") ==
        std::vector<std::string>{
            "line 12: <Body>: body 'rod': dp 0.7 does not divide its edges 2 x 2 x 2: its particles "
            "fill 2.1 x 2.1 x 2.1, with the mass 0.0827007 instead of 0.07144"});
  const std::vector<std::string> wide = notes("3");
  REQUIRE(wide.size() == 2);
  CHECK(wide[1] ==
        "line 12: <Body>: body 'rod': its particles are 3 apart, more than a cell, 0.76: neighbours then "
        "share few "
        "nodes or none, and the body has little strength or none. Use a dp of about half a cell");
}

TEST_CASE("one particle in a cell") {
  const std::string single = replaced(bar, "dp=\"0.38\"", "dp=\"0.76\"");
  const auto about_one = [](std::string_view text) {
    return std::ranges::count_if(notes_of(text), [](const std::string& note) {
      return note.starts_with("line 12: <Body>: body 'rod' has one particle in a cell: with these shape");
    });
  };
  CHECK(about_one(single) == 1);
  CHECK(about_one(replaced(single, "<Solution>", "<Solution algorithm=\"MUSL\">")) == 1);
  CHECK(test::parse(single).has_single_particles);
  CHECK_FALSE(test::parse(bar).has_single_particles);
  CHECK(test::parse(single).solution.scheme == core::Scheme::usavg);
  CHECK(test::parse(bar).solution.scheme == core::Scheme::musl);
  CHECK(test::parse(replaced(single, "<Solution>", "<Solution algorithm=\"MUSL\">")).solution.scheme ==
        core::Scheme::musl);
  CHECK(test::parse(replaced(single, "<Solution>", "<Solution transfer=\"PIC\">")).solution.scheme ==
        core::Scheme::musl);
  CHECK(about_one(bar) == 0);
  CHECK(about_one(replaced(single, "<Solution>", "<Solution algorithm=\"USAVG\">")) == 0);
  if (core::has_shape("DDMP")) CHECK(about_one(replaced(single, "linear", "DDMP")) == 1);
  if (core::has_shape("SGMP")) CHECK(about_one(replaced(single, "linear", "SGMP")) == 0);
}

}  // namespace
