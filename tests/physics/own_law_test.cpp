// Laws from outside the lists, with state of their own, run through the same stages. How a program comes to
// know such a law stands in registry_test.cpp.

#include <cmath>

#include <catch2/catch.hpp>

#include "physics/laws.hpp"
#include "physics/material/pressure_stage.hpp"
#include "physics/material/strength_stage.hpp"
#include "physics/strength/elasticity.hpp"

namespace mpm::tests {

using core::Batch;
using core::Column;

namespace {

/// Elastic with a shear stiffness that wears off with the length of the strain path.
struct Wearing : physics::IsotropicElasticity {
  static constexpr std::array state{Column::history_0};
  double wear = 0;
  static constexpr auto parameters() {
    return physics::join(physics::elastic_parameters<Wearing>(),
                         std::array<physics::Parameter<Wearing>, 1>{
                             {{&Wearing::wear, {.name = "wear", .meaning = "1/strain"}}}});
  }
  void prepare() { derive_moduli(); }
  template <class T>
  void update(physics::StrengthPoint<T>& point) const {
    point.history_0 += sqrt(contract(point.strain, point.strain));
    point.s = point.s + (2 * shear / (1.0 + wear * point.history_0)) * point.strain;
    point.shear_modulus = shear;
  }
};

/// A bulk law with a memory: it unloads along a stiffer line from the largest compression reached.
struct Compacting {
  static constexpr std::array state{Column::max_compression};
  double loading = 1e9, unloading = 4e9;
  template <class T>
  physics::LinearisedPressure<T> linearise(physics::EosPoint<T>& point) const {
    point.max_compression = core::max(point.max_compression, point.compression);
    const T a = loading * point.max_compression + unloading * (point.compression - point.max_compression);
    return {a, 0.0, unloading, 0.0};
  }
};

struct OneBlock {
  explicit OneBlock(const core::ColumnSet& extra) {
    core::ColumnSet set = core::ColumnSet::mechanics();
    set.add(extra);
    layout = core::ColumnLayout(set);
    block.assign(static_cast<std::size_t>(layout.block_doubles()), 0.0);
    batch.layout = &layout;
    batch.blocks = 1, batch.particles = 8;
    batch.block[0] = block.data();
    batch.dt = 1e-6, batch.cell_size = 1;
    fill(Column::mass, 1000), fill(Column::volume, 1);
  }
  void fill(Column c, double value) { std::fill_n(batch.column(c, 0), 8, value); }
  double get(Column c) { return batch.column(c, 0)[0]; }
  core::ColumnLayout layout;
  std::vector<double> block;
  Batch batch{};
};

}  // namespace

TEST_CASE("a strength law with state of its own", "[physics][own-law]") {
  core::LawInput input{"Wearing", {{"Young", 1e9}, {"Poisson", 0.25}, {"wear", 100.0}}, {}};
  const auto law = physics::read_law<Wearing>(input, "StrengthModel", 1000);
  OneBlock one(physics::columns_of(law));
  std::fill_n(one.batch.gradient[1], 8, 1e3);  // d v_x / d y, and no spin: symmetric
  std::fill_n(one.batch.gradient[3], 8, 1e3);
  double path = 0, stress = 0;
  for (int i = 0; i < 5; ++i) {
    physics::update_kinematics<core::Real>(one.batch, {}, {.reference_density = 1000});
    physics::update_strength<core::Real>(one.batch, law, {});
    path += std::sqrt(2.0) * 1e-3;
    stress += 2 * law.shear / (1 + 100 * path) * 1e-3;
    CHECK(one.get(Column::history_0) == Approx(path).epsilon(1e-14));
    CHECK(one.get(Column::s_xy) == Approx(stress).epsilon(1e-13));
  }
}

TEST_CASE("an equation of state with state of its own", "[physics][own-law]") {
  const Compacting eos;
  OneBlock one(physics::columns_of(eos));
  physics::PressureRules rules;
  rules.reference_density = 1000;
  rules.initial_modulus = 4e9;
  double compression = 0, largest = 0;
  for (const double rate : {-1e4, -1e4, 5e3, 5e3, -2e4}) {
    std::fill_n(one.batch.gradient[0], 8, rate);
    physics::update_kinematics<core::Real>(one.batch, {}, {.reference_density = 1000});
    physics::update_pressure<core::Real>(one.batch, eos, rules, nullptr);
    compression = 1 / one.get(Column::volume) - 1;
    largest = std::max(largest, compression);
    CHECK(one.get(Column::max_compression) == Approx(largest).epsilon(1e-12));
    CHECK(one.get(Column::pressure) == Approx(eos.loading * largest + eos.unloading * (compression - largest))
                                           .margin(1e-15 * eos.unloading));
  }
}

}  // namespace mpm::tests
