// Malformed and hostile XML: one clear message, quickly.

#include <algorithm>
#include <ctime>

#include <catch2/catch.hpp>
#include <sys/mman.h>

#include "io/input/document.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;

std::string with_points(int count) {
  std::string points;
  for (int i = 0; i < count; ++i) points += "<Point mass='1' x='1' y='2' z='3'/>\n";
  const std::string text = test::replaced(test::bar, "type=\"Block\"", "type=\"Point\"");
  return test::replaced(text,
                        "<Geometry dp=\"0.38\" x0=\"0\" y0=\"0\" z0=\"0\" lx=\"3.8\" ly=\"3.8\" lz=\"19\"/>",
                        "<Geometry>" + points + "</Geometry>");
}

/// Of the processor, since the program has begun.
double seconds_spent() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Thirty times what this machine takes to read a sound input of so many bytes; an attack that succeeds takes
/// thousands of times.
double quickly(std::size_t bytes) {
  static const double per_byte = [] {
    const std::string sound = with_points(20000);
    const double before = seconds_spent();
    test::parse(sound);
    return (seconds_spent() - before) / static_cast<double>(sound.size());
  }();
  return 30 * per_byte * static_cast<double>(std::max<std::size_t>(bytes, 1000000));
}

std::string first_error(std::string_view text) {
  const double limit = quickly(text.size()), before = seconds_spent();
  const std::string found = test::faults(text).front();
  CHECK(seconds_spent() - before < limit);
  return found;
}

const std::string no_doctype =
    "a document type (DOCTYPE) is not accepted: the input language has no entities";

TEST_CASE("malformed XML") {
  CHECK(first_error("<PeneBlast version=\"1.0\">\n<Grid>\n</PeneBlast>") ==
        "line 3: not well-formed XML: Opening and ending tag mismatch: Grid line 2 and PeneBlast");
  CHECK(first_error("<PeneBlast version=1.0/>") == "line 1: not well-formed XML: AttValue: \" or ' expected");
  CHECK(first_error("<?xml verison=\"1.0\"?><PeneBlast/>").starts_with("line 1: not well-formed XML: "));
  CHECK(first_error("<PeneBlast a=\"<\"/>").starts_with("line 1: not well-formed XML: "));
  CHECK(first_error("<PeneBlast/><PeneBlast/>").starts_with("line 1: not well-formed XML: "));
  CHECK(first_error("<PeneBlast>&unknown;</PeneBlast>").starts_with("line 1: not well-formed XML: "));
  CHECK(
      first_error(std::string("<PeneBlast>\0</PeneBlast>", 24)).starts_with("line 1: not well-formed XML: "));
  for (const std::size_t length : {10, 100, 500, 1000})
    CHECK(first_error(test::bar.substr(0, length)).find("not well-formed XML: ") != std::string::npos);
}

TEST_CASE("entities") {
  std::string bomb = "<?xml version=\"1.0\"?>\n<!DOCTYPE PeneBlast [<!ENTITY e0 \"ha\">";
  for (int i = 1; i < 40; ++i)
    bomb += "<!ENTITY e" + std::to_string(i) + " \"&e" + std::to_string(i - 1) + ";&e" +
            std::to_string(i - 1) + ";\">";
  CHECK(first_error(bomb + "]><PeneBlast version=\"&e39;\"/>") == "line 2: " + no_doctype);
  CHECK(first_error("<!DOCTYPE P [<!ENTITY x SYSTEM \"file:///etc/passwd\">]><P>&x;</P>") ==
        "line 1: " + no_doctype);
  CHECK(first_error("<!DOCTYPE P [<!ENTITY % x SYSTEM \"http://localhost:1/a.dtd\"> %x;]><P/>") ==
        "line 1: " + no_doctype);
  CHECK(first_error("<!DOCTYPE P SYSTEM \"http://localhost:1/a.dtd\"><P/>") == "line 1: " + no_doctype);
}

TEST_CASE("depth, breadth and length") {
  std::string deep, broad = "<PeneBlast version=\"1.0\" ";
  for (int i = 0; i < 1000000; ++i) deep += "<a>";
  CHECK(first_error(deep).find("not well-formed XML: Excessive depth") != std::string::npos);
  for (int i = 0; i < 1000000; ++i) broad += " a" + std::to_string(i) + "='1'";
  CHECK(first_error(broad + "/>") == "line 1: more than 2000 attributes on one element");
  std::string wide("\xFF\xFE");
  for (const char c : broad) wide += {c, '\0'};
  CHECK(first_error(wide) == "line 1: more than 2000 attributes on one element");
  std::string comment = "<!--" + std::string(100000, '=') + "-->";  // not attributes
  CHECK(first_error(test::replaced(test::bar, "<Header>", comment + "<Header>")) == "ok");
  const std::string value(9000000, 'x');
  CHECK(first_error(test::replaced(test::bar, "name=\"rod\"", "name=\"" + value + "\"")) == "ok");
  CHECK(first_error(test::replaced(test::bar, "type=\"Block\"", "type=\"" + value + "\"")).size() < 500);
}

TEST_CASE("many particles in the input itself") {
  constexpr int count = 200000;
  const std::string text = with_points(count);
  const double limit = quickly(text.size()), before = seconds_spent();
  const core::Scene scene = test::parse(text);
  CHECK(seconds_spent() - before < limit);
  CHECK(std::get<core::PointGeometry>(scene.components[0].bodies[0].geometry).points.size() == count);
}

TEST_CASE("too many bytes") {
  constexpr std::size_t size = io::largest_document + 1;
  void* const unused = mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  REQUIRE(unused != MAP_FAILED);
  std::optional<io::XmlError> error;
  io::parse_document({static_cast<const char*>(unused), size}, error);
  munmap(unused, size);
  REQUIRE(error.has_value());
  CHECK(error->message.find("store particles in a separate file") != std::string::npos);
}

}  // namespace
