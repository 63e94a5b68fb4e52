// Node fields by name: where they lie in their records, and that those of one phase do not overlap.
#include "core/grid/node_fields.hpp"

#include <catch2/catch.hpp>

using namespace mpm::core;

TEST_CASE("Every node field has a name of its own and lies in a record of its array") {
  for (std::size_t i = 0; i < node_field_table.size(); ++i) {
    const NamedNodeFields& f = node_field_table[i];
    CAPTURE(f.name);
    CHECK(f.fields.count > 0);
    CHECK(f.fields.end() <= record_doubles(f.fields.array));
    for (std::size_t j = 0; j < i; ++j) CHECK(f.name != node_field_table[j].name);
  }
}

TEST_CASE("What a pass maps is named fields of one array") {
  STATIC_REQUIRE(mapped::momentum_mass_force == NodeFields{NodeArray::first, 0, 7});
  STATIC_REQUIRE(mapped::momentum_mass == NodeFields{NodeArray::second, 0, 4});
  STATIC_REQUIRE(maps_momentum(mapped::momentum_mass_force));
  STATIC_REQUIRE(maps_mass(mapped::momentum_mass));
  STATIC_REQUIRE(!maps_mass(mapped::momentum));
  STATIC_REQUIRE(maps_force(mapped::force));
  STATIC_REQUIRE(!maps_momentum(mapped::force));
  STATIC_REQUIRE(!maps_force(mapped::momentum_mass));
  // Neither neighbours nor of one array: not to be joined.
  CHECK_THROWS(node_field::momentum | node_field::force);
  CHECK_THROWS(node_field::momentum | node_field::second_mass);
}

TEST_CASE("A node's motion takes the place of its sums") {
  double record[node_doubles] = {1, 2, 3, 4, 5, 6, 7, 8};
  const MappedRecord<double> sums{record};
  const Motion motion{record};
  CHECK(sums.momentum()[2] == 3);
  CHECK(sums.mass() == 4);
  CHECK(sums.force()[0] == 5);
  CHECK(motion.velocity() == sums.momentum());
  CHECK(&motion.mass() == &sums.mass());
  CHECK(motion.increment() == sums.force());
  CHECK(motion.strain_velocity() == motion.increment());
  CHECK(motion.omitted_share() == 8);
}
