// The consistent mass matrix: what its solution keeps and what it bounds. That a step is the textbook's, with
// a matrix that is factorised, is shown by oracle_test.cpp.
#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "core/step/mass_solution.hpp"
#include "tests/core/step/case.hpp"

using namespace mpm::tests;
namespace core = mpm::core;

namespace {

constexpr ReferenceScheme schemes[] = {ReferenceScheme::usf, ReferenceScheme::musl, ReferenceScheme::usavg};

ReferenceCase tumbling(ReferenceShape shape, ReferenceScheme scheme) {
  ReferenceCase c = tumbling_block();
  c.shape = shape;
  c.scheme = scheme;
  c.consistent = true;
  c.dt_factor = 0.2;
  return c;
}

struct Motion {
  Vector momentum{}, angular_momentum{};
  double kinetic = 0;
  bool finite = true;
};
Motion motion_of(const SmallRun& run) {
  Motion all;
  for (const auto& [identity, p] : run.particles()) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      all.momentum[a] += p.m * p.v[a];
      all.angular_momentum[a] += p.m * (p.x[b] * p.v[c] - p.x[c] * p.v[b]);
      all.kinetic += 0.5 * p.m * p.v[a] * p.v[a];
      all.finite = all.finite && std::isfinite(p.x[a]) && std::isfinite(p.v[a]) && std::isfinite(p.s[a][a]);
    }
  }
  return all;
}

}  // namespace

TEST_CASE("The iteration is as near to the inverse as its tolerance, for every eigenvalue") {
  for (const double tolerance : {0.3, 1e-2, 1e-6, 1e-13}) {
    const core::MassIteration iteration(tolerance);
    double worst = 0;
    for (double mu = core::mass_blend; mu <= 1; mu += 0.001) {
      double u = 1, residual = 1 - mu, along = 0;
      for (const core::MassIteration::Step& step : iteration.steps()) {
        along = step.last * along + step.residual * residual;
        u += along;
        residual -= mu * along;
      }
      CHECK(residual == Approx(1 - mu * u).margin(1e-14));
      CHECK(std::abs(residual) <= tolerance * (1 - mu) + 1e-15);
      worst = std::max(worst, std::abs(residual) / (1 - mu + 1e-300));
    }
    // With one step less it would not be: T_(k+1) < 2.62 T_k at (1 + b)/(1 - b) = 1.5.
    CHECK(worst > 0.38 * tolerance);
  }
  CHECK(core::MassIteration(1e-2).steps().size() == 6);
}

TEST_CASE("Consistent mass keeps momentum to round-off, and uniform motion") {
  for (const ReferenceShape shape : reference_shapes) {
    if (!core::consistent_mass_goes_with(shape_function_of(shape))) continue;
    for (const ReferenceScheme scheme : schemes) {
      INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme));
      ReferenceCase c = tumbling(shape, scheme);
      SmallRun deforms(c);
      const Motion before = motion_of(deforms);
      deforms.step(brief(30));
      const Motion after = motion_of(deforms);
      for (std::size_t a = 0; a < 3; ++a)
        CHECK(after.momentum[a] == Approx(before.momentum[a]).epsilon(1e-12));

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

TEST_CASE("A turning block keeps more of its energy and angular momentum than with lumped mass") {
  for (const ReferenceShape shape : {ReferenceShape::linear, ReferenceShape::quadratic_bspline}) {
    for (const ReferenceScheme scheme : schemes) {
      INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme));
      ReferenceCase c = tumbling(shape, scheme);
      c.material.bq1 = c.material.bq2 = 0;
      double lost[2];
      for (const bool consistent : {false, true}) {
        c.consistent = consistent;
        SmallRun run(c);
        run.scene->solution.time_step.specified = 0.004;
        const Motion before = motion_of(run);
        run.step(60);
        lost[consistent] = std::abs(motion_of(run).angular_momentum[2] / before.angular_momentum[2] - 1);
      }
      CHECK(lost[1] < lost[0]);
    }
  }
}

TEST_CASE("Fewer particles than nodes: the matrix is singular, the motion is finite") {
  for (const ReferenceShape shape : reference_shapes) {
    if (!core::consistent_mass_goes_with(shape_function_of(shape))) continue;
    for (const ReferenceScheme scheme : schemes) {
      if (left_out(shape, scheme)) continue;
      // Lone particles beside a node, on a face, just beside one and inside a cell; then one particle per
      // cell. (Exactly at a node others have no mass and no part in the motion, with lumped mass too.)
      for (const int row : {1, 4, 6}) {
        INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme) << ", row "
                      << row);
        ReferenceCase c = open_space(shape, scheme);
        c.consistent = true;
        c.material.density = 1;
        for (int n = 0; n < row * row; ++n) {
          ReferenceParticle p;
          const double inside[] = {1e-6, 1e-11, 0.5, 0.73};
          p.x = {4.0 + n % row + (row == 4 ? inside[n % 4] : 0.5), 3.0 + n / row + (row == 1 ? 1e-9 : 0.5),
                 row == 6 ? 5.5 : 5 + inside[n / row % 4]};
          p.v = {0.6 - 0.1 * n, 0.4, 0.3 * (n % 3 - 1)};
          p.V = 1;
          p.m = 1;
          c.particles.push_back(p);
        }
        SmallRun run(c);
        const Motion before = motion_of(run);
        run.step(60);
        const Motion after = motion_of(run);
        CHECK(after.finite);
        CHECK(after.kinetic < 3 * before.kinetic);
        for (std::size_t a = 0; a < 3; ++a)
          CHECK(after.momentum[a] == Approx(before.momentum[a]).epsilon(1e-11).margin(1e-11));
      }
    }
  }
}

TEST_CASE("A scene without consistent mass has no array and no phase for it") {
  const auto phases = [](SmallRun& run) {
    run.step(1);
    return run.stepper->phases().size();
  };
  for (const ReferenceScheme scheme : schemes) {
    ReferenceCase c = tumbling(ReferenceShape::linear, scheme);
    SmallRun consistent(c);
    c.consistent = false;
    SmallRun lumped(c);
    CHECK(consistent.model.grid->arrays().has(core::NodeArray::third));
    CHECK_FALSE(lumped.model.grid->arrays().has(core::NodeArray::third));
    // USF solves for the velocities at the start and the increments, MUSL for these and the new velocities,
    // USAVG for all three.
    CHECK(phases(consistent) == phases(lumped) + (scheme == ReferenceScheme::usavg ? 3 : 2));
  }
}

TEST_CASE("No solution leads through a wall, and what a wall holds it holds in every iteration") {
  std::mt19937 random(7);
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
      std::vector<double> motion(static_cast<std::size_t>(core::node_doubles * nodes)), direction(motion),
          solution(motion), products(motion);
      const auto at = [&](std::vector<double>& records, int n) {
        return core::Motion{records.data() + core::node_doubles * n};
      };
      const auto wall = [&](int n) { return n - n % side + shape.below; };
      for (double& x : motion) x = unit(random);
      for (int n = 0; n < nodes; ++n) motion[static_cast<std::size_t>(core::node_doubles * n + 3)] = 0.5;
      core::update_nodes({}, 0.7, 1e-9, faces, {shape, shape}, motion.data());
      const int velocity = core::Motion::velocity_at;
      core::begin_mass_solution(faces, nodes, 1e-9, motion.data(), velocity, velocity, velocity,
                                direction.data(), solution.data());
      const core::MassIteration iteration(1e-2);
      int held = 0, free = 0;
      bool first = true;
      for (const core::MassIteration::Step& step : iteration.steps()) {
        for (double& x : products) x = 0.5 * unit(random);
        core::advance_mass_solution(faces, nodes, products.data(), first, step, velocity, direction.data(),
                                    solution.data());
        first = false;
        for (int n = shape.below; n < nodes; n += side) {
          const bool stopped = at(motion, n).velocity()[0] == 0;
          if (stopped) CHECK((at(solution, n).velocity()[0] == 0 && at(direction, n).increment()[0] == 0));
          if (boundary == core::Boundary::fixed)
            CHECK((at(solution, n).velocity()[1] == 0 && at(direction, n).increment()[2] == 0));
          ++(stopped ? held : free);
        }
      }
      core::end_mass_solution(faces, solution.data());
      for (int n = 0; n < nodes; ++n) {
        const core::Motion it = at(solution, n), w = at(solution, wall(n)), m = at(solution, wall(n) + 1);
        if (n == wall(n)) CHECK_FALSE(it.velocity()[0] < 0);
        if (n >= wall(n)) continue;
        for (int a = 0; a < 3; ++a) {  // beyond it
          const bool reversed = boundary == core::Boundary::fixed || a == 0;
          CHECK(it.velocity()[a] == (boundary == core::Boundary::rigid_wall
                                         ? 2 * w.velocity()[a] - m.velocity()[a]
                                         : (reversed ? -1 : 1) * m.velocity()[a]));
        }
      }
      CHECK(held > 0);
      CHECK((free > 0) == (boundary == core::Boundary::rigid_wall));
    }
  }
}
