// A law's particles carry the columns that it declares: all of those are read or written on some path, and no
// other column is. A layout with every column there is holds a pattern where nothing was declared; the
// pattern must survive, and the results must be those of the lean layout.

#include <bit>
#include <cmath>
#include <cstdint>

#include <catch2/catch.hpp>

#include "physics/point/point_driver.hpp"
#include "tests/physics/random_path.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

namespace {

using core::Column;
using core::ColumnSet;
using physics::PointDriver;

constexpr int steps = 60;
constexpr double duration = 2e-5;

/// Columns that are written for whoever puts them into the layout, without being state of the law.
bool is_output(Column c) { return c == Column::yield_stress || c == Column::sound_speed; }

ColumnSet every_column_but_strains() {
  ColumnSet set;
  for (int i = 0; i < core::column_count; ++i) {
    const auto c = static_cast<Column>(i);
    // The layout itself switches these on: their presence is the request to accumulate, to heat, to fail.
    const bool requests = c >= Column::strain_xx && c <= Column::strain_xz;
    if (!requests && c != Column::failed && c != Column::temperature) set.add(c);
  }
  return set;
}

std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

void walk(PointDriver& point, double strain) {
  const RandomPath path(9, strain, duration);
  for (int i = 0; i < steps; ++i) point.step(path.gradient((i + 0.5) * duration / steps), duration / steps);
}

/// State after the path, the column `changed` set to `value` before its second half (identity: none changed).
std::vector<double> state_after(const physics::Material& material, const ColumnSet& watched, double strain,
                                Column changed, double value) {
  PointDriver point(material, {.cell_size = 1e-3});
  walk(point, strain);
  if (changed != Column::identity) point.set(changed, value);
  walk(point, strain);
  std::vector<double> state;
  for (int c = 0; c < core::column_count; ++c) {
    if (watched.has(static_cast<Column>(c))) state.push_back(point.value(static_cast<Column>(c)));
  }
  return state;
}

}  // namespace

TEST_CASE("columns that are not declared are neither read nor written", "[physics][columns]") {
  const double pattern = std::nan("0x123456");
  for (const Sample& s : samples()) {
    INFO(s.label);
    const auto material = make(s.input);
    ColumnSet declared = ColumnSet::mechanics();
    declared.add(material->columns({}));
    PointDriver::Options options{.cell_size = 1e-3};
    PointDriver lean(*material, options);
    options.extra_columns = every_column_but_strains();
    PointDriver full(*material, options);
    for (int i = 0; i < core::column_count; ++i) {
      const auto c = static_cast<Column>(i);
      if (full.has(c) && !declared.has(c)) full.set(c, pattern);
    }
    walk(lean, s.strain);
    walk(full, s.strain);
    for (int i = 0; i < core::column_count; ++i) {
      const auto c = static_cast<Column>(i);
      INFO(core::name_of(c));
      if (declared.has(c)) CHECK(bits(full.value(c)) == bits(lean.value(c)));
      if (full.has(c) && !declared.has(c) && !is_output(c)) CHECK(bits(full.value(c)) == bits(pattern));
    }
  }
}

TEST_CASE("columns that are declared are used", "[physics][columns]") {
  for (const Sample& s : samples()) {
    INFO(s.label);
    const auto material = make(s.input);
    const ColumnSet declared = material->columns({});
    ColumnSet watched = ColumnSet::mechanics();
    watched.add(declared);
    const std::vector<double> plain = state_after(*material, watched, s.strain, Column::identity, 0);
    for (int i = 0; i < core::column_count; ++i) {
      const auto c = static_cast<Column>(i);
      if (!declared.has(c)) continue;
      INFO(core::name_of(c));
      PointDriver start(*material, {}), end(*material, {});
      walk(end, s.strain);
      // What is burnt at the start stays so: initialise has written it.
      const bool burnt = c == Column::burn_fraction && start.value(c) == 1;
      const bool written = burnt || bits(start.value(c)) != bits(end.value(c));
      const double other = c == Column::temperature ? 600 : 0.75;
      std::vector<double> changed = state_after(*material, watched, s.strain, c, other);
      CHECK((written || changed != plain));
    }
  }
}

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
  CHECK(make(copper("JohnsonCook damaged"))->columns({}) ==
        ColumnSet{Column::effective_plastic_strain, Column::temperature, Column::damage, Column::failed});
  core::MaterialInput input = copper("IsoElastic");
  input.failures.push_back({{"Pmin", {{"pmin", -1e6}}, {}}, false});
  CHECK(make(input)->columns({}) == ColumnSet{Column::failed});
  CHECK(make(copper("IsoElastic"))->columns({.volume_update = 4}).has(Column::strain_xz));
  CHECK(make(copper("IsoElastic"))->columns({.keep_strain = true}).has(Column::strain_xx));
}

}  // namespace mpm::tests
