// The component of failed particles in the whole step: who is in it, what it does, and that nothing changes
// without it.
#include "core/contact/failed_component.hpp"

#include <set>

#include <catch2/catch.hpp>

#include "tests/core/step/case.hpp"

using namespace mpm::tests;
using namespace mpm::core;

namespace {

constexpr ReferenceScheme schemes[] = {ReferenceScheme::usf, ReferenceScheme::usl, ReferenceScheme::musl,
                                       ReferenceScheme::usavg};
constexpr ReferenceShape shapes[] = {ReferenceShape::linear, ReferenceShape::ugimp, ReferenceShape::cpdi,
                                     ReferenceShape::cubic_bspline};
constexpr double middle = 9.1;

/// An elastic bar of 10 x 4 x 4 cells along x whose halves have the velocities -`speed` and `speed`.
ReferenceCase bar(ReferenceShape shape, ReferenceScheme scheme, double speed) {
  ReferenceCase c = open_space(shape, scheme);
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 8; ++j) {
      for (int k = 0; k < 8; ++k) {
        ReferenceParticle p;
        p.x = {4.35 + 0.5 * i, 4.3 + 0.5 * j, 4.2 + 0.5 * k};
        p.v = {i < 10 ? -speed : speed, 0, 0};
        p.V = 0.125;
        p.m = c.material.density * p.V;
        c.particles.push_back(p);
      }
    }
  }
  return c;
}

/// The right half, as a whole from the first step on.
bool right_half(const ReferenceParticle& p, double) { return p.x[0] > middle; }

/// Momentum along `axis` of the particles that started left and right of the middle.
std::array<double, 2> momenta(const SmallRun& run, std::size_t axis) {
  std::array<double, 2> sum{};
  for (const auto& [identity, p] : run.particles()) sum[identity < 640 ? 0 : 1] += p.m * p.v[axis];
  return sum;
}

/// Every particle is in the tile of its component, and the tiles are in order; the number of the failed ones.
std::size_t check_tiles(const SmallRun& run) {
  std::size_t failed = 0;
  for (const Brick& brick : run.model.grid->bricks()) {
    std::pair<int, std::int32_t> last{-1, 0};
    for (const ParticleTile& tile : brick.tiles) {
      const std::pair<int, std::int32_t> now{tile.body, tile.component};
      REQUIRE(last < now);
      REQUIRE(tile.count > 0);
      last = now;
      const BlockPool& pool = *run.model.bodies[static_cast<std::size_t>(tile.body)].pool;
      std::vector<double> columns(static_cast<std::size_t>(pool.layout().columns()));
      for (std::uint32_t i = 0; i < tile.count; ++i) {
        extract(pool, tile, i, columns.data());
        REQUIRE(component_of(run.model, tile.body, columns.data()) == tile.component);
        failed += columns[pool.layout().index(Column::failed)] > 0;
      }
    }
  }
  return failed;
}

}  // namespace

TEST_CASE("Particles change to the failed component at the end of the step in which they fail") {
  for (const ReferenceScheme scheme : schemes) {
    // A front of failure runs through a block that crosses borders of bricks.
    ReferenceCase c = tumbling_block();
    c.scheme = scheme;
    SmallRun run(c, 300, true, [&](const ReferenceParticle& p, double time) {
      return p.x[0] > 4.7 - 24 * time && p.x[1] < 1 - 5 * time;
    });
    CHECK(failed_component(*run.scene) == 2);
    CHECK(check_tiles(run) == 0);
    std::set<std::size_t> numbers;
    bool shares_brick = false;
    for (int step = 0; step < 30; ++step) {
      run.step();
      numbers.insert(check_tiles(run));
      for (const Brick& brick : run.model.grid->bricks()) {
        for (std::size_t t = 1; t < brick.tiles.size(); ++t)
          shares_brick = shares_brick || brick.tiles[t].body == brick.tiles[t - 1].body;
      }
    }
    INFO("scheme " << static_cast<int>(scheme) << ", failed at the end " << *numbers.rbegin());
    CHECK(run.particles().size() == c.particles.size());
    CHECK(numbers.size() > 3);
    CHECK(*numbers.rbegin() < c.particles.size());
    CHECK(shares_brick);
  }
}

TEST_CASE("A tile says which of its particles belong to the other tile of the body") {
  SmallRun run(bar(ReferenceShape::linear, ReferenceScheme::musl, 0), 1280, true, right_half);
  const FailedComponent failed(run.model);
  const ColumnLayout& layout = run.model.bodies[0].pool->layout();
  std::vector<double> block(static_cast<std::size_t>(layout.block_doubles()));
  for (const int lane : {1, 4, 6}) block[static_cast<std::size_t>(layout.offset(Column::failed) + lane)] = 1;
  ParticleTile tile;
  CHECK(failed.of(tile).misplaced(layout, block.data(), 8) == 0b01010010);
  CHECK(failed.of(tile).misplaced(layout, block.data(), 5) == 0b00010010);
  tile.component = failed_component(*run.scene);
  CHECK(failed.of(tile).misplaced(layout, block.data(), 8) == 0b10101101);
  CHECK(failed.of(tile).misplaced(layout, block.data(), 3) == 0b101);
  run.scene->contact.failed_to_component = false;
  CHECK(FailedComponent(run.model).of(tile).rule == nullptr);
}

TEST_CASE("Failed particles part from their body without tension, and press on it") {
  for (const ReferenceShape shape : shapes) {
    if (!has_passes(shape)) continue;
    for (const ReferenceScheme scheme : schemes) {
      if (left_out(shape, scheme)) continue;
      for (const double speed : {1.0, -1.0}) {
        INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme) << ", speed "
                      << speed);
        const ReferenceCase c = bar(shape, scheme, speed);
        SmallRun parts(c, 1280, true, right_half), whole(c, 1280, true, right_half);
        whole.scene->contact.failed_to_component = false;
        const double first = momenta(parts, 0)[1];
        for (SmallRun* run : {&parts, &whole}) {
          while (run->model.clock.time < 0.3) run->step();
        }
        const auto parted = momenta(parts, 0), held = momenta(whole, 0);
        CAPTURE(first, parted, held);
        for (const std::size_t axis : {0u, 1u, 2u})
          CHECK(std::abs(momenta(parts, axis)[0] + momenta(parts, axis)[1]) < 1e-12 * std::abs(first));
        CHECK(std::abs(held[1]) < 0.75 * std::abs(first));
        if (speed > 0)
          CHECK(parted[1] == Approx(first).epsilon(0.08));  // all but the pull of the first step
        else
          CHECK(parted[1] == Approx(held[1]).margin(0.25 * std::abs(first)));  // about the same pressure
      }
    }
  }
}

TEST_CASE("Without the setting, or without failure, nothing differs to the last bit") {
  const auto never = [](const ReferenceParticle&, double) { return false; };
  for (const ReferenceScheme scheme : schemes) {
    const ReferenceCase c = bar(ReferenceShape::linear, scheme, 1);
    SmallRun alone(c, 1280, false, never), waiting(c, 1280, true, never);
    SmallRun failing(c, 1280, false, right_half), switched_off(c, 1280, true, right_half);
    switched_off.scene->contact.failed_to_component = false;
    for (SmallRun* run : {&alone, &waiting, &failing, &switched_off}) run->step(20);
    CHECK(alone.columns() == waiting.columns());
    CHECK(alone.order() == waiting.order());
    CHECK(failing.columns() == switched_off.columns());
    CHECK(failing.order() == switched_off.order());
  }
}
