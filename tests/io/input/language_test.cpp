// The notation of Specification.xml, and how the laws' tables are merged into it.

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <catch2/catch.hpp>

#include "io/input/reference.hpp"
#include "io/input/specification.hpp"
#include "physics/catalogue.hpp"
#include "tests/io/input/support.hpp"

namespace {

using namespace mpm;

TEST_CASE("the notation of the manual") {  // the example of its chapter 5.1
  const io::ElementSpec detonation = io::parse_specification(R"(<Detonation spec="OPTIONAL_MULTIPLE, NO_DATA">
    <Item spec="REQUIRED, NO_DATA" attribute1="type, REQUIRED, STRING, point|plane" attribute2="time, REQUIRED, DOUBLE"
      attribute3="x, REQUIRED, DOUBLE, , ForTypes: point" attribute4="normal, REQUIRED, INTEGER, 0:2, ForTypes: plane"/>
    </Detonation>)");
  CHECK((!detonation.required && detonation.multiple));
  const io::ElementSpec* item = detonation.child("Item");
  REQUIRE(item != nullptr);
  CHECK((item->required && !item->multiple));
  CHECK(item->attributes[0].range.words == std::vector<std::string>{"point", "plane"});
  CHECK(item->attribute("x", "point") != nullptr);
  CHECK(item->attribute("x", "plane") == nullptr);
  const io::AttributeSpec* normal = item->attribute("normal", "plane");
  REQUIRE(normal != nullptr);
  CHECK((normal->range.contains(0) && normal->range.contains(2) && !normal->range.contains(3)));
}

TEST_CASE("ranges") {
  const auto range = [](const std::string& text) {
    return io::parse_specification("<E spec='REQUIRED' attribute1='a, REQUIRED, DOUBLE, " + text + "'/>")
        .attributes[0];
  };
  CHECK((range("positive").range.contains(0) && !range("positive").range.contains(-1)));
  CHECK((range("negative").range.contains(0) && !range("negative").range.contains(1)));
  CHECK((range("-1:2").range.contains(-1) && range("-1:2").range.contains(2)));
  CHECK((!range("(0:1]").range.contains(0) && range("(0:1]").range.contains(1)));
  CHECK((!range("(0:inf)").range.contains(0) && range("(0:inf)").range.contains(1e300)));
  CHECK(expectation(range("(0:inf)")) == "a number greater than 0");
  CHECK(expectation(range("positive")) == "a number of at least 0");
  CHECK(expectation(range("(-1:0.5)")) == "a number in (-1, 0.5)");
  CHECK(expectation(range("")) == "a number");
}

TEST_CASE("mistakes in the specification are found when it is read") {
  for (const std::string_view wrong :
       {"<E spec='SOMETIMES'/>", "<E spec='REQUIRED' attribute2='a, REQUIRED, DOUBLE'/>",
        "<E spec='REQUIRED' attribute1='a, REQUIRED, FLOAT'/>",
        "<E spec='REQUIRED' attribute1='a, REQUIRED, DOUBLE, x:y'/>", "<E spec='REQUIRED' default1='1'/>",
        "<E spec='REQUIRED' colour='red'/>", "<E", "<E/>", "<E spec='REQUIREDX'/>",
        "<E spec='REQUIRED, STRING'/>", "<E spec='REQUIRED' attribute1='a, REQUIRED, DOUBLE, 0:1, 2:3'/>",
        "<E spec='REQUIRED'><F spec='OPTIONAL'/><F spec='OPTIONAL'/></E>"})
    CHECK_THROWS_AS(io::parse_specification(wrong), core::InputErrors);
}

TEST_CASE("laws' tables replace the rows of the types that they implement") {
  const io::ElementSpec root = io::language(test::small_catalogue());
  const io::ElementSpec& strength = *root.child("Material")->child("StrengthModel");
  CHECK(strength.attribute("strength", "Homemade")->required);
  CHECK(strength.attribute("Poisson", "IsoHarden")->range.max == 0.5);
  CHECK(strength.attribute("Poisson", "IsoHarden")->range.min == 0);    // of the table
  CHECK(strength.attribute("Poisson", "ElaPlastic")->range.min == -1);  // of the Specification
  CHECK(strength.attribute("SpecHeat", "IsoHarden")->later);            // only the Specification knows it
  CHECK_FALSE(strength.attribute("SpecHeat", "IsoHarden")->required);
  CHECK(strength.attribute("Young", "Null")->range.words.empty());
  CHECK(root.child("Material")->child("FailureModel")->attribute("Erosion", "Pmin") != nullptr);
}

/// Whatever the program implements is part of the language: its types and parameters are in the
/// Specification.
void check_family(std::string_view element, const std::vector<core::TypeInfo>& types) {
  const io::ElementSpec& spec = *io::specification().child("Material")->child(element);
  const std::vector<std::string>& words = spec.attribute("type", {})->range.words;
  for (const core::TypeInfo& type : types) {
    INFO(element << " " << type.name);
    CHECK(std::ranges::find(words, type.name) != words.end());
    for (const core::ParameterInfo& p : type.parameters) {
      INFO(p.name);
      CHECK(spec.attribute(p.name, type.name) != nullptr);
      CHECK_FALSE(p.meaning.empty());
    }
  }
}

TEST_CASE("the program's laws are in the Specification") {
  const core::Catalogue catalogue = physics::catalogue();
  check_family("StrengthModel", catalogue.strength);
  check_family("EquationOfState", catalogue.eos);
  check_family("FailureModel", catalogue.failure);
}

TEST_CASE("the reference names every attribute") {
  const std::string reference = io::keyword_reference(test::small_catalogue());
  for (const std::string_view piece :
       {"## Grid\n", "### Grid / Cell / XMin\n", "`DamageRandom`", "`NotConsiderVisForCp`",
        "`type=\"Homemade\"`: a law that only", "`type=\"RHT\"` (not yet)", "**Not implemented yet.**",
        "`RectangluarForMembrane` is accepted for"})
    CHECK(reference.find(piece) != reference.npos);
}

TEST_CASE("docs/keywords.md is what the program prints") {
  const char* const source = std::getenv("MPM_SOURCE");
  if (!source) {
    WARN("MPM_SOURCE is not set: docs/keywords.md is not compared");
    return;
  }
  const std::string committed = io::read_bytes(std::filesystem::path(source) / "docs/keywords.md");
  INFO("remedy: mpm_check --reference > docs/keywords.md");
  CHECK((committed == io::keyword_reference(physics::catalogue())));
}

}  // namespace
