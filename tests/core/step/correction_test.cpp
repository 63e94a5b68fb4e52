// XPIC and FMPM: what their orders keep and remove. That a step is the textbook's is shown by
// oracle_test.cpp.
#include <catch2/catch.hpp>

#include "core/step/node_update.hpp"
#include "tests/core/step/case.hpp"

using namespace mpm::tests;
namespace core = mpm::core;

namespace {

constexpr ReferenceTransfer corrected[] = {ReferenceTransfer::xpic, ReferenceTransfer::fmpm};

ReferenceCase in_free_flight(ReferenceShape shape, ReferenceTransfer transfer, int order) {
  ReferenceCase c = tumbling_block();
  c.shape = shape;
  c.transfer = transfer;
  c.order = order;
  return c;
}

/// A cube of 22 x 22 x 22 particles at the quarter points of cubic cells that turns about its centre, without
/// stress.
ReferenceCase turning_cube(ReferenceShape shape, int order) {
  ReferenceCase c = in_free_flight(shape, ReferenceTransfer::fmpm, order);
  c.scheme = ReferenceScheme::usl;  // the velocities of its first step follow from no strain
  c.origin = {-8, -8, -8};
  c.cell = {1, 1, 1};
  c.cells = {16, 16, 16};
  c.gimp_half_size = {0.25, 0.25, 0.25};
  c.particles.clear();
  for (int n = 0; n < 22 * 22 * 22; ++n) {
    ReferenceParticle p;
    p.x = {0.5 * (n % 22) - 5.25, 0.5 * (n / 22 % 22) - 5.25, 0.5 * (n / 484) - 5.25};
    p.v = {-p.x[1] + 0.2 * p.x[2], p.x[0], -0.2 * p.x[0]};
    p.V = 0.125;
    p.m = c.material.density * p.V;
    c.particles.push_back(p);
  }
  return c;
}

/// Change of the velocities in the first step: over all particles, by mass, and the largest of any at least
/// `depth` below the surface.
struct Change {
  double rms = 0, deep = 0;
};
Change change_of(const ReferenceCase& c, double depth) {
  SmallRun run(c);
  run.step();
  Change change;
  for (const auto& [identity, p] : run.particles()) {
    const ReferenceParticle& first = c.particles[static_cast<std::size_t>(identity)];
    double square = 0, outermost = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      square += (p.v[a] - first.v[a]) * (p.v[a] - first.v[a]);
      outermost = std::max(outermost, std::abs(first.x[a]));
    }
    change.rms += square;
    if (outermost <= 5.5 - depth) change.deep = std::max(change.deep, std::sqrt(square));
  }
  change.rms = std::sqrt(change.rms / static_cast<double>(c.particles.size()));
  return change;
}

}  // namespace

TEST_CASE("XPIC and FMPM of order 1 are PIC, to the last bit") {
  for (const ReferenceShape shape : reference_shapes) {
    for (const ReferenceScheme scheme :
         {ReferenceScheme::usf, ReferenceScheme::usl, ReferenceScheme::musl, ReferenceScheme::usavg}) {
      ReferenceCase c = in_free_flight(shape, ReferenceTransfer::flip, 1);
      c.scheme = scheme;
      SmallRun pic(c);
      pic.scene->solution.transfer = core::Transfer::pic;
      const double dt = 0.5 * pic.model.clock.critical_dt;  // USAVG's limit depends on the transfer
      pic.scene->solution.time_step.specified = dt;
      pic.step(10);
      for (const ReferenceTransfer transfer : corrected) {
        c.transfer = transfer;
        SmallRun run(c);
        run.scene->solution.time_step.specified = dt;
        run.step(10);
        CHECK(run.columns() == pic.columns());
      }
    }
  }
}

TEST_CASE("XPIC and FMPM keep uniform motion and momentum in every order") {
  for (const ReferenceShape shape : reference_shapes) {
    for (const ReferenceTransfer transfer : corrected) {
      for (const int order : {1, 2, 3, 7}) {
        INFO("shape " << static_cast<int>(shape) << ", order " << order);
        ReferenceCase c = in_free_flight(shape, transfer, order);
        const auto momentum = [](const SmallRun& run) {
          Vector sum{};
          for (const auto& [identity, p] : run.particles())
            for (std::size_t a = 0; a < 3; ++a) sum[a] += p.m * p.v[a];
          return sum;
        };
        SmallRun deforms(c);
        const Vector before = momentum(deforms);
        deforms.step(brief(30));
        for (std::size_t a = 0; a < 3; ++a) CHECK(momentum(deforms)[a] == Approx(before[a]).epsilon(1e-12));

        for (ReferenceParticle& p : c.particles) p.v = {6, -5, 4};
        SmallRun uniform(c);
        uniform.step(brief(30));
        double off = 0;
        for (const auto& [identity, p] : uniform.particles())
          off = std::max({off, std::abs(p.v[0] - 6), std::abs(p.v[1] + 5), std::abs(p.v[2] - 4)});
        CHECK(off < 1e-12);
      }
    }
  }
}

TEST_CASE("A linear velocity field is kept inside, and from order to order better at the surface") {
  for (const ReferenceShape shape : reference_shapes) {
    INFO("shape " << static_cast<int>(shape));
    double last = std::numeric_limits<double>::infinity();
    for (const int order : {1, 2, 4, 8, 16}) {
      // Each order carries what the surface does to the velocities on by the width of a shape function.
      const double width = shape == ReferenceShape::linear          ? 2
                           : shape == ReferenceShape::cubic_bspline ? 4
                                                                    : 3;
      const Change change = change_of(turning_cube(shape, order), width * order);
      CHECK(change.deep < 1e-13);
      CHECK(change.rms < 0.9 * last);
      last = change.rms;
    }
  }
}

TEST_CASE("Noise that the grid cannot see goes in one step") {
  for (const ReferenceTransfer transfer : corrected) {
    // Along x the particles of a cell move against each other: S+ V is zero inside.
    ReferenceCase c = turning_cube(ReferenceShape::linear, 3);
    c.transfer = transfer;
    int n = 0;
    for (ReferenceParticle& p : c.particles) p.v = {n++ % 2 == 0 ? 1.0 : -1.0, 0, 0};
    for (const ReferenceTransfer kept : {ReferenceTransfer::flip, transfer}) {
      c.transfer = kept;
      SmallRun run(c);
      run.step();
      double most = 0;
      for (const auto& [identity, p] : run.particles())
        if (std::abs(c.particles[static_cast<std::size_t>(identity)].x[0]) < 1)
          most = std::max(most, std::abs(p.v[0]));
      CHECK(most == Approx(kept == ReferenceTransfer::flip ? 1 : 0).margin(1e-3));
    }
  }
}

TEST_CASE("With an interval only every n-th step corrects, by its number") {
  ReferenceCase c = in_free_flight(ReferenceShape::quadratic_bspline, ReferenceTransfer::xpic, 3);
  c.interval = 4;
  SmallRun every_fourth(c);
  c.transfer = ReferenceTransfer::flip;
  SmallRun flip(c);
  every_fourth.step(3), flip.step(3);
  CHECK(every_fourth.columns() == flip.columns());
  every_fourth.step(1), flip.step(1);
  CHECK(every_fourth.columns() != flip.columns());

  // As a restart does: the number of the step counts, not those since the start.
  c.transfer = ReferenceTransfer::xpic;
  SmallRun later(c);
  later.model.clock.step = 3;
  SmallRun now(c);
  later.step(1), now.step(1);
  CHECK(later.columns() != now.columns());
}

TEST_CASE("A scene without XPIC and FMPM has no array and no phase for them") {
  ReferenceCase c = in_free_flight(ReferenceShape::linear, ReferenceTransfer::flip, 4);
  const auto phases = [](SmallRun& run) {
    run.step(1);
    return run.stepper->phases().size();
  };
  SmallRun flip(c);
  CHECK_FALSE(flip.model.grid->arrays().has(core::NodeArray::third));
  c.transfer = ReferenceTransfer::xpic;
  SmallRun fourth(c);
  CHECK(fourth.model.grid->arrays().has(core::NodeArray::third));
  CHECK(phases(fourth) == phases(flip) + 6);
  c.order = 1;
  SmallRun first(c);
  CHECK_FALSE(first.model.grid->arrays().has(core::NodeArray::third));
  CHECK(phases(first) == phases(flip));
}

TEST_CASE("No order leads through a wall, and what a wall holds it holds in every order") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const core::Boundary boundary :
       {core::Boundary::fixed, core::Boundary::symmetry, core::Boundary::rigid_wall}) {
    for (const core::NodeBlockShape shape : {core::NodeBlockShape{0, 0}, {1, 0}, {1, 1}}) {
      core::GridGeometry g;
      g.cell = g.inverse_cell = {1, 1, 1};
      g.cells = {4, 4, 4};
      g.boundary[0] = boundary;  // lower x
      const core::BoundaryFaces faces(g, shape, {0, 0, 0});
      const int nodes = shape.nodes(), side = shape.side();
      std::vector<double> motion(static_cast<std::size_t>(core::node_doubles * nodes)), sum(motion),
          momenta(motion);
      const auto at = [&](std::vector<double>& records, int n) {
        return core::Motion{records.data() + core::node_doubles * n};
      };
      const auto wall = [&](int n) { return n - n % side + shape.below; };
      const auto mirror = [&](int n) { return wall(n) + 1; };
      for (const bool of_start : {false, true}) {
        for (double& x : motion) x = unit(random);
        for (int n = 0; n < nodes; ++n) motion[static_cast<std::size_t>(core::node_doubles * n + 3)] = 0.5;
        core::update_nodes({}, 0.7, 1e-9, faces, {shape, shape}, motion.data());
        core::begin_correction(of_start, faces, nodes, motion.data(), sum.data());
        int held = 0, free = 0;
        for (int order = 2; order <= 6; ++order) {
          for (double& x : momenta) x = unit(random);
          core::continue_correction(faces, momenta.data(), nodes, sum.data());
          for (int n = 0; n < nodes; ++n) {
            const core::Motion it = at(sum, n), w = at(sum, wall(n)), m = at(sum, mirror(n));
            if (n == wall(n)) {
              const bool stopped = at(motion, n).velocity()[0] == 0;
              CHECK_FALSE(it.velocity()[0] < 0);
              if (stopped) CHECK((it.velocity()[0] == 0 && it.increment()[0] == 0));
              if (boundary == core::Boundary::fixed)
                CHECK((it.velocity()[1] == 0 && it.velocity()[2] == 0 && it.increment()[1] == 0));
              ++(stopped ? held : free);
            } else if (n < wall(n)) {  // beyond it
              for (int a = 0; a < 3; ++a) {
                const bool reversed = boundary == core::Boundary::fixed || a == 0;
                const double expected = boundary == core::Boundary::rigid_wall
                                            ? 2 * w.increment()[a] - m.increment()[a]
                                            : (reversed ? -1 : 1) * m.increment()[a];
                CHECK(it.increment()[a] == expected);
              }
            }
          }
        }
        CHECK(held > 0);
        CHECK((free > 0) == (boundary == core::Boundary::rigid_wall));
      }
    }
  }
}
