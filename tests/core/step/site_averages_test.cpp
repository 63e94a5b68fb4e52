// Averages of volume changes over sites: what they leave alone, and what they make equal. The oracle tests
// compare whole runs.
#include "core/step/site_averages.hpp"

#include <random>
#include <set>

#include <catch2/catch.hpp>

#include "tests/core/step/case.hpp"

using namespace mpm::tests;
using mpm::core::Batch;
using mpm::core::block_lanes;
using mpm::core::SiteAverages;

namespace {

/// A block whose particles are in sites 3, 5 and 6, the last two out of use.
struct SomeBlock {
  int sites[block_lanes] = {3, 5, 3, 6, 6, 3, 0, 40};
  double volume[block_lanes] = {1, 2, 0.5, 4, 1.5, 3, -1, -1};
  Batch batch;
  static constexpr int used = 6;

  template <class F>
  void fill(F gradient) {
    for (int i = 0; i < 9; ++i)
      for (int l = 0; l < block_lanes; ++l) batch.gradient[i][l] = gradient(i, l);
  }
  void average() {
    SiteAverages averages;
    averages.resize(125);
    averages.clear();
    averages.add_volume_changes(sites, volume, batch.gradient, 0, used);
    averages.average_gradients(sites, batch.gradient, 0);
  }
  double trace(int l) const { return batch.gradient[0][l] + batch.gradient[4][l] + batch.gradient[8][l]; }
};

}  // namespace

TEST_CASE("Averages leave a uniform strain and a rotation as they are") {
  SomeBlock some;
  const double strain[9] = {0.3, -0.7, 0.11, 0.2, -0.1, 0.4, 0.05, 0.6, 0.9};
  some.fill([&](int i, int) { return strain[i]; });
  some.average();
  for (int i = 0; i < 9; ++i)
    for (int l = 0; l < some.used; ++l) CHECK(std::abs(some.batch.gradient[i][l] - strain[i]) < 1e-15);

  const double rotation[9] = {0, -0.7, 0.11, 0.7, 0, 0.4, -0.11, -0.4, 0};
  some.fill([&](int i, int l) { return rotation[i] * (1 + l); });
  some.average();
  for (int i = 0; i < 9; ++i)
    for (int l = 0; l < some.used; ++l) CHECK(some.batch.gradient[i][l] == rotation[i] * (1 + l));
}

TEST_CASE("Averages make volume changes of a site equal, keep their sum and the distortion") {
  SomeBlock some;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> between(-1, 1);
  some.fill([&](int, int) { return between(random); });
  const SomeBlock before = some;
  some.average();
  double sum_before = 0, sum = 0;
  for (int l = 0; l < some.used; ++l) {
    sum_before += before.volume[l] * before.trace(l);
    sum += some.volume[l] * some.trace(l);
    for (int k = 0; k < l; ++k) {
      const bool same = std::abs(some.trace(l) - some.trace(k)) < 1e-14;
      CHECK(same == (some.sites[l] == some.sites[k]));
    }
    for (const int i : {1, 2, 3, 5, 6, 7}) CHECK(some.batch.gradient[i][l] == before.batch.gradient[i][l]);
    const auto difference = [&](const SomeBlock& s) {
      return s.batch.gradient[0][l] - s.batch.gradient[8][l];
    };
    CHECK(std::abs(difference(some) - difference(before)) < 1e-14);
  }
  CHECK(std::abs(sum - sum_before) < 1e-13);
  for (int l = some.used; l < block_lanes; ++l) CHECK(std::isfinite(some.trace(l)));
}

TEST_CASE("Relaxation lets pressures of a site approach their mean, and keeps the site's volume") {
  using mpm::core::Column;
  const mpm::core::ColumnLayout layout(mpm::core::ColumnSet::mechanics());
  std::vector<double> block(static_cast<std::size_t>(layout.block_doubles()));
  SomeBlock some;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> between(-1, 1);
  double* const pressure = block.data() + layout.offset(Column::pressure);
  std::copy_n(some.volume, block_lanes, block.data() + layout.offset(Column::volume));
  for (int l = 0; l < block_lanes; ++l) pressure[l] = between(random);
  some.fill([&](int, int) { return between(random); });
  const SomeBlock before = some;
  SiteAverages averages;
  averages.resize(125);
  averages.clear();
  averages.add_volume_changes(some.sites, some.volume, some.batch.gradient, 0, some.used);
  averages.add_old_pressures(some.sites, layout, block.data(), some.used);
  constexpr double rate = 0.4, modulus = 1e3, dt = 0.5;
  averages.relax_pressures(some.sites, layout, block.data(), rate, modulus, some.batch.gradient, 0);
  for (const int site : {3, 5, 6}) {
    double volume = 0, mean = 0, growth = 0;
    for (int l = 0; l < some.used; ++l) {
      if (some.sites[l] != site) continue;
      volume += some.volume[l];
      mean += some.volume[l] * pressure[l];
      growth += some.volume[l] * (some.trace(l) - before.trace(l));
    }
    mean /= volume;
    CHECK(std::abs(growth) < 1e-15 * volume);
    for (int l = 0; l < some.used; ++l) {
      if (some.sites[l] != site) continue;
      // p <- p - K dV/V: the share rate dt of the difference goes where K is the modulus.
      const double after = pressure[l] - modulus * dt * (some.trace(l) - before.trace(l));
      CHECK(std::abs((after - mean) - (1 - rate * dt) * (pressure[l] - mean)) < 2e-3);
    }
  }
  for (const int i : {1, 2, 3, 5, 6, 7})
    for (int l = 0; l < block_lanes; ++l) CHECK(some.batch.gradient[i][l] == before.batch.gradient[i][l]);
}

TEST_CASE("Mean pressures do the work that particles with mean volume changes store") {
  using mpm::core::Column;
  const mpm::core::ColumnLayout layout(mpm::core::ColumnSet::mechanics());
  std::vector<double> block(static_cast<std::size_t>(layout.block_doubles()));
  SomeBlock some;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> between(-1, 1);
  some.fill([&](int, int) { return between(random); });
  const SomeBlock before = some;
  some.average();
  mpm::core::MappedRows rows;
  const auto column = [&](Column c) { return block.data() + layout.offset(c); };
  std::copy_n(some.volume, block_lanes, column(Column::volume));
  for (int l = 0; l < block_lanes; ++l) {
    column(Column::pressure)[l] = between(random);
    column(Column::viscous_pressure)[l] = between(random);
    for (int i = 0; i < 6; ++i)
      rows.stress[i][l] =
          i < 3 ? -some.volume[l] * (column(Column::pressure)[l] + column(Column::viscous_pressure)[l])
                : 0.5 + i;
  }
  SiteAverages averages;
  averages.resize(125);
  averages.clear();
  averages.add_pressures(some.sites, layout, block.data(), some.used);
  averages.average_pressures(some.sites, layout, block.data(), rows);
  double work = 0, stored = 0;
  for (int l = 0; l < some.used; ++l) {
    work += rows.stress[0][l] * before.trace(l);
    stored -=
        some.volume[l] * (column(Column::pressure)[l] + column(Column::viscous_pressure)[l]) * some.trace(l);
    CHECK(rows.stress[0][l] == rows.stress[2][l]);
    for (int i = 3; i < 6; ++i) CHECK(rows.stress[i][l] == 0.5 + i);
    for (int k = 0; k < l; ++k) {
      const double difference = rows.stress[0][l] / some.volume[l] - rows.stress[0][k] / some.volume[k];
      CHECK((std::abs(difference) < 1e-14) == (some.sites[l] == some.sites[k]));
    }
  }
  CHECK(std::abs(work - stored) < 1e-13);
}

TEST_CASE("In a step the particles of a body in a site change their volume alike") {
  for (const ReferenceShape shape : reference_shapes) {
    for (const ReferenceScheme scheme :
         {ReferenceScheme::usf, ReferenceScheme::usl, ReferenceScheme::musl, ReferenceScheme::usavg}) {
      INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme));
      ReferenceCase c = tumbling_block();
      c.shape = shape;
      c.scheme = scheme;
      constexpr std::size_t half = 360;
      const auto run = [&](bool averages) {
        c.average = averages;
        auto r = std::make_unique<SmallRun>(c, half);
        r->step();
        return r;
      };
      const auto own = run(false), averaged = run(true);
      const mpm::core::GridGeometry& g = averaged->model.grid->geometry();
      std::map<std::tuple<bool, std::int64_t, std::int64_t, std::int64_t>, std::set<double>> changes;
      double sum_own = 0, sum = 0;
      const auto all = own->particles();
      for (const auto& [identity, p] : averaged->particles()) {
        const ReferenceParticle& first = c.particles[static_cast<std::size_t>(identity)];
        sum += p.V - first.V;
        sum_own += all.at(identity).V - first.V;
        changes[{identity < static_cast<std::int64_t>(half), g.site_index(first.x[0], 0),
                 g.site_index(first.x[1], 1), g.site_index(first.x[2], 2)}]
            .insert(p.V / first.V);
      }
      CHECK(std::abs(sum - sum_own) < 1e-12 * static_cast<double>(c.particles.size()));
      CHECK(changes.size() > 20);
      for (const auto& [site, of_site] : changes) CHECK(*of_site.rbegin() - *of_site.begin() < 1e-14);
    }
  }
}
