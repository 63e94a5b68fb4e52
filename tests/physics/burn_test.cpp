// HighExpBurn: lighting times from points and rectangles, and the burn fraction (manual 3-9 to 3-13) against
// values worked out by hand. TNT in mm, g, ms: MPa and m/s.

#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "physics/checks/law_checks.hpp"
#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::DetonationItem;
using physics::PointDriver;

namespace {

constexpr double density = 1.63e-3, speed = 6930, pcj = 21e3, cell = 2;
/// V at which beta burn is complete, 1 - PCJ/(rho0 D^2).
const double v_cj = 1 - pcj / (density * speed * speed);

core::MaterialInput tnt(double beta) {
  core::MaterialInput input;
  input.name = "TNT";
  input.reference_density = density;
  input.strength = {"HighExpBurn", {{"D", speed}, {"beta", beta}, {"PCJ", pcj}}, {}};
  input.eos = core::LawInput{
      "JWL", {{"A", 371.2e3}, {"B", 3.23e3}, {"R1", 4.15}, {"R2", 0.95}, {"w", 0.30}, {"E0", 7.0e3}}, {}};
  return input;
}

DetonationItem point_at(double time, core::Vec3<double> position) {
  DetonationItem item;
  item.time = time;
  item.position = position;
  return item;
}

DetonationItem rectangle(double time, int normal, double location, std::array<double, 2> lower,
                         std::array<double, 2> upper) {
  DetonationItem item;
  item.kind = DetonationItem::Kind::plane;
  item.time = time;
  item.normal = normal;
  item.location = location;
  item.lower = lower;
  item.upper = upper;
  return item;
}

/// Lighting time of a particle at x.
double lighting_time(const std::vector<DetonationItem>& sources, std::array<double, 3> x) {
  const auto material = physics::make_material(tnt(2), sources);
  core::ColumnSet set = core::ColumnSet::mechanics();
  set.add(material->columns({}));
  const core::ColumnLayout layout(set);
  std::vector<double> block(static_cast<std::size_t>(layout.block_doubles()), 0.0);
  core::Batch batch{};
  batch.layout = &layout;
  batch.blocks = 1, batch.particles = core::block_lanes;
  batch.block[0] = block.data();
  batch.cell_size = cell;
  for (int lane = 0; lane < core::block_lanes; ++lane) {
    batch.column(Column::mass, 0)[lane] = density;
    batch.column(Column::volume, 0)[lane] = 1;
    for (int a = 0; a < 3; ++a) {
      // Only the last lane is the particle in question: the others must not matter to it.
      const double other = 100.0 * lane + 7 * a;
      batch.column(core::next(Column::position_x, a), 0)[lane] =
          lane == core::block_lanes - 1 ? x[static_cast<std::size_t>(a)] : other;
    }
  }
  material->initialise(batch, {});
  return batch.column(Column::lighting_time, 0)[core::block_lanes - 1];
}

double fraction(const PointDriver& point) { return point.value(Column::burn_fraction); }

}  // namespace

TEST_CASE("a point lights by the distance from it", "[physics][burn]") {
  // 3-4-12: 13 away.
  CHECK(lighting_time({point_at(0, {1, 2, 3})}, {4, 6, 15}) == Approx(13 / speed).epsilon(1e-14));
  CHECK(lighting_time({point_at(0.25, {1, 2, 3})}, {4, 6, 15}) == Approx(0.25 + 13 / speed).epsilon(1e-14));
  CHECK(lighting_time({point_at(0.25, {1, 2, 3})}, {1, 2, 3}) == 0.25);
}

TEST_CASE("a rectangle lights by the distance from its nearest place", "[physics][burn]") {
  // The other axes in ascending order: y z, x z, x y.
  const auto item = [](int normal) { return rectangle(0.5, normal, 10, {-1, -2}, {3, 4}); };
  const auto after = [](double distance) { return Approx(0.5 + distance / speed).epsilon(1e-14); };
  CHECK(lighting_time({item(0)}, {12, 0, 0}) == after(2));    // facing it
  CHECK(lighting_time({item(0)}, {7, 3, -2}) == after(3));    // facing its corner, from the other side
  CHECK(lighting_time({item(0)}, {10, 6, 8}) == after(5));    // in its plane, 3 and 4 beyond the corner
  CHECK(lighting_time({item(0)}, {22, -4, 8}) == after(13));  // 12, 3 and 4
  CHECK(lighting_time({item(1)}, {-4, 22, 8}) == after(13));  // left and right are along x
  CHECK(lighting_time({item(1)}, {2, 22, 0}) == after(12));
  CHECK(lighting_time({item(2)}, {-4, 8, 22}) == after(13));
  CHECK(lighting_time({item(2)}, {2, -2, 10}) == after(0));
}

TEST_CASE("of several points and rectangles the first to arrive lights", "[physics][burn]") {
  const std::vector<DetonationItem> sources{point_at(0, {0, 0, 0}), point_at(0, {100, 0, 0}),
                                            rectangle(0, 1, 50, {-10, -10}, {110, 10})};
  CHECK(lighting_time(sources, {30, 0, 0}) == Approx(30 / speed).epsilon(1e-14));
  CHECK(lighting_time(sources, {70, 0, 0}) == Approx(30 / speed).epsilon(1e-14));
  CHECK(lighting_time(sources, {50, 0, 0}) == Approx(50 / speed).epsilon(1e-14));
  CHECK(lighting_time(sources, {50, 40, 0}) == Approx(10 / speed).epsilon(1e-14));
  // A nearer one that is lit later does not keep the front of a farther one waiting.
  const std::vector<DetonationItem> timed{point_at(0, {0, 0, 0}), point_at(80 / speed, {100, 0, 0})};
  CHECK(lighting_time(timed, {85, 0, 0}) == Approx(85 / speed).epsilon(1e-14));
  CHECK(lighting_time(timed, {95, 0, 0}) == Approx(85 / speed).epsilon(1e-14));
}

TEST_CASE("programmed burn takes the time in which the front runs through 1.5 cells", "[physics][burn]") {
  const double lit = 10 / speed, ramp = 1.5 * cell / speed, dt = ramp / 8;
  const auto material = physics::make_material(tnt(2), {point_at(0, {10, 0, 0})});
  PointDriver point(*material, {.cell_size = cell});
  CHECK(point.value(Column::lighting_time) == Approx(lit).epsilon(1e-14));
  CHECK(fraction(point) == 0);
  CHECK(point.value(Column::pressure) == 0);

  point.step({}, lit);
  CHECK(fraction(point) == 0);
  CHECK(point.value(Column::pressure) == 0);
  for (int i = 1; i <= 12; ++i) {
    point.step({}, dt);
    CHECK(fraction(point) == Approx(std::min(i / 8.0, 1.0)).epsilon(1e-12));
    // Volume and energy stand still: 3-47 at V = 1 with E0.
    const double products = 371.2e3 * (1 - 0.3 / 4.15) * std::exp(-4.15) +
                            3.23e3 * (1 - 0.3 / 0.95) * std::exp(-0.95) + 0.3 * 7e3;
    CHECK(point.value(Column::pressure) == Approx(fraction(point) * products).epsilon(1e-12));
    CHECK(point.energy() == 7e3);
  }
}

TEST_CASE("beta burn goes with the compression, to its end at the CJ volume", "[physics][burn]") {
  const auto material = physics::make_material(tnt(1));
  PointDriver point(*material, {.cell_size = cell});
  CHECK_FALSE(point.has(Column::lighting_time));
  const double rate = 1e3, dt = 1e-5;
  double volume = 1;
  for (int i = 0; i < 32; ++i) {
    point.step({-rate, 0, 0, 0, 0, 0, 0, 0, 0}, dt);
    volume *= 1 - rate * dt;
    CHECK(fraction(point) == Approx(std::min((1 - volume) / (1 - v_cj), 1.0)).epsilon(1e-12));
  }
  CHECK(volume < v_cj);
  CHECK(fraction(point) == 1);
}

TEST_CASE("what has burnt stays burnt", "[physics][burn]") {
  const auto material = physics::make_material(tnt(1));
  PointDriver point(*material, {.cell_size = cell});
  point.step({-1e3, 0, 0, 0, 0, 0, 0, 0, 0}, 1e-4);
  const double burnt = fraction(point);
  CHECK(burnt == Approx(0.1 / (1 - v_cj)).epsilon(1e-12));
  point.step({1e3, 0, 0, 0, 0, 0, 0, 0, 0}, 5e-4);
  CHECK(fraction(point) == burnt);
}

TEST_CASE("with both burns the farther one counts", "[physics][burn]") {
  const auto material = physics::make_material(tnt(0), {point_at(0, {0, 0, 0})});
  PointDriver point(*material, {.cell_size = cell});
  const double ramp = 1.5 * cell / speed;
  // Compressed by 10 % at once, at a quarter of the ramp: F1 = 0.25, F2 = 0.1/(1 - V_CJ) = 0.373.
  point.step({-0.1 / (0.25 * ramp), 0, 0, 0, 0, 0, 0, 0, 0}, 0.25 * ramp);
  CHECK(fraction(point) == Approx(0.1 / (1 - v_cj)).epsilon(1e-12));
  point.step({}, 0.25 * ramp);
  CHECK(fraction(point) == Approx(0.5).epsilon(1e-12));
}

TEST_CASE("energy and burn fraction are solved together", "[physics][burn]") {
  // E - E^n = -h (p^n + p), p = F (a + b E), with the law at the new volume: thesis 2-92 for what has burnt.
  const auto material = physics::make_material(tnt(0), {point_at(0, {0, 0, 0})});
  PointDriver point(*material, {.cell_size = cell});
  double energy = point.energy(), p = 0, q_before = 0, volume = 1;
  for (int i = 0; i < 10; ++i) {
    point.step({-2e3, 0, 0, 0, 0, 0, 0, 0, 0}, 1e-5);
    const double now = point.volume_ratio();
    // The artificial viscosity heats too.
    const double q = point.value(Column::viscous_pressure);
    const double work = -0.5 * (now - volume) * (p + q_before + point.value(Column::pressure) + q);
    CHECK(point.energy() == Approx(energy + work).epsilon(1e-12));
    const double v = now;
    const double products = 371.2e3 * (1 - 0.3 / (4.15 * v)) * std::exp(-4.15 * v) +
                            3.23e3 * (1 - 0.3 / (0.95 * v)) * std::exp(-0.95 * v) + 0.3 * point.energy() / v;
    CHECK(point.value(Column::pressure) == Approx(fraction(point) * products).epsilon(1e-10));
    energy = point.energy(), p = point.value(Column::pressure), volume = now, q_before = q;
  }
}

TEST_CASE("explosives have artificial viscosity and a sound speed before they are lit", "[physics][burn]") {
  const auto material = physics::make_material(tnt(2), {point_at(1, {0, 0, 0})});
  PointDriver point(*material, {.cell_size = cell});
  point.step({-1e2, 0, 0, 0, 0, 0, 0, 0, 0}, 1e-6);
  CHECK(fraction(point) == 0);
  CHECK(point.value(Column::viscous_pressure) > 0);
  // As of the products: what comes may come within a step.
  const auto burnt = physics::make_material(tnt(2), {point_at(-1, {0, 0, 0})});
  PointDriver products(*burnt, {.cell_size = cell});
  CHECK(fraction(products) == 1);
  CHECK(material->initial_sound_speed() == burnt->initial_sound_speed());
  CHECK(point.critical_speed() > 0.9 * burnt->initial_sound_speed());
}

TEST_CASE("a detonation has the units of its explosive", "[physics][burn]") {
  // The front reaches the point, at the origin, while the check's path is walked.
  for (const DetonationItem& source :
       {point_at(1e-6, {0.05, 0.02, 0}), rectangle(1e-6, 2, 0.05, {-0.01, -0.02}, {0.01, 0.02})}) {
    const physics::LawSample sample{tnt(2), {source}};
    CHECK(physics::law_check("units").failures(sample, physics::built_in_laws()) ==
          std::vector<std::string>{});
  }
}

TEST_CASE("contradictions about burning are refused", "[physics][burn]") {
  const auto refusal = [](const core::MaterialInput& input, const std::vector<DetonationItem>& sources) {
    try {
      physics::make_material(input, sources);
    } catch (const core::InputErrors& errors) { return std::string(errors.what()); }
    return std::string();
  };
  const std::vector<DetonationItem> lit{point_at(0, {0, 0, 0})};
  using Catch::Matchers::Contains;
  CHECK(refusal(tnt(2), lit).empty());
  CHECK(refusal(tnt(0), {}).empty());  // beta burn may begin by itself
  CHECK_THAT(refusal(tnt(2), {}), Contains("add a Detonation"));
  core::MaterialInput input = tnt(1);
  input.strength.values.erase("PCJ");
  CHECK_THAT(refusal(input, lit), Contains("PCJ"));
  input = tnt(2);
  input.strength.values["PCJ"] = 2 * density * speed * speed;
  CHECK_THAT(refusal(input, lit), Contains("PCJ must be smaller"));
  input = tnt(2);
  input.eos.reset();
  input.strength.values.insert({{"Young", 1e3}, {"Poisson", 0.3}});
  CHECK_THAT(refusal(input, lit), Contains("add an EquationOfState"));
}

}  // namespace mpm::tests
