// The notation of Specification.xml, and the laws in the language.

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
        "<E spec='REQUIRED'><F spec='OPTIONAL'/><F spec='OPTIONAL'/></E>",
        "<E spec='REQUIRED' laws='plastic' attribute1='type, REQUIRED, STRING'/>",
        "<E spec='REQUIRED' laws='strength' attribute1='kind, REQUIRED, STRING'/>"})
    CHECK_THROWS_AS(io::parse_specification(wrong), core::InputErrors);
}

TEST_CASE("types and attributes of laws are those of the catalogue") {
  const io::ElementSpec root = io::language(test::small_catalogue());
  const io::ElementSpec& strength = *root.child("Material")->child("StrengthModel");
  CHECK(strength.attribute("type", {})->range.words ==
        std::vector<std::string>{"IsoHarden", "JohnsonCook", "Null", "Homemade"});
  CHECK(strength.attribute("strength", "Homemade")->required);
  CHECK(strength.attribute("strength", "IsoHarden") == nullptr);
  CHECK(strength.attribute("Poisson", "IsoHarden")->range.max == 0.5);
  CHECK(strength.attribute("Young", "IsoHarden")->required);
  CHECK_FALSE(strength.attribute("Young", "Null")->required);  // of the common table
  CHECK(strength.attribute("SpecHeat", "IsoHarden") == nullptr);
  CHECK(root.child("Material")->child("FailureModel")->attribute("Erosion", "Pmin") != nullptr);
}

TEST_CASE("the Specification itself says nothing about a law") {
  for (const char* element : {"StrengthModel", "EquationOfState", "FailureModel"}) {
    INFO(element);
    const io::ElementSpec& spec = *io::specification().child("Material")->child(element);
    CHECK(spec.attribute("type", {})->range.words.empty());
    CHECK(spec.together.empty());
    for (const io::AttributeSpec& a : spec.attributes) {
      INFO(a.name);
      const bool of_the_element = a.name == "type" || a.name == "Erosion" || a.name == "limiter";
      CHECK((of_the_element && a.for_types.empty()));
    }
  }
}

TEST_CASE("every law of the program has a word, and every parameter a meaning, in the language") {
  const core::Catalogue catalogue = physics::catalogue();
  const io::ElementSpec root = io::language(catalogue);
  const auto check = [&](std::string_view element, const std::vector<core::TypeInfo>& types) {
    const io::ElementSpec& spec = *root.child("Material")->child(element);
    const std::vector<std::string>& words = spec.attribute("type", {})->range.words;
    CHECK(words.size() == types.size());
    for (const core::TypeInfo& type : types) {
      INFO(element << " " << type.name);
      CHECK(std::ranges::find(words, type.name) != words.end());
      for (const core::ParameterInfo& p : type.parameters) {
        INFO(p.name);
        const io::AttributeSpec* row = spec.attribute(p.name, type.name);
        REQUIRE(row != nullptr);
        CHECK(row->required == p.required);
        CHECK((row->range.min == p.min && row->range.max == p.max));
        CHECK_FALSE(row->meaning.empty());
      }
    }
  };
  check("StrengthModel", catalogue.strength);
  check("EquationOfState", catalogue.eos);
  check("FailureModel", catalogue.failure);
}

TEST_CASE("the reference names every attribute") {
  const std::string reference = io::keyword_reference(test::small_catalogue());
  for (const std::string_view piece :
       {"## Grid\n", "### Grid / Cell / XMin\n", "`DamageRandom`", "`NotConsiderVisForCp`",
        "`type=\"Homemade\"`: a law of these tests", "**Not implemented yet.**",
        "`RectangluarForMembrane` is accepted for", "## Output variables\n",
        "| `engi` | energy | internal energy of the particle, not per mass |\n"})
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
