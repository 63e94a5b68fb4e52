// What a material's particles carry; that a law uses its columns and no others stands in laws_test.cpp.

#include <catch2/catch.hpp>

#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::ColumnSet;

TEST_CASE("a particle with IsoHarden and Gruneisen takes 152 bytes", "[physics][columns]") {
  const auto material = make(copper("IsoHarden", true));
  ColumnSet set = ColumnSet::mechanics();
  set.add(material->columns({}));
  CHECK(core::ColumnLayout(set).bytes_per_particle() == 152);
}

TEST_CASE("columns follow from what the material can do", "[physics][columns]") {
  CHECK(make(copper("IsoElastic"))->columns({}) == ColumnSet{});
  CHECK(make(copper("IsoHarden"))->columns({}) == ColumnSet{Column::effective_plastic_strain});
  CHECK(make(copper("IsoHarden heated"))->columns({}) ==
        ColumnSet{Column::effective_plastic_strain, Column::temperature});
  CHECK(make(copper("JohnsonCook"))->columns({}) ==
        ColumnSet{Column::effective_plastic_strain, Column::temperature});
  CHECK(make(copper("JohnsonCook damaged"))->columns({}) == ColumnSet{Column::effective_plastic_strain,
                                                                      Column::temperature, Column::damage,
                                                                      Column::failed, Column::void_volume});
  core::MaterialInput input = copper("IsoElastic");
  input.failures.push_back({{"Pmin", {{"pmin", -1e6}}, {}}, false});
  CHECK(make(input)->columns({}) == ColumnSet{Column::failed, Column::void_volume});
  CHECK(make(copper("IsoElastic"))->columns({.volume_update = 4}).has(Column::strain_xz));
  CHECK(make(copper("IsoElastic"))->columns({.keep_strain = true}).has(Column::strain_xx));
}

}  // namespace mpm::tests
