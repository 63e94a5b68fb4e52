// The whole step against the naive stepper of tests/support, which shares no code with it; both use that
// one's stress update, so what differs is the stepper. The two add up the same numbers in different orders
// and with different roundings (1e-16). A run amplifies that: a node lighter by S divides by S, and a
// yielding particle sits on a kink. 1e-9 of each quantity's own scale leaves room for that and none for a
// term that is missing.
#include <algorithm>
#include <limits>

#include <catch2/catch.hpp>

#include "core/step/scheme_change.hpp"
#include "tests/core/step/case.hpp"
#include "tests/support/effort.hpp"

using namespace mpm::tests;

namespace {

constexpr ReferenceScheme schemes[] = {ReferenceScheme::usf, ReferenceScheme::usl, ReferenceScheme::musl,
                                       ReferenceScheme::usavg};
constexpr double usl_floor = 0.2;  // of core/step/passes.cpp

template <class Container>
double norm(const Container& a) {
  double sum = 0;
  for (const double x : a) sum += x * x;
  return std::sqrt(sum);
}

/// Largest difference of any particle over the quantity's largest value.
struct Worst {
  double difference = 0, scale = 0;
  void note(double d, double s) {
    difference = std::max(difference, d);
    scale = std::max(scale, s);
  }
  double relative() const { return scale > 0 ? difference / scale : difference; }
};

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

void compare(const SmallRun& run, const ReferenceStepper& oracle, double tolerance) {
  const auto mine = run.particles();
  REQUIRE(mine.size() == oracle.particles().size());
  Worst x, v, volume, stress, energy, strain;
  for (const auto& [identity, p] : mine) {
    const ReferenceParticle& q = oracle.particles()[static_cast<std::size_t>(identity)];
    x.note(norm(minus(p.x, q.x)), run.model.grid->geometry().smallest_cell());
    v.note(norm(minus(p.v, q.v)), norm(q.v));
    volume.note(std::abs(p.V - q.V), q.V);
    for (std::size_t a = 0; a < 3; ++a)
      stress.note(norm(minus(p.s[a], q.s[a])), norm(q.s[a]) + std::abs(q.p));
    stress.note(std::abs(p.p - q.p) + std::abs(p.q - q.q), std::abs(q.p) + std::abs(q.q));
    energy.note(std::abs(p.E - q.E), std::abs(q.E));
    strain.note(std::abs(p.epef - q.epef), q.epef);
  }
  CHECK(x.relative() < tolerance);
  CHECK(v.relative() < tolerance);
  CHECK(volume.relative() < tolerance);
  CHECK(stress.relative() < tolerance);
  CHECK(energy.relative() < tolerance);
  CHECK(strain.relative() < tolerance);
}

/// Both take the oracle's steps. The stepper's own choice is the same in MUSL; USF and USL know the
/// particles' speeds of before the step only, which is off by the share of dv in c + |v|.
void run_both(ReferenceCase c, int steps, double tolerance,
              std::size_t split = std::numeric_limits<std::size_t>::max()) {
  c.usl_mass_floor = usl_floor;
  SmallRun run(c, split);
  run.scene->solution.mass_tolerance = 1e-15;  // the oracle's matrix is factorised
  c.wave_limit = wave_limit(*run.scene, run.model.scheme);
  ReferenceStepper oracle(c);
  double worst_dt = 0;
  for (int n = 0; n < brief(steps); ++n) {
    const double dt = oracle.dt();
    worst_dt = std::max(worst_dt, std::abs(c.dt_factor * run.model.clock.critical_dt / dt - 1));
    run.scene->solution.time_step.specified = dt;
    oracle.step();
    run.step();
  }
  CHECK(worst_dt < (c.scheme == ReferenceScheme::musl ? tolerance : 0.2));
  compare(run, oracle, tolerance);
}

}  // namespace

TEST_CASE("A Taylor bar moves as the naive stepper moves it", "[oracle]") {
  for (const ReferenceShape shape : reference_shapes) {
    for (const ReferenceScheme scheme : schemes) {
      INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme));
      ReferenceCase c = taylor_bar(1.27);
      c.shape = shape;
      c.scheme = scheme;
      run_both(c, 40, 1e-9);  // what yields amplifies round-off: 1e-9 after 50 steps
    }
  }
}

TEST_CASE("A run that changes from MUSL to USAVG moves as the naive stepper moves it", "[oracle]") {
  for (const ReferenceShape shape : reference_shapes) {
    INFO("shape " << static_cast<int>(shape));
    ReferenceCase c = tumbling_block();
    c.shape = shape;
    c.material.bq1 = 1.5;
    SmallRun run(c);
    ReferenceStepper oracle(c);
    for (int n = 0; n < 24; ++n) {
      if (n == 12) {
        run.stepper.reset();
        mpm::core::change_scheme(run.model, mpm::core::Scheme::usavg);
        oracle.set_scheme(ReferenceScheme::usavg);
      }
      run.scene->solution.time_step.specified = oracle.dt();
      oracle.step();
      run.step();
    }
    compare(run, oracle, 1e-9);
  }
}

namespace {

/// Two cells between fixed ends, both as full and as compressed as the other, and particles at the face
/// between them that are compressed too: they push the face up from below it, and down from above.
ReferenceCase trap() {
  ReferenceCase c;
  c.material = {.density = 1, .young = 1000, .poisson = 0.3, .bq1 = 1.5, .bq2 = 0.06};
  c.cell = {1, 1, 1};
  c.cells = {2, 1, 1};
  c.boundary = {1, 1, 2, 2, 2, 2};
  c.scheme = ReferenceScheme::usf;
  c.dt_factor = 0.9;
  for (const double x : {0.25, 0.75, 0.9999, 1.25, 1.75}) {
    for (int n = 0; n < 4; ++n) {
      ReferenceParticle p;
      p.x = {x, 0.25 + 0.5 * (n % 2), 0.25 + 0.5 * (n / 2)};
      p.V = p.m = 0.125;
      p.p = 10;
      c.particles.push_back(p);
    }
  }
  return c;
}
}  // namespace

TEST_CASE("A particle trapped at a face moves as the naive stepper moves it", "[oracle]") {
  run_both(trap(), 200, 1e-9);
}

TEST_CASE("A particle trapped at a face gains no energy", "[usf]") {
  const ReferenceCase c = trap();
  double first = 0;  // of the pressures at the start
  for (const ReferenceParticle& p : c.particles) first += p.V * p.p * p.p / (2 * c.material.bulk());
  SmallRun run(c);
  run.step(1000);
  double added = 0;
  for (const auto& [identity, p] : run.particles()) added += p.m * (norm(p.v) * norm(p.v) / 2 + p.E);
  CHECK(added < 0.1 * first);
}

namespace {

ReferenceCase shrinking_block(ReferenceShape shape, ReferenceScheme scheme, int boundary) {
  ReferenceCase c = tumbling_block();
  c.shape = shape;
  c.scheme = scheme;
  c.boundary.fill(boundary);
  c.wall_reaction = true;
  c.gravity = {-30, 20, 40};
  // The viscosity jumps where the rate of volume change goes through zero: in a rigid motion the rounding of
  // the first step would decide it.
  for (ReferenceParticle& p : c.particles)
    for (std::size_t a = 0; a < 3; ++a) p.v[a] -= 0.02 * p.x[a];
  return c;
}

/// Moves the block into the corner of the lower y and the upper x and z, on a grid with so many cells more
/// along x and z.
void move_to_corner(ReferenceCase& c, int more_x = 0, int more_z = 0) {
  for (ReferenceParticle& p : c.particles)
    p.x = {p.x[0] + 5.7 + more_x * c.cell[0], p.x[1] - 5.4, p.x[2] + 4.7 + more_z * c.cell[2]};
}

/// A part of the block, which still reaches over two bricks, in free space (boundary 0) or in the corner of
/// the lower y and the upper x and z.
ReferenceCase small_block(ReferenceShape shape, ReferenceScheme scheme, int boundary) {
  ReferenceCase c = shrinking_block(shape, scheme, boundary);
  std::erase_if(c.particles, [](const ReferenceParticle& p) {
    return p.x[0] < 2.4 || p.x[1] > 0.75 || p.x[1] < -1 || p.x[2] < 1.1;
  });
  if (boundary != 0) move_to_corner(c);
  return c;
}

/// The block in free space (boundary 0) or thrown into the corner of the lower y and the upper x and z, on a
/// grid with so many cells more along x and z.
void tumble(ReferenceScheme scheme, int boundary, int more_x = 0, int more_z = 0) {
  for (const ReferenceShape shape : reference_shapes) {
    INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme) << ", boundary "
                  << boundary << ", cells " << more_x << " " << more_z);
    ReferenceCase c = shrinking_block(shape, scheme, boundary);
    c.cells[0] += more_x;
    c.cells[2] += more_z;
    if (boundary != 0) move_to_corner(c, more_x, more_z);
    run_both(c, 30, 1e-9);
  }
}

}  // namespace

TEST_CASE("A block tumbles through bricks as the naive stepper moves it", "[oracle]") {
  for (const ReferenceScheme scheme : schemes) tumble(scheme, 0);
}

TEST_CASE("USF, MUSL and USAVG: a block hits walls as the naive stepper lets it", "[oracle][walls]") {
  for (const int boundary : {1, 2, 4}) {
    tumble(ReferenceScheme::usf, boundary);
    tumble(ReferenceScheme::musl, boundary);
    tumble(ReferenceScheme::usavg, boundary);
  }
}

TEST_CASE("USL: a block hits walls as the naive stepper lets it", "[oracle][walls]") {
  for (const int boundary : {1, 2, 4}) tumble(ReferenceScheme::usl, boundary);
}

TEST_CASE("Walls at the faces of bricks, one cell and two cells beyond them are as the naive stepper's",
          "[oracle][walls]") {
  for (const int boundary : {1, 2, 4}) {
    tumble(ReferenceScheme::musl, boundary, 2, 1);    // 16 and 12 cells
    tumble(ReferenceScheme::musl, boundary, -1, -2);  // 13 and 9
    tumble(ReferenceScheme::musl, boundary, 4, 3);    // 18 and 14
  }
}

TEST_CASE("XPIC and FMPM: a small block flies, hits walls and leaves them as the naive stepper lets it",
          "[oracle]") {
  int n = 0;
  for (const ReferenceShape shape : reference_shapes) {
    for (const ReferenceScheme scheme : schemes) {
      for (const int boundary : {0, 1, 2, 4}) {
        ReferenceCase c = small_block(shape, scheme, boundary);
        // In turns, so that each transfer and order meets each scheme and boundary with some of the shapes.
        c.transfer = (n + n / 4 + n / 12) % 2 == 0 ? ReferenceTransfer::fmpm : ReferenceTransfer::xpic;
        c.order = 1 + (n + n / 8) % 4;
        c.interval = n % 5 == 2 ? 3 : 1;
        ++n;
        INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme) << ", boundary "
                      << boundary << ", order " << c.order << " of every " << c.interval << " steps");
        run_both(c, 30, 1e-9);
      }
    }
  }
}

TEST_CASE("Consistent mass: a small block flies, hits walls and leaves them as the naive stepper lets it",
          "[oracle]") {
  for (const ReferenceShape shape : reference_shapes) {
    if (!mpm::core::consistent_mass_goes_with(shape_function_of(shape))) continue;
    for (const ReferenceScheme scheme :
         {ReferenceScheme::usf, ReferenceScheme::musl, ReferenceScheme::usavg}) {
      for (const int boundary : {0, 1, 2, 4}) {
        INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme) << ", boundary "
                      << boundary);
        ReferenceCase c = small_block(shape, scheme, boundary);
        c.consistent = true;
        c.dt_factor = 0.2;
        run_both(c, 20, 1e-9);
      }
    }
  }
}

TEST_CASE("DDMP weights cells by density as the naive stepper weights them", "[oracle]") {
  if (!has_passes(ReferenceShape::ddmp)) return;
  for (const ReferenceScheme scheme : schemes) {
    for (const int boundary : {0, 2}) {
      INFO("scheme " << static_cast<int>(scheme) << ", boundary " << boundary);
      ReferenceCase c = shrinking_block(ReferenceShape::ddmp, scheme, boundary);
      c.weigh_cells = true;
      c.dt_factor = 0.05;
      if (boundary != 0) move_to_corner(c);
      const std::size_t half = c.particles.size() / 2;  // the upper one along z, thinner than its material
      for (std::size_t n = half; n < c.particles.size(); ++n)
        c.particles[n].m *= 0.01 + 0.003 * static_cast<double>(n % 7);
      run_both(c, 30, 1e-9, half);
    }
  }
}

namespace {

/// The upper half of a block, along z, is of a light material.
void beside_lighter(ReferenceShape shape, ReferenceScheme scheme, int boundary) {
  ReferenceCase c = shrinking_block(shape, scheme, boundary);
  c.dt_factor = 0.05;
  if (boundary != 0) move_to_corner(c);
  c.light_from = c.particles.size() / 2;
  for (std::size_t n = c.light_from; n < c.particles.size(); ++n)
    c.particles[n].m *= 0.01 + 0.003 * static_cast<double>(n % 7);
  ReferenceCase without = c;
  without.inset = 0;
  ReferenceStepper inside(c), anywhere(without);
  double apart = 0;
  for (int n = 0; n < 4; ++n) inside.step(), anywhere.step();
  for (std::size_t n = 0; n < c.particles.size(); ++n)
    apart = std::max(apart, std::abs(inside.particles()[n].v[2] - anywhere.particles()[n].v[2]));
  CHECK(apart > 1e-8);
  run_both(c, 30, 1e-9, c.light_from);
}

}  // namespace

TEST_CASE("Particles beside much lighter ones act from inside their cells as the naive stepper's",
          "[oracle]") {
  for (const ReferenceShape shape : {ReferenceShape::linear, ReferenceShape::ddmp}) {
    if (!has_passes(shape)) continue;
    for (const ReferenceScheme scheme : schemes) {
      for (const int boundary : {0, 2}) {
        INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme) << ", boundary "
                      << boundary);
        beside_lighter(shape, scheme, boundary);
      }
    }
  }
}

TEST_CASE("Volume changes are averaged as the naive stepper averages them", "[oracle]") {
  for (const ReferenceShape shape : reference_shapes) {
    for (const ReferenceScheme scheme : schemes) {
      INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme));
      ReferenceCase c = shrinking_block(shape, scheme, 2);
      c.average = true;
      move_to_corner(c);
      run_both(c, 30, 1e-9);
      ReferenceCase bar = taylor_bar(1.27);
      bar.shape = shape;
      bar.scheme = scheme;
      bar.average = true;
      run_both(bar, 20, 1e-9);
    }
  }
}

TEST_CASE("Pressures of a site become equal as the naive stepper makes them", "[oracle]") {
  for (const ReferenceShape shape : reference_shapes) {
    for (const ReferenceScheme scheme : schemes) {
      INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme));
      ReferenceCase c = small_block(shape, scheme, 2);
      c.average = true;
      c.relaxation = 0.3;
      run_both(c, 30, 1e-9);
    }
  }
}

TEST_CASE("A plate one cell thick between two walls moves as the naive stepper moves it", "[oracle]") {
  for (const ReferenceShape shape : reference_shapes) {
    for (const ReferenceScheme scheme : schemes) {
      for (const int boundary : {0, 1, 2, 4}) {
        INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme) << ", boundary "
                      << boundary);
        ReferenceCase c = shrinking_block(shape, scheme, 0);
        c.boundary[2] = c.boundary[3] = boundary;
        c.origin[1] = 0.15;
        c.cells[1] = 1;
        c.gravity[1] = 1;
        std::erase_if(c.particles, [](const ReferenceParticle& p) { return p.x[1] < 0.15 || p.x[1] > 0.95; });
        for (ReferenceParticle& p : c.particles) p.v[1] *= 0.02;  // it stays between the faces
        run_both(c, 30, 1e-9);
      }
    }
  }
}
