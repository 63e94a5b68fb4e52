// The material library against the laws' tables, against what its values say of each other, and in inputs.

#include "io/input/library.hpp"

#include <cmath>
#include <map>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "io/input/material_reader.hpp"
#include "io/input/node.hpp"
#include "io/input/reader.hpp"
#include "io/input/specification.hpp"
#include "physics/catalogue.hpp"
#include "physics/material/material.hpp"
#include "physics/point/point_driver.hpp"

namespace {

using namespace mpm;

const io::ElementSpec& element_of(const io::ElementSpec& root, const std::string& name) {
  const io::ElementSpec* element = root.child("Material")->child(name);
  REQUIRE(element);
  return *element;
}

/// In SI.
std::map<std::string, double> values(const std::string& entry) {
  std::map<std::string, double> all;
  REQUIRE(io::library().find(entry));
  for (const io::LibraryValue& v : io::library().find(entry)->values)
    all[v.element == "ReferenceDensity" ? "rho" : v.attribute] =
        core::UnitSystem().value_of(core::parse_quantity(v.text));
  return all;
}

std::string fault(const std::function<void()>& f) {
  try {
    f();
  } catch (const core::InputErrors& errors) { return errors.what(); }
  return "none";
}

std::string materials(std::string_view text) {
  return fmt::format("<PeneBlast version=\"1.0\">{}</PeneBlast>", text);
}

core::MaterialInput parsed(std::string_view text) {
  return io::parse_material(materials(text), "case.xmp", physics::catalogue(), {}).material;
}

std::string error_about(std::string_view text) {
  return fault([&] { parsed(text); });
}

TEST_CASE("every value of the library has a name, a unit and a range that its law knows", "[library]") {
  const io::ElementSpec root = io::language(physics::catalogue());
  for (const io::LibraryEntry& entry : io::library().entries) {
    for (const io::LibraryValue& v : entry.values) {
      INFO(entry.name << " " << v.element << " " << v.attribute << "=" << v.text);
      const std::string& type = v.element == "StrengthModel" ? entry.strength : entry.eos;
      const io::AttributeSpec* row = nullptr;
      for (const io::AttributeSpec& a : element_of(root, v.element).attributes)
        if (a.name == v.attribute && (type.empty() || v.element == "ReferenceDensity" || a.applies_to(type)))
          row = &a;
      REQUIRE(row);
      const core::Quantity quantity = core::parse_quantity(v.text);
      CHECK(io::fault(*row, fmt::format("{}", quantity.value * quantity.unit.in_si)) == "");
      CHECK(core::to_text(core::parse_dimension(row->unit)) == core::to_text(quantity.unit.dimension));
    }
  }
}

TEST_CASE("explosives: the JWL pressure and slope at the Chapman-Jouguet state are the table's",
          "[library]") {
  // V = 1 - P/(rho D^2), E = E0 + P (1 - V)/2, dp/dV along the isentrope = -rho D^2 (Rayleigh line).
  for (const char* name : {"TNT-JWL", "PBX9404-JWL", "Tetryl-JWL"}) {
    INFO(name);
    auto x = values(name);
    const double rayleigh = x["rho"] * x["D"] * x["D"], v = 1 - x["PCJ"] / rayleigh;
    const double e = x["E0"] + 0.5 * x["PCJ"] * (1 - v);
    const auto pressure = [&](double volume) {
      const auto term = [&](double a, double r) {
        return a * (1 - x["w"] / (r * volume)) * std::exp(-r * volume);
      };
      return term(x["A"], x["R1"]) + term(x["B"], x["R2"]) + x["w"] * e / volume;
    };
    const double h = 1e-5;
    const double slope = (pressure(v + h) - pressure(v - h)) / (2 * h) - pressure(v) * x["w"] / v;
    // The coefficients are printed with three to four digits.
    CHECK(pressure(v) == Approx(x["PCJ"]).epsilon(1e-3));
    CHECK(slope == Approx(-rayleigh).epsilon(1e-3));
  }
}

TEST_CASE("ceramics: moduli and elastic limit belong together", "[library]") {
  // G and K as table 6.7 prints them; the library has Young and Poisson. 10^9 Pa.
  struct Row {
    const char* name;
    double shear, bulk;
  };
  for (const Row& row : {Row{"B4C-JH2", 197, 233},
                         {"SiC-JH2", 183, 204.785},
                         {"AlN-JH2", 127, 201},
                         {"Al2O3-JH2", 90.16, 130.95},
                         {"FloatGlass-JH2", 30.4, 45.4}}) {
    INFO(row.name);
    auto x = values(row.name);
    const double shear = x["Young"] / (2 * (1 + x["Poisson"])),
                 bulk = x["Young"] / (3 * (1 - 2 * x["Poisson"]));
    CHECK(shear == Approx(row.shear * 1e9).epsilon(2e-3));  // Poisson has three digits
    CHECK(bulk == Approx(row.bulk * 1e9).epsilon(5e-3));
    if (std::string(row.name) == "SiC-JH2") continue;  // its note says why
    double mu = x["Phel"] / bulk;
    for (int i = 0; i < 50; ++i) mu = x["Phel"] / (bulk + mu * (x["K2"] + mu * x["K3"]));
    CHECK(2 * shear * mu / (1 + mu) == Approx(x["Shel"]).epsilon(0.015));  // two digits
  }
}

TEST_CASE("a library material is the same in all units", "[library]") {
  const auto stress = [](std::string_view units) {
    const auto choice = io::library_material("OFHC-Cu-JC|Cu-Gruneisen", units, physics::catalogue());
    const auto material = physics::make_material(choice.material);
    physics::PointDriver point(*material, {});
    const double second = 1 / choice.units->in_si(core::parse_dimension("time"));
    drive(point, {.kind = physics::PathKind::uniaxial_strain, .rate = 1e4 / second, .targets = {-0.05}},
          [](double) {});
    return point.stress().xx * choice.units->in_si(core::parse_dimension("stress"));
  };
  const double si = stress("SI");
  CHECK(si < -6e9);
  for (const char* units : {"mm g ms", "cm g us", "mm kg ms", "mm t s", "in lb ms"}) {
    INFO(units);
    CHECK(stress(units) == Approx(si).epsilon(1e-11));
  }
}

TEST_CASE("every entry makes a material or says what is missing", "[library]") {
  const core::Catalogue catalogue = physics::catalogue();
  for (const io::LibraryEntry& entry : io::library().entries) {
    INFO(entry.name);
    const std::string said = fault([&] {
      const auto choice = io::library_material(entry.name, "mm g ms", catalogue);
      const auto material = physics::make_material(choice.material);
      CHECK(material->reference_density() == choice.material.reference_density);
    });
    INFO(said);
    if (entry.strength.empty())
      CHECK(said.find("attribute 'type' is missing") != said.npos);
    else if (entry.name == "W-alloy-JC" || entry.name == "DU-0.75Ti-JC")
      CHECK(said.find("attribute 'Young' is missing") != said.npos);
    else if (entry.strength == "HighExpBurn")  // complete but for the place where it is lit
      CHECK(said.find("add a Detonation") != said.npos);
    else
      CHECK(said == "none");
  }
}

TEST_CASE("values in an input: filled in, overridden, supplemented", "[library]") {
  const auto plain = parsed("<Material name='cu' library='OFHC-Cu-JC' units='mm g ms'/>");
  CHECK(plain.name == "cu");
  CHECK(plain.reference_density == 0.00896);
  CHECK(plain.strength.type == "JohnsonCook");
  CHECK(plain.strength.at("Yield0") == 90);
  CHECK(plain.strength.at("epso") == 1e-3);
  CHECK(plain.strength.at("SpecHeat") == 383);
  CHECK(!plain.eos);

  const auto changed = parsed(R"(
    <Material name='cu' library='OFHC-Cu-JC|Cu-Gruneisen' units='mm g ms'>
      <StrengthModel Yield0='120' bq1='2'/><ReferenceDensity value='9e-3'/>
      <FailureModel type='PlaStrain' epmax='2'/>
    </Material>)");
  CHECK(changed.reference_density == 9e-3);
  CHECK(changed.strength.at("Yield0") == 120);
  CHECK(changed.strength.at("bq1") == 2);
  CHECK(changed.strength.at("B") == 292);
  CHECK(changed.strength.at("SpecHeat") == 383);  // of the first; the second has 400
  REQUIRE(changed.eos);
  CHECK(changed.eos->at("C0") == 3940);
  CHECK(changed.failures.size() == 1);

  const auto other_law = parsed(R"(
    <Material name='cu' library='OFHC-Cu-JC' units='mm g ms'>
      <StrengthModel type='IsoElastic' Young='1' Poisson='0.1'/></Material>)");
  CHECK(other_law.strength.type == "IsoElastic");
  CHECK(!other_law.strength.has("Yield0"));

  const auto header = parsed(
      "<Header><Unit time='us' length='cm' mass='g'/></Header>"
      "<Material name='cu' library='OFHC-Cu-JC'/>");
  CHECK(header.strength.at("Yield0") == 9e-4);

  const auto set = [](std::vector<std::string> settings) {
    return io::library_material("OFHC-Cu-JC|Cu-Gruneisen", "cm g us", physics::catalogue(), settings)
        .material;
  };
  CHECK(set({"Yield0=120 MPa"}).strength.at("Yield0") == Approx(1.2e-3).epsilon(1e-15));
  CHECK(set({"Yield0=1e-3", "EquationOfState.S1=1.5", "ReferenceDensity=9"}).eos->at("S1") == 1.5);
}

TEST_CASE("faults about the library", "[library]") {
  CHECK(error_about("<Material name='cu' library='OFHC-Cu-J' units='mm g ms'/>") ==
        "case.xmp:1: <Material library=\"OFHC-Cu-J\">: the library has no 'OFHC-Cu-J'; did you mean "
        "'OFHC-Cu-JC', 'OFHC-Cu-JC-damage'?; mpm_check --materials lists its contents");
  CHECK(error_about("<Material name='cu' library='copper' units='mm g ms'/>") ==
        "case.xmp:1: <Material library=\"copper\">: the library has no 'copper'; did you mean "
        "'OFHC-Cu-linear', 'OFHC-Cu-JC', 'OFHC-Cu-JC-damage', 'Cu-Gruneisen'?; mpm_check --materials lists "
        "its contents");
  CHECK(error_about("<Material name='cu' library='' units='mm g ms'/>") ==
        "case.xmp:1: <Material library=\"\">: expected the name of a library material; mpm_check --materials "
        "lists them");
  CHECK(error_about("<Material name='cu' library='OFHC-Cu-JC'/>") ==
        "case.xmp:1: <Material>: attribute 'units' is missing: library values are converted to the units of "
        "this input, as in units=\"mm g ms\" (or give length, mass and time in Header / Unit)");
  CHECK(error_about("<Header><Unit time='milliseconds' length='mm' mass='g'/></Header>"
                    "<Material name='cu' library='OFHC-Cu-JC'/>")
            .find("(or give length, mass and time in Header / Unit; of those given there 'milliseconds' is "
                  "no unit "
                  "of length, mass or time") != std::string::npos);
  CHECK(error_about("<Material name='cu' library='OFHC-Cu-JC' units='mm g msec'/>") ==
        "case.xmp:1: <Material units=\"mm g msec\">: 'msec' is no unit of length, mass or time; known are m, "
        "dm, cm, mm, um, nm, km, in, ft, kg, g, mg, ug, t, tonne, lb, s, ms, us, ns, min, h");
  CHECK(error_about("<Header><Unit time='s' length='m' mass='kg'/></Header>"
                    "<Material name='cu' library='OFHC-Cu-JC' units='mm g ms'/>") ==
        "case.xmp:1: <Material units=\"mm g ms\">: contradicts Header / Unit, m kg s; all units of an input "
        "must agree");
  CHECK(error_about("<Material name='a' library='OFHC-Cu-JC' units='mm g ms'/>"
                    "<Material name='b' library='OFHC-Cu-JC' units='SI'/>") ==
        "case.xmp:1: <Material units=\"SI\">: contradicts an earlier material, mm g ms; all units of an "
        "input must agree");
  CHECK(error_about("<Material name='cu' units='mm g ms'><ReferenceDensity value='1'/>"
                    "<StrengthModel type='IsoElastic' Young='1' Poisson='0'/></Material>") ==
        "case.xmp:1: <Material units=\"mm g ms\">: is used only with library, to convert its values");
  CHECK(error_about("<Material name='cu' library='OFHC-Cu-JC' units='mm g ms'>\n"
                    "<StrengthModel Yield0='-1'/></Material>") ==
        "case.xmp:2: <StrengthModel Yield0=\"-1\">: expected a number greater than 0");
  const auto set = [](const std::string& setting) {
    return fault(
        [&] { io::library_material("OFHC-Cu-JC|Cu-Gruneisen", "mm g ms", physics::catalogue(), {setting}); });
  };
  CHECK(set("Yeild0=1") == "library: --set Yeild0=1: the material has no 'Yeild0'; did you mean 'Yield0'?");
  CHECK(set("Yield0") == "library: --set Yield0: expected NAME=VALUE");
  CHECK(set("Yield0=1 MPA") == "library: --set Yield0=1 MPA: 'MPA' is no unit; did you mean 'MPa'?");
  CHECK(set("Yield0=120 kg") == "library: --set Yield0=120 kg: expected a unit of stress, not of mass");
  CHECK(set("ReferenceDensity=9 g") ==
        "library: --set ReferenceDensity=9 g: expected a unit of density, not of mass");
  CHECK(set("Poisson=0.3 s") ==
        "library: --set Poisson=0.3 s: expected a number without a unit, not of time");
  CHECK(set("Poisson=0.3 1") == "none");
  CHECK(set("Yield0=-1") == "library: <StrengthModel Yield0=\"-1\">: expected a number greater than 0");
  CHECK(set("nosuch.Yield0=1") == "library: --set nosuch.Yield0=1: the material has no 'Yield0'");
}

TEST_CASE("the listing names every entry with its laws and sources", "[library]") {
  core::Catalogue few;
  few.strength = {{"JohnsonCook", "", {}}};
  const std::string text = fmt::format("\n{}", io::library_listing(io::library(), few));
  for (const io::LibraryEntry& entry : io::library().entries) {
    INFO(entry.name);
    CHECK((text.find("\n" + entry.name + ": ") != text.npos || entry.strength.empty()));
    CHECK(text.find("\n" + entry.name) != text.npos);
  }
  CHECK(text.find("\nOFHC-Cu-JC: JohnsonCook\n") != text.npos);
  CHECK(text.find("RHT (not a law of this program), PAlpha (not a law of this program)") != text.npos);
  CHECK(text.find("StrengthModel: Yield0 90 MPa, B 292 MPa, n 0.31, C 0.025, m 1.09, melt 1356 K, SpecHeat "
                  "383 J/(kg K), epso 1 1/s  [MPM3D-6.2]") != text.npos);
  for (const io::LibrarySource& source : io::library().sources)
    CHECK(text.find("\n  [" + source.id + "] " + source.text) != text.npos);
}

}  // namespace
