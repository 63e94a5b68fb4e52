// A rigid body (manual 3.2.1.13): no stress, no deformation, no wave speed, whatever the grid does.

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using physics::PointDriver;

TEST_CASE("a rigid particle feels no strain and limits no time step", "[physics][rigid]") {
  const auto material = make(sample("Rigid").input);
  CHECK(material->rigid());
  CHECK_FALSE(make(copper("IsoElastic"))->rigid());
  CHECK(material->initial_sound_speed() == 0);
  CHECK(material->columns({}) == core::ColumnSet{});
  PointDriver point(*material, {.cell_size = 1e-3});
  CHECK(point.critical_speed() == 0);
  const RandomPath path(3, 0.2, 2e-5);
  for (int i = 0; i < 100; ++i) {
    point.step(path.gradient(i * 2e-7), 2e-7);
    CHECK(mises(point.stress()) == 0);
    CHECK(point.stress().xx == 0);
    CHECK(point.volume_ratio() == 1);
    CHECK(point.energy() == 0);
    CHECK(point.critical_speed() == 0);
    CHECK(point.sound_speed() == 0);
  }
  CHECK(point.events().negative_volume == 0);
}

}  // namespace mpm::tests
