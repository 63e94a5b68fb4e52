// Whole steps: what must hold of any run, to the last bit or to round-off.
#include "core/step/stepper.hpp"

#include <numbers>

#include <catch2/catch.hpp>
#include <omp.h>

#include "core/step/finite.hpp"
#include "core/step/totals.hpp"
#include "tests/core/step/case.hpp"

using namespace mpm::tests;
using namespace mpm::core;

namespace {

constexpr ReferenceScheme schemes[] = {ReferenceScheme::usf, ReferenceScheme::usl, ReferenceScheme::musl,
                                       ReferenceScheme::usavg};

struct Threads {
  explicit Threads(int n) : before(omp_get_max_threads()) { omp_set_num_threads(n); }
  ~Threads() { omp_set_num_threads(before); }
  int before;
};

ReferenceCase tumbling(ReferenceScheme scheme) {
  ReferenceCase c = tumbling_block();
  c.scheme = scheme;
  return c;
}

constexpr std::size_t half = 360;  // of the block's particles: two bodies

/// A run that goes on with the particles of another, as a restart file keeps them: in the order of their
/// tiles.
std::unique_ptr<SmallRun> continued(const SmallRun& from, ReferenceCase c) {
  c.particles.resize(half + 1);  // two bodies
  auto to = std::make_unique<SmallRun>(c, half);
  std::vector<BrickCount> counts;
  for (const Brick& brick : from.model.grid->bricks()) {
    if (brick.particles() > 0) counts.push_back({brick.coord, 1});
  }
  for (Body& body : to->model.bodies) body.pool = std::make_shared<BlockPool>(body.pool->layout());
  for (Brick& brick : to->model.grid->bricks()) brick.tiles.clear();
  to->solo.bricks.partition(*to->model.grid, counts, {});
  std::vector<double> columns(column_count);
  for (const Brick& brick : from.model.grid->bricks()) {
    for (const ParticleTile& tile : brick.tiles) {
      ParticleTile& copy = to->model.grid->brick(to->model.grid->find(brick.coord)).tiles.emplace_back();
      copy.body = tile.body;
      copy.component = tile.component;
      const auto body = static_cast<std::size_t>(tile.body);
      for (std::uint32_t i = 0; i < tile.count; ++i) {
        extract(*from.model.bodies[body].pool, tile, i, columns.data());
        append(*to->model.bodies[body].pool, copy, columns.data());
      }
    }
  }
  to->model.clock = from.model.clock;
  return to;
}

}  // namespace

TEST_CASE("Any number of threads gives the same bits, in the same order") {
  for (const ReferenceScheme scheme : schemes) {
    INFO("scheme " << static_cast<int>(scheme));
    const auto run = [&](int threads) {
      const Threads some(threads);
      auto r = std::make_unique<SmallRun>(tumbling(scheme), half);
      r->step(45);
      return r;
    };
    const auto one = run(1), two = run(2), three = run(3);
    CHECK(one->columns() == two->columns());
    CHECK(one->columns() == three->columns());
    CHECK(one->order() == two->order());
    CHECK(one->model.clock.time == three->model.clock.time);
  }
}

TEST_CASE("A run that goes on from a copy of its particles gives the same bits, from any step") {
  for (const ReferenceScheme scheme : schemes) {
    SmallRun whole(tumbling(scheme), half);
    std::vector<std::unique_ptr<SmallRun>> restarted;
    for (int step = 1; step <= 45; ++step) {
      whole.step();
      // Before, at and after the step that sorts particles and forgets empty bricks.
      if (step == 7 || step == 19 || step == 20 || step == 21 || step == 33)
        restarted.push_back(continued(whole, tumbling(scheme)));
    }
    for (const auto& r : restarted) {
      INFO("scheme " << static_cast<int>(scheme) << ", from step " << r->model.clock.step);
      r->step(45 - static_cast<int>(r->model.clock.step));
      CHECK(r->columns() == whole.columns());
      CHECK(r->order() == whole.order());
      CHECK(r->model.clock.time == whole.model.clock.time);
    }
  }
}

TEST_CASE("What is in lanes out of use changes nothing") {
  for (const ReferenceScheme scheme : schemes) {
    SmallRun clean(tumbling(scheme), half), poisoned(tumbling(scheme), half);
    for (int step = 0; step < 25; ++step) {
      for (const ParticleBlock& block : blocks_of(poisoned.model)) {
        for (int lane = block.used; lane < block_lanes; ++lane)
          for (int c = 0; c < block.layout->columns(); ++c) block.particle(lane).nth(c) = std::nan("");
      }
      clean.step();
      poisoned.step();
    }
    CHECK(clean.columns() == poisoned.columns());
  }
}

TEST_CASE("Without walls and gravity momentum stays what it was, to round-off") {
  for (const ReferenceScheme scheme : schemes) {
    SmallRun run(tumbling(scheme), half);
    const Totals before = compute_totals(run.model, run.solo);
    const double size =
        std::sqrt(2 * before.kinetic * before.mass);  // what the momenta add up to, signs apart
    run.step(40);
    const Totals after = compute_totals(run.model, run.solo);
    CHECK(after.particles == 720);
    CHECK(after.mass == before.mass);
    for (int a = 0; a < 3; ++a) CHECK(std::abs(after.momentum[a] - before.momentum[a]) < 1e-14 * size);
  }
}

TEST_CASE("Kinetic and internal energy of one instant add up to what they were") {
  // MUSL with any steps, USAVG with equal ones; USF with equal ones, and to first order of the step. USL
  // dissipates by itself. USAVG's energies are of one instant already, to first order.
  for (const ReferenceScheme scheme : {ReferenceScheme::musl, ReferenceScheme::usavg, ReferenceScheme::usf}) {
    INFO("scheme " << static_cast<int>(scheme));
    const bool musl = scheme == ReferenceScheme::musl, averages = scheme == ReferenceScheme::usavg;
    ReferenceCase c = open_space(ReferenceShape::quadratic_bspline, scheme);
    for (int n = 0; n < 12 * 8 * 8; ++n) {
      ReferenceParticle p;
      const int i = n % 12, j = n / 12 % 8, k = n / 96;
      p.x = {9.25 + 0.5 * i, 4.25 + 0.5 * j, 4.25 + 0.5 * k};
      p.v = {0.1 * std::cos(std::numbers::pi * (i + 0.5) / 12), 0, 0};
      p.V = 0.125;
      p.m = c.material.density * p.V;
      c.particles.push_back(p);
    }
    SmallRun run(c);
    double apart = 0, together = 0;
    const double start = compute_totals(run.model, run.solo).kinetic;
    for (int step = 0; step < 60; ++step) {
      run.scene->solution.time_step.specified = musl && step % 3 == 2 ? 0.004 : 0.016;  // 0.4 of h/c at most
      run.step();
      const Totals now = compute_totals(run.model, run.solo);
      apart = std::max(apart, std::abs(now.kinetic + now.internal - start));
      together = std::max(together, std::abs(energy_balance(now, start).relative_drift * start));
    }
    CHECK((averages ? apart < 0.02 * start : apart > 0.05 * start));
    CHECK(together < (musl ? 0.1 : averages ? 0.2 : 0.5) * apart);
  }
}

TEST_CASE("A stress-free body in uniform motion flies on as it is, across bricks") {
  for (const ReferenceScheme scheme : schemes) {
    ReferenceCase c = tumbling(scheme);
    const Vector v{6, -5, 4};
    for (ReferenceParticle& p : c.particles) p.v = v;
    SmallRun run(c);
    while (run.model.clock.time * v[0] < 1.6) run.step();  // cells
    const double t = run.model.clock.time;
    double worst_x = 0, worst_v = 0, worst_stress = 0;
    for (const auto& [identity, p] : run.particles()) {
      for (std::size_t a = 0; a < 3; ++a) {
        worst_x = std::max(
            worst_x, std::abs(p.x[a] - c.particles[static_cast<std::size_t>(identity)].x[a] - t * v[a]));
        worst_v = std::max(worst_v, std::abs(p.v[a] - v[a]));
        for (std::size_t b = 0; b < 3; ++b)
          worst_stress = std::max(worst_stress, std::abs(p.s[a][b]) + std::abs(p.p));
      }
    }
    // Nodal velocities are p/m, rounded at 1e-16 of 6; 40 to 80 steps of that.
    CHECK(worst_x < 1e-13);
    CHECK(worst_v < 1e-13);
    CHECK(worst_stress < 1e-12 * c.material.young);
  }
}

TEST_CASE("A body in free fall falls, unstrained in any scheme") {
  for (const ReferenceScheme scheme : schemes) {
    ReferenceCase c = tumbling(scheme);
    for (ReferenceParticle& p : c.particles) p.v = {};
    c.gravity = {3, -4, 5};
    SmallRun run(c);
    run.step(40);
    const double t = run.model.clock.time + run.model.clock.first_lag - run.model.clock.lag;
    double worst_v = 0, worst_stress = 0;
    for (const auto& [identity, p] : run.particles()) {
      for (std::size_t a = 0; a < 3; ++a) worst_v = std::max(worst_v, std::abs(p.v[a] - t * c.gravity[a]));
      worst_stress = std::max(worst_stress, std::abs(p.p) + std::abs(p.s[0][1]));
    }
    CHECK(worst_v < 1e-13);
    CHECK(worst_stress < 1e-12 * c.material.young);
    const Totals totals = compute_totals(run.model, run.solo);
    CHECK(totals.external_work == Approx(totals.kinetic).epsilon(1e-12));
  }
}

TEST_CASE("A symmetric problem stays symmetric") {
  // Sums run in one direction, so mirror images differ by round-off; yielding amplifies that, but not to
  // 1e-10.
  for (const ReferenceScheme scheme : schemes) {
    ReferenceCase c = taylor_bar(1.27);
    c.scheme = scheme;
    SmallRun run(c);
    run.step(60);
    std::map<std::tuple<long, long, long>, Vector> at;  // by initial place, in hundredths
    const auto key = [](double x, double y, double z) {
      return std::tuple{std::lround(100 * x), std::lround(100 * y), std::lround(100 * z)};
    };
    for (const auto& [identity, p] : run.particles()) {
      const Vector& x = c.particles[static_cast<std::size_t>(identity)].x;
      at[key(x[0], x[1], x[2])] = p.x;
    }
    double worst = 0;
    for (const auto& [place, x] : at) {
      const auto [i, j, k] = place;
      const Vector mirror_x = at.at({-i, j, k}), mirror_y = at.at({i, -j, k}), turned = at.at({j, i, k});
      worst = std::max({worst, std::abs(mirror_x[0] + x[0]), std::abs(mirror_x[1] - x[1]),
                        std::abs(mirror_x[2] - x[2]), std::abs(mirror_y[0] - x[0]),
                        std::abs(mirror_y[1] + x[1]), std::abs(turned[0] - x[1])});
    }
    CHECK(worst < 1e-10 * c.cell[0]);
  }
}

TEST_CASE(
    "Velocities are advanced by the mean of two steps, at the end to the impulses of the time of the run") {
  const StepLength equal = step_length(2, 1, 1, false), shorter = step_length(1, 1, 1, false);
  CHECK(equal.velocity_dt == 2);
  CHECK(equal.load_part == 0.5);
  CHECK(shorter.velocity_dt == 1.5);
  CHECK(shorter.lag == 0.5);
  CHECK(shorter.load_part == 0.75);
  const StepLength last = step_length(0.5, 0.75, 0.875, true), tiny = step_length(0.0625, 0.25, 1, true);
  CHECK(last.lag == 0.875);
  CHECK(last.velocity_dt == 0.375);
  CHECK(tiny.velocity_dt == 0.0625 / 64);  // not zero
}

TEST_CASE("The last step ends on time") {
  SmallRun run(tumbling(ReferenceScheme::musl));
  run.scene->solution.time_step.specified = 0.01;
  run.scene->solution.end_time = 0.035;
  run.step(3);
  CHECK(run.model.clock.dt == 0.01);
  run.step();
  CHECK(run.model.clock.dt == Approx(0.005).epsilon(1e-13));
  CHECK(run.model.clock.time == Approx(0.035).epsilon(1e-15));
  CHECK(run.model.clock.step == 4);
}

TEST_CASE("A run that cannot go on says which particle is to blame") {
  const auto failure = [](auto change) {
    SmallRun run(tumbling(ReferenceScheme::musl), half);
    for (const ParticleBlock& block : blocks_of(run.model)) {
      for (int i = 0; i < block.used; ++i)
        if (block.particle(i)[Column::identity] == 17) change(*block.layout, block.data + i);
    }
    try {
      run.step();
    } catch (const NumericalFailure& f) { return std::string(f.what()); }
    return std::string();
  };
  using Catch::Contains;
  const double nan = std::nan("");
  CHECK_THAT(failure([&](const ColumnLayout& l, double* lane) { lane[l.offset(Column::position_y)] = nan; }),
             Contains("step 1") && Contains("particle ") && Contains("not finite"));
  CHECK_THAT(
      failure([&](const ColumnLayout& l, double* lane) { lane[l.offset(Column::internal_energy)] = nan; }),
      Contains("particle 17 of body \"body\"") && Contains("internal_energy=nan"));
}

TEST_CASE("Particles beyond a free face and those below the volume of erosion are gone, and in the ledger") {
  ReferenceCase c = tumbling(ReferenceScheme::musl);
  for (ReferenceParticle& p : c.particles) {
    p.x[0] += 5.9;  // the farthest are 0.35 from the face
    p.v = {6, 0, 0};
  }
  c.particles[0].V *= 1e-3;
  c.particles[400].V *= 1e-3;
  SmallRun run(c, half);
  run.scene->solution.volume.erode = c.particles[1].V / 2;
  run.scene->solution.time_step.specified = 0.01;
  const Totals before = compute_totals(run.model, run.solo);
  std::int64_t now_left = 0;
  for (int step = 0; step < 12; ++step) {
    run.step();
    now_left += run.stepper->incidents().left_grid;
  }
  const Totals after = compute_totals(run.model, run.solo);
  CHECK(after.eroded == 2);
  CHECK(after.bodies[0].eroded == 1);
  CHECK(after.bodies[1].eroded == 1);
  CHECK(after.left_grid == 72);  // the outermost layer, 9 x 8
  CHECK(now_left == 72);
  CHECK(after.particles == 720 - 74);
  CHECK(after.mass + after.removed_mass == Approx(before.mass).epsilon(1e-14));
  CHECK(after.kinetic + after.removed_kinetic + after.internal + after.removed_internal ==
        Approx(before.kinetic).epsilon(1e-12));
  const std::vector<std::int64_t> rest = run.order();
  CHECK(std::find(rest.begin(), rest.end(), 400) == rest.end());
}

TEST_CASE("A step that does not advance the time ends the run, before anything has moved") {
  for (const ReferenceScheme scheme : schemes) {
    for (const double critical : {0.0, 1e-12}) {
      SmallRun run(tumbling(scheme));
      run.step(3);
      const auto before = run.columns();
      run.model.clock.critical_dt = critical;
      if (critical > 0) run.model.clock.time = 1e5;
      CHECK_THROWS_WITH(run.step(),
                        Catch::Contains("step 4, time") &&
                            Catch::Contains("does not advance the time any more; the fastest: particle ") &&
                            Catch::Contains("of body \"body\" at ("));
      CHECK(run.columns() == before);
    }
  }
}

TEST_CASE("A critical step that collapses ends the run and names the fastest and the hottest particle") {
  SmallRun run(tumbling(ReferenceScheme::musl), half);
  run.step();
  for (const ParticleBlock& block : blocks_of(run.model)) {
    for (int i = 0; i < block.used; ++i)
      if (block.particle(i)[Column::identity] == 17)  // it changes bricks in the next step
        block.data[block.layout->offset(Column::internal_energy) + i] = 1e3;
  }
  run.model.clock.first_critical_dt = 1e9 * run.model.clock.critical_dt;
  CHECK_THROWS_WITH(run.step(), Catch::Contains("step 2, time") && Catch::Contains("has fallen to") &&
                                    Catch::Contains("; the fastest: particle ") &&
                                    Catch::Contains("; the hottest: particle 17 of body \"body\" at ("));
}

TEST_CASE("A state of numbers whose energy is none is told with its particle") {
  SmallRun run(tumbling(ReferenceScheme::musl));
  CHECK_NOTHROW(require_finite(run.model, run.solo));
  Brick& brick = run.model.grid->brick(0);
  BlockPool& pool = *run.model.bodies[0].pool;
  double* block = pool.block(brick.tiles[0].blocks[0]);
  block[pool.layout().offset(Column::velocity_y)] = 1e170;
  const auto identity = static_cast<long>(block[pool.layout().offset(Column::identity)]);
  CHECK_THROWS_WITH(require_finite(run.model, run.solo),
                    Catch::Contains("particle " + std::to_string(identity) + " of body") &&
                        Catch::Contains("velocity_y=1e+170"));
}

TEST_CASE("The ledger counts tangled and wide domains, in particles times steps") {
  for (const ReferenceScheme scheme : schemes) {
    ReferenceCase c = tumbling(scheme);
    const auto particles = static_cast<std::int64_t>(c.particles.size());
    c.shape = ReferenceShape::cpdi2;
    SmallRun tangled(c);
    BlockPool& pool = *tangled.model.bodies[0].pool;
    double* block = pool.block(tangled.model.grid->brick(0).tiles[0].blocks[0]);
    for (int a = 0; a < 3; ++a) block[pool.layout().offset(next(Column::corner_7x, a))] = 0;
    tangled.step(3);
    CHECK(tangled.model.ledger.tangled_domains == 1);
    CHECK(tangled.model.ledger.wide_domains == 0);
    c.gimp_half_size[1] = 1.1 * c.cell[1];
    for (const ReferenceShape shape : {ReferenceShape::cpgimp, ReferenceShape::cpdi, ReferenceShape::cpdi2}) {
      if (!has_passes(shape)) continue;
      c.shape = shape;
      SmallRun wide(c);
      wide.step(3);
      CHECK(wide.model.ledger.wide_domains == 3 * particles);
      CHECK(wide.model.ledger.tangled_domains == 0);
    }
  }
}

TEST_CASE("USAVG keeps the energy of particles that cross cells") {
  // A block vibrates while it drifts across cells, without viscosity: the gradients of linear functions jump
  // there.
  const auto drift = [](ReferenceScheme scheme) {
    ReferenceCase c = open_space(ReferenceShape::linear, scheme);
    c.dt_factor = 0.6;
    for (int n = 0; n < 8 * 8 * 8; ++n) {
      ReferenceParticle p;
      const int i = n % 8, j = n / 8 % 8, k = n / 64;
      p.x = {3.35 + 0.5 * i, 3.45 + 0.5 * j, 3.55 + 0.5 * k};
      p.v = {0.3 + 0.5 * std::cos(std::numbers::pi * (i + 0.5) / 8), 0.1, 0.1};
      p.V = 0.125;
      p.m = c.material.density * p.V;
      c.particles.push_back(p);
    }
    SmallRun run(c);
    const double start = compute_totals(run.model, run.solo).kinetic;
    run.step(700);
    return energy_balance(compute_totals(run.model, run.solo), start).relative_drift;
  };
  const double musl = std::abs(drift(ReferenceScheme::musl)), usavg = std::abs(drift(ReferenceScheme::usavg));
  CHECK(musl > 0.1);
  CHECK(usavg < 2e-3);
}
