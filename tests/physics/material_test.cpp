// The material as a whole: padding lanes, what contradicts itself in the input, and
// the catalogue that the input reader works from.

#include "physics/material/material.hpp"

#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "core/scene/errors.hpp"
#include "physics/catalogue.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Batch;
using core::Column;

namespace {

/// A batch of particles.
struct Crowd {
  Crowd(const physics::Material& material, int blocks) {
    core::ColumnSet set = core::ColumnSet::mechanics();
    set.add(material.columns({}));
    layout = core::ColumnLayout(set);
    memory.assign(static_cast<std::size_t>(blocks * layout.block_doubles()), 0.0);
    batch.layout = &layout;
    batch.blocks = blocks;
    batch.particles = 8 * blocks;
    batch.dt = 1e-7, batch.cell_size = 1e-3;
    for (int b = 0; b < blocks; ++b) batch.block[b] = memory.data() + b * layout.block_doubles();
    for (int i = 0; i < 8 * blocks; ++i) at(Column::mass, i) = 8960, at(Column::volume, i) = 1;
    material.initialise(batch, {});
  }
  double& at(Column c, int place) { return batch.column(c, place / 8)[place % 8]; }
  core::ColumnLayout layout;
  std::vector<double> memory;
  Batch batch{};
};

std::string fault(const core::MaterialInput& input) {
  try {
    make(input);
  } catch (const core::InputErrors& errors) { return errors.what(); }
  return "";
}

}  // namespace

TEST_CASE("lanes beyond the last particle are not counted", "[physics][material]") {
  const auto material = make(copper("IsoHarden", true));
  for (const int used : {1, 5, 8}) {
    Crowd crowd(*material, 2);
    crowd.batch.particles = 8 + used;
    for (int i = 0; i < 16; ++i) crowd.batch.gradient[0][i] = -2 / crowd.batch.dt;
    material->update(crowd.batch, {});
    CHECK(crowd.batch.events.negative_volume == 8 + used);
  }
}

TEST_CASE("what contradicts itself is refused by name", "[physics][material]") {
  using Catch::Matchers::Contains;
  using Catch::Matchers::Equals;
  core::MaterialInput input = copper("IsoHarden");
  input.strength.values["TangMod"] = 124e9;
  CHECK_THAT(fault(input), Contains("TangMod must be smaller than Young"));

  input = copper("JohnsonCook");
  input.strength.values["melt"] = 200;
  CHECK_THAT(fault(input), Contains("melt must be greater than roomt"));

  input = copper("IsoElastic", true);
  input.strength.type = "CauchyElastic";
  CHECK_THAT(fault(input), Contains("remove the EquationOfState"));

  input = {};
  input.reference_density = 1000;
  input.strength.type = "Null";
  CHECK_THAT(fault(input), Contains("add an EquationOfState"));

  input = copper("IsoElastic");
  input.strength.values["TemperatureCoefficient"] = 1e-5;
  CHECK_THAT(fault(input), Contains("TemperatureCoefficient needs SpecHeat"));
  input.strength.values["SpecHeat"] = 383;
  CHECK_THAT(fault(input), Equals(""));
  input = copper("IsoHarden heated", true);
  input.strength.values["TemperatureCoefficient"] = 1e-5;
  CHECK_THAT(fault(input), Contains("TemperatureCoefficient must be 0 with Gruneisen"));
  input = copper("IsoElastic");
  input.strength.values["CoefficientOfThermalConductivity"] = 400;
  CHECK_THAT(fault(input), Contains("CoefficientOfThermalConductivity needs SpecHeat"));
  input = copper("IsoElastic");
  input.random_failure.enable = true;
  input.random_failure.distribution = core::RandomFailureInput::Distribution::gauss;
  CHECK_THAT(fault(input), Equals(""));
  input = copper("IsoElastic");
  input.strength.type = "Unobtainium";
  CHECK_THAT(fault(input), Contains("Unobtainium is not implemented"));
}

TEST_CASE("the catalogue names each parameter once, with a meaning and a range that holds its default",
          "[physics][material]") {
  const core::Catalogue catalogue = physics::catalogue();
  const auto check = [](std::string_view owner, const std::vector<core::ParameterInfo>& parameters) {
    std::set<std::string_view> names;
    for (const core::ParameterInfo& p : parameters) {
      INFO(owner << " " << p.name);
      CHECK(names.insert(p.name).second);
      CHECK_FALSE(p.meaning.empty());
      CHECK_FALSE(p.dimension.empty());
      CHECK(p.min < p.max);
      if (p.default_value == p.default_value) {
        CHECK(p.default_value >= p.min);
        CHECK(p.default_value <= p.max);
      }
    }
  };
  check("StrengthModel", catalogue.common_strength);
  check("EquationOfState", catalogue.common_eos);
  for (const auto* family : {&catalogue.strength, &catalogue.eos, &catalogue.failure}) {
    for (const core::TypeInfo& type : *family) {
      CHECK_FALSE(type.summary.empty());
      check(type.name, type.parameters);
    }
  }
}

}  // namespace mpm::tests
