// Scatter of the failure thresholds (manual 3.2.4): the draws against their distributions, where they come
// from, and what they do to the criteria.

#include "physics/failure/threshold_scatter.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include <catch2/catch.hpp>

#include "core/grid/brick.hpp"
#include "physics/point/point_driver.hpp"
#include "tests/physics/samples.hpp"

namespace mpm::tests {

using core::Column;
using core::RandomFailureInput;
using physics::PathKind;
using physics::PointDriver;
using physics::ThresholdScatter;
using Distribution = RandomFailureInput::Distribution;
using Spread = RandomFailureInput::Spread;

namespace {

constexpr int draws = 20000;

std::vector<double> factors(const RandomFailureInput& input) {
  const ThresholdScatter scatter(input);
  std::vector<double> x(draws);
  for (int i = 0; i < draws; ++i)
    x[static_cast<std::size_t>(i)] = scatter.factor(static_cast<std::uint64_t>(i));
  return x;
}

/// Largest distance between the distribution of the sample and `cumulative`, times sqrt(n)
/// (Kolmogorov-Smirnov).
template <class F>
double distance(std::vector<double> x, F cumulative) {
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double p = cumulative(x[i]), rank = static_cast<double>(i);
    largest = std::max({largest, p - rank / n, (rank + 1) / n - p});
  }
  return std::sqrt(n) * largest;
}
/// Exceeded by one sample in a hundred: 2 exp(-2 x^2) = 0.01. The draws are fixed, so the test never wavers.
const double one_percent = std::sqrt(-0.5 * std::log(0.005));

RandomFailureInput gauss(double mean = 1, double deviation = 0.2) {
  RandomFailureInput input;
  input.enable = true;
  input.distribution = Distribution::gauss;
  input.gauss_mean = mean;
  input.gauss_deviation = deviation;
  return input;
}
RandomFailureInput weibull() {
  RandomFailureInput input = gauss();
  input.distribution = Distribution::weibull;
  return input;
}

core::MaterialInput brittle(const RandomFailureInput& random, double pmin = -500e6) {
  core::MaterialInput input = copper("IsoElastic");
  input.failures.push_back({{"Pmin", {{"pmin", pmin}}, {}}, false});
  input.random_failure = random;
  return input;
}

/// Particles with places and identities, initialised by the material as at the start of a run.
struct Particles {
  Particles(const physics::Material& material, const std::vector<core::Vec3<double>>& x,
            const std::vector<double>& identity, const core::GridGeometry* grid) {
    core::ColumnSet set = core::ColumnSet::mechanics();
    set.add(material.columns({}));
    const core::ColumnLayout layout(set);
    const auto blocks = static_cast<int>((x.size() + 7) / 8);
    std::vector<double> memory(static_cast<std::size_t>(blocks * layout.block_doubles()), 0.0);
    for (int first = 0; first < blocks; first += core::batch_blocks) {
      core::Batch batch{};
      batch.layout = &layout;
      batch.blocks = std::min(core::batch_blocks, blocks - first);
      batch.particles = std::min(core::batch_particles, static_cast<int>(x.size()) - 8 * first);
      batch.grid = grid;
      for (int b = 0; b < batch.blocks; ++b)
        batch.block[b] = memory.data() + (first + b) * layout.block_doubles();
      const auto at = [&](Column c, int i) -> double& { return batch.column(c, i / 8)[i % 8]; };
      for (int i = 0; i < 8 * batch.blocks; ++i) {
        at(Column::mass, i) = material.reference_density(), at(Column::volume, i) = 1;
        const auto k = static_cast<std::size_t>(8 * first + i);
        if (k >= x.size()) continue;
        for (int a = 0; a < 3; ++a) at(core::next(Column::position_x, a), i) = x[k][a];
        at(Column::identity, i) = identity[k];
      }
      material.initialise(batch, {});
      for (int i = 0; i < batch.particles; ++i) factor.push_back(at(Column::threshold_factor, i));
    }
  }
  std::vector<double> factor;
};

}  // namespace

TEST_CASE("Gaussian factors have their distribution, mean and deviation", "[physics][random]") {
  for (const std::pair<double, double>& law : {std::pair{1.0, 0.2}, {3.0, 0.05}}) {
    const double mean = law.first, deviation = law.second;
    const std::vector<double> x = factors(gauss(mean, deviation));
    CHECK(distance(x, [&](double v) { return 0.5 * std::erfc((mean - v) / (std::sqrt(2.0) * deviation)); }) <
          one_percent);
    double sum = 0, squares = 0;
    for (const double v : x) sum += v;
    for (const double v : x) squares += std::pow(v - sum / draws, 2);
    // Three standard errors.
    CHECK(sum / draws == Approx(mean).margin(3 * deviation / std::sqrt(draws)));
    CHECK(std::sqrt(squares / draws) == Approx(deviation).epsilon(3 / std::sqrt(2.0 * draws)));
  }
  // What would be a negative threshold is none.
  const std::vector<double> wide = factors(gauss(1, 1));
  CHECK(*std::min_element(wide.begin(), wide.end()) == 0);
  const auto zeros = std::count(wide.begin(), wide.end(), 0.0);
  const double expected = 0.5 * std::erfc(1 / std::sqrt(2.0));
  CHECK(static_cast<double>(zeros) / draws ==
        Approx(expected).margin(3 * std::sqrt(expected * (1 - expected) / draws)));
}

TEST_CASE("Weibull factors have their distribution, scale and modulus", "[physics][random]") {
  RandomFailureInput input = weibull();
  for (int k = 0; k < 2; ++k) {
    const double m = input.weibull_modulus, scale = input.weibull_median;
    const double volumes = input.weibull_particle_volume / input.weibull_reference_volume;
    const std::vector<double> x = factors(input);
    CHECK(distance(x, [&](double v) { return 1 - std::exp(-volumes * std::pow(v / scale, m)); }) <
          one_percent);
    // ln x = ln(scale volumes^(-1/m)) + ln(-ln u)/m, where ln(-ln u) has the mean -0.57722 (Euler) and the
    // deviation pi/sqrt(6). Three standard errors; the deviation's, by the fourth moment 5.4 sigma^4.
    double sum = 0, squares = 0;
    for (const double v : x) sum += std::log(v);
    for (const double v : x) squares += std::pow(std::log(v) - sum / draws, 2);
    const double deviation = std::acos(-1.0) / std::sqrt(6.0);
    const double modulus = deviation / std::sqrt(squares / draws);
    CHECK(modulus == Approx(m).epsilon(3 * std::sqrt(4.4 / 4 / draws)));
    CHECK(sum / draws + 0.5772156649 / m + std::log(volumes) / m ==
          Approx(std::log(scale)).margin(3 * deviation / m / std::sqrt(draws)));
    input.weibull_modulus = 3;
    input.weibull_median = 0.7;
    input.weibull_particle_volume = 2;
    input.weibull_reference_volume = 5;
  }
}

TEST_CASE("a constant distribution changes nothing and costs nothing", "[physics][random]") {
  RandomFailureInput input;
  input.enable = true;
  CHECK(factors(input) == std::vector<double>(draws, 1.0));
  CHECK_FALSE(make(brittle(input))->columns({}).has(Column::threshold_factor));
  CHECK_FALSE(make(brittle({}))->columns({}).has(Column::threshold_factor));
  CHECK(make(brittle(gauss()))->columns({}).has(Column::threshold_factor));
  core::MaterialInput nothing_fails = brittle(gauss());
  nothing_fails.failures.clear();
  CHECK_FALSE(make(nothing_fails)->columns({}).has(Column::threshold_factor));
}

TEST_CASE("a particle's factor follows from its identity alone", "[physics][random]") {
  const auto material = make(brittle(gauss()));
  const int n = 150;
  std::vector<double> identity(n);
  std::vector<core::Vec3<double>> x(n);
  for (std::size_t i = 0; i < n; ++i) identity[i] = static_cast<double>(1000000007 * i % 9007199254740992);
  const std::vector<double> factor = Particles(*material, x, identity, nullptr).factor;
  CHECK(std::set<double>(factor.begin(), factor.end()).size() == n);
  std::vector<std::size_t> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  std::vector<double> shuffled;
  for (const std::size_t i : order) shuffled.push_back(identity[i]);
  shuffled.resize(70);  // as if another rank had the rest
  const std::vector<double> again =
      Particles(*material, std::vector<core::Vec3<double>>(70, {7, 8, 9}), shuffled, nullptr).factor;
  for (std::size_t i = 0; i < again.size(); ++i) CHECK(again[i] == factor[order[i]]);
}

TEST_CASE("factors per cell are those of the background cell at the start", "[physics][random]") {
  RandomFailureInput input = weibull();
  input.spread = Spread::cell;
  const auto material = make(brittle(input));
  core::GridGeometry grid;
  grid.origin = {-1, 2, 0};
  grid.cell = {0.5, 0.25, 0.1};
  grid.inverse_cell = {2, 4, 10};
  grid.cells = {40, 30, 20};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<core::Vec3<double>> x;
  std::vector<double> identity;
  for (int i = 0; i < 600; ++i) {
    x.push_back({-1 + 0.5 * 4 * unit(random), 2 + 0.25 * 4 * unit(random), 0.1 * 4 * unit(random)});
    identity.push_back(i);
  }
  const std::vector<double> factor = Particles(*material, x, identity, &grid).factor;
  std::set<double> distinct;
  std::set<std::int64_t> cells;
  std::vector<std::int64_t> cell;
  for (std::size_t i = 0; i < x.size(); ++i) {
    std::int64_t key = 0;
    for (int a = 0; a < 3; ++a) key = 1000 * key + grid.cell_index(x[i][a], a);
    cell.push_back(key), cells.insert(key), distinct.insert(factor[i]);
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) REQUIRE((cell[i] == cell[j]) == (factor[i] == factor[j]));
  }
  CHECK(distinct.size() == cells.size());
  CHECK(cells.size() == 64);
}

TEST_CASE("every threshold of a particle is multiplied by its factor", "[physics][random]") {
  const core::FailureInput failures[] = {
      {{"PlaStrain", {{"epmax", 0.01}}, {}}, false},
      {{"Pmin", {{"pmin", -900e6}}, {}}, false},
      {{"PriStress", {{"PriStressMax", 1e9}, {"PriStressMin", 0.0}, {"ShearStressMax", 0.0}}, {}}, false},
      {{"PriStress", {{"PriStressMax", 0.0}, {"PriStressMin", 0.0}, {"ShearStressMax", 100e6}}, {}}, false},
      {{"PriStrain", {{"PriStrainMax", 0.01}, {"PriStrainMin", 0.0}, {"ShearStrainMax", 0.0}}, {}}, false},
      {{"PriStrain", {{"PriStrainMax", 0.0}, {"PriStrainMin", 0.0}, {"ShearStrainMax", 0.01}}, {}}, false},
      {{"InstGeoStrain", {{"ErosionStrain", 0.008}}, {}}, false},
  };
  const auto failing_strain = [](const core::MaterialInput& input, double factor) {
    const auto material = make(input);
    PointDriver point(*material, {});
    if (point.has(Column::threshold_factor)) point.set(Column::threshold_factor, factor);
    double at = HUGE_VAL;
    drive(point, {.kind = PathKind::uniaxial_strain, .targets = {0.04}, .steps = 400}, [&](double strain) {
      if (point.value(Column::failed) > 0) at = std::min(at, strain);
    });
    return at;
  };
  for (const core::FailureInput& failure : failures) {
    INFO(failure.type);
    for (const double factor : {0.6, 1.3, 0.0}) {
      core::MaterialInput scattered = copper("IsoHarden"), scaled = copper("IsoHarden");
      scattered.failures = {failure};
      scattered.random_failure = gauss();
      scaled.failures = {failure};
      for (auto& [name, value] : scaled.failures.front().values) value *= factor == 0 ? 1e-9 : factor;
      const double at = failing_strain(scattered, factor);
      CHECK(at < 0.04);
      CHECK(at == failing_strain(scaled, 1));
    }
  }
}

TEST_CASE("a population fails by its distribution", "[physics][random]") {
  // Stretched to the pressure p, the share P(p/pmin) of the particles must have failed.
  RandomFailureInput input = weibull();
  const auto material = make(brittle(input));
  const int n = 2000;
  std::vector<double> identity;
  for (int i = 0; i < n; ++i) identity.push_back(i);
  const std::vector<double> factor =
      Particles(*material, std::vector<core::Vec3<double>>(n), identity, nullptr).factor;
  for (const double ratio : {0.75, 0.85, 0.9}) {
    int failed = 0;
    for (const double f : factor) {
      PointDriver point(*material, {});
      point.set(Column::threshold_factor, f);
      const double e = ratio * 500e6 / (124e9 / (3 * (1 - 2 * 0.34)));
      point.step({e / 3, 0, 0, 0, e / 3, 0, 0, 0, e / 3}, 1);
      failed += point.value(Column::failed) > 0;
    }
    const double share = 1 - std::exp(-1000 * std::pow(ratio / 1.2549, 20.270));
    CHECK(static_cast<double>(failed) / n == Approx(share).margin(3 * std::sqrt(share * (1 - share) / n)));
  }
}

TEST_CASE("the damage threshold scatters only with DamageRandom, and stays within one", "[physics][random]") {
  core::MaterialInput input = copper("JohnsonCook damaged");
  input.random_failure = gauss();
  const auto failing_damage = [&](double factor) {
    const auto material = make(input);
    PointDriver point(*material, {});
    point.set(Column::threshold_factor, factor);
    double last = 0;
    drive(point, {.kind = PathKind::uniaxial_stress, .rate = 1e3, .targets = {3.0}, .steps = 6000},
          [&](double) {
            if (point.value(Column::failed) == 0) last = point.value(Column::damage);
          });
    CHECK(point.value(Column::failed) == 1);
    return last;
  };
  CHECK(failing_damage(0.5) == Approx(1).margin(2e-3));
  input.random_failure.random_damage = true;
  CHECK(failing_damage(0.5) == Approx(0.5).margin(2e-3));
  CHECK(failing_damage(1.4) == Approx(1).margin(2e-3));
  CHECK(failing_damage(0.0) == Approx(0).margin(2e-3));
}

TEST_CASE("particles join the failed component at FailureDamageThreshold", "[physics][failure]") {
  core::MaterialInput input = copper("JohnsonCook damaged");
  input.strength.values["FailureDamageThreshold"] = 0.4;
  const auto check = [&](const core::FailedComponentRule& rule, PointDriver& point, double from) {
    core::ColumnSet set = core::ColumnSet::mechanics();
    set.add({Column::damage, Column::failed, Column::threshold_factor});
    const core::ColumnLayout layout(set);
    std::vector<double> block(static_cast<std::size_t>(layout.block_doubles()));
    int joined = 0, failed = 0, steps = 0;
    drive(point, {.kind = PathKind::uniaxial_stress, .rate = 1e3, .targets = {3.0}, .steps = 3000},
          [&](double) {
            for (const Column c : {Column::damage, Column::failed, Column::threshold_factor}) {
              if (point.has(c)) std::fill_n(block.begin() + layout.offset(c), 8, point.value(c));
            }
            const auto holds = rule.holds<core::Real>(layout, block.data());
            std::vector<double> row;
            for (int c = 0; c < layout.columns(); ++c) row.push_back(block[static_cast<std::size_t>(8 * c)]);
            CHECK(core::all(holds) == rule.holds_for(layout, row.data()));
            for (int i = 0; i < core::real_width; ++i)
              CHECK(core::test(holds, i) == rule.holds<double>(layout, block.data()));
            const double damage = point.value(Column::damage);
            CHECK(core::all(holds) == (damage > 0 && damage >= from));
            joined += core::any(holds), failed += point.value(Column::failed) > 0, ++steps;
          });
    // Joined before it fails: between the two it has strength.
    CHECK(joined > failed);
    CHECK(failed > 0);
    CHECK(joined < steps);
  };
  {
    const auto material = make(input);
    PointDriver point(*material, {});
    check(material->failed_component_rule(), point, 0.4);
  }
  input.strength.values["FailureDamageThreshold"] = 0.0;
  {
    const auto material = make(input);
    PointDriver point(*material, {});
    check(material->failed_component_rule(), point, 0.0);
  }
  input.strength.values["FailureDamageThreshold"] = 0.4;
  input.random_failure = gauss();
  input.random_failure.random_damage = true;
  {
    const auto material = make(input);
    PointDriver point(*material, {});
    point.set(Column::threshold_factor, 1.5);
    check(material->failed_component_rule(), point, 0.6);
  }
}

}  // namespace mpm::tests
