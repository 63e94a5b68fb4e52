#include "io/input/text.hpp"

#include <clocale>

#include <catch2/catch.hpp>

namespace {

using namespace mpm::io;

TEST_CASE("reals are read in C notation with full precision") {
  const std::pair<std::string_view, double> right[] = {{"25.4", 25.4},
                                                       {".5", 0.5},
                                                       {"1.", 1.},
                                                       {"+2e-3", 2e-3},
                                                       {"-1.5E+3", -1500.},
                                                       {" 7.6\n", 7.6},
                                                       {"8.93e-3", 8.93e-3},
                                                       {"1e308", 1e308},
                                                       {"007", 7.},
                                                       {"+.5", 0.5},
                                                       {"0.1234567890123456789", 0.1234567890123456789}};
  for (const auto& [text, value] : right) {
    INFO(text);
    REQUIRE(parse_real(text).has_value());
    CHECK(*parse_real(text) == value);
  }
}

TEST_CASE("what is not a finite real in C notation is refused") {
  for (const std::string_view text :
       {"",   " ", "1d3", "1,5", "nan", "NaN",   "inf",   "-inf", "infinity", "0x10",  "1e999", "1e",
        "e5", ".", "+",   "-",   "1 2", "1.2.3", "1e5.0", "--1",  "+-1",      "12abc", "1f",    "1e+"}) {
    INFO('\'' << text << '\'');
    CHECK_FALSE(parse_real(text).has_value());
  }
}

TEST_CASE("numbers do not depend on the locale") {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  if (!std::setlocale(LC_ALL, "de_DE.UTF-8")) WARN("no German locale here; the default one is tried only");
  CHECK(parse_real("1.5") == 1.5);
  CHECK_FALSE(parse_real("1,5").has_value());
  std::setlocale(LC_ALL, before.c_str());
}

TEST_CASE("integers are decimal") {
  CHECK(parse_integer("42") == 42);
  CHECK(parse_integer("+3") == 3);
  CHECK(parse_integer("-3") == -3);
  for (const std::string_view text : {"", "1.0", "1e3", "0x1", "9223372036854775808", "+-1", "++1", "1 2"})
    CHECK_FALSE(parse_integer(text).has_value());
}

TEST_CASE("the nearest right word") {
  const std::vector<std::string_view> words{"Sphere", "Block", "Cylinder", "BoolBodyA", "dp", "x0", "y0"};
  const std::pair<std::string_view, std::string_view> cases[] = {{"sphere", "Sphere"},
                                                                 {"BLOCK", "Block"},
                                                                 {"Cilinder", "Cylinder"},
                                                                 {"Cylidner", "Cylinder"},
                                                                 {"pd", "dp"},
                                                                 {"x", "x0"},
                                                                 {"Torus", ""},
                                                                 {"", ""},
                                                                 {"q", ""}};
  for (const auto& [word, expected] : cases) {
    INFO(word);
    CHECK(nearest(word, words) == expected);
  }
  CHECK(did_you_mean("Blok", words) == "; did you mean 'Block'?");
  CHECK(did_you_mean(std::string(100000, 'x'), words).empty());
}

TEST_CASE("lists and lengths") {
  CHECK(split(" a | b|c ", '|') == std::vector<std::string_view>{"a", "b", "c"});
  CHECK(split("a||b", '|') == std::vector<std::string_view>{"a", "", "b"});
  CHECK(split("  ", '|').empty());
  CHECK(shortened("Kupfer", 6) == "Kupfer");
  CHECK(shortened("\xE9\x93\x9C\xE9\x93\x9C", 5) == "\xE9\x93\x9C...");  // whole characters only
}

TEST_CASE("the hash is FNV-1a") {  // test vectors of the FNV draft, appendix C
  CHECK(fnv1a_hex("") == "cbf29ce484222325");
  CHECK(fnv1a_hex("a") == "af63dc4c8601ec8c");
  CHECK(fnv1a_hex("foobar") == "85944171f73967e8");
}

}  // namespace
