// Contact in the whole step: where nothing meets nothing changes, and what meets bounces.
#include "core/contact/contact.hpp"

#include <catch2/catch.hpp>

#include "tests/core/step/case.hpp"

using namespace mpm::tests;

namespace {

constexpr ReferenceScheme schemes[] = {ReferenceScheme::usf, ReferenceScheme::usl, ReferenceScheme::musl,
                                       ReferenceScheme::usavg};

/// Two elastic blocks of 4 x 4 x 4 cells with a gap along x between them; the second is `behind` the first.
ReferenceCase two_blocks(const ReferenceCase& method, double gap, const Vector& approach) {
  ReferenceCase c = open_space(method.shape, method.scheme);
  c.transfer = method.transfer;
  c.order = method.order;
  c.gravity = {};
  const ReferenceParticle like = tumbling_block().particles.front();
  for (const double first : {4.1, 8.1 + gap}) {
    for (int i = 0; i < 8; ++i) {
      for (int j = 0; j < 8; ++j) {
        for (int k = 0; k < 8; ++k) {
          ReferenceParticle p = like;
          p.x = {first + 0.25 + 0.5 * i, 4.3 + 0.5 * j, 4.2 + 0.5 * k};
          p.V = 0.125;
          p.m = c.material.density * p.V;
          p.s = {};
          p.p = p.q = p.E = 0;
          const double sign = first < 5 ? 0.5 : -0.5;
          for (std::size_t a = 0; a < 3; ++a) p.v[a] = sign * approach[a];
          c.particles.push_back(p);
        }
      }
    }
  }
  return c;
}

constexpr std::size_t half_of = 512;

/// f(case with shape, scheme and transfer): XPIC and FMPM with one scheme for each shape, in turn; in a brief
/// test a quarter of them.
template <class F>
void for_each_method(F f) {
  int turn = 0;
  for (const ReferenceShape shape : reference_shapes) {
    for (const ReferenceScheme scheme : schemes) {
      if (left_out(shape, scheme)) continue;
      for (const ReferenceTransfer transfer :
           {ReferenceTransfer::flip, ReferenceTransfer::xpic, ReferenceTransfer::fmpm}) {
        const bool corrects = transfer != ReferenceTransfer::flip;
        if (corrects && static_cast<int>(shape) % 3 != static_cast<int>(scheme)) continue;
        if (brief_tests && turn++ % 4 != 0) continue;
        INFO("shape " << static_cast<int>(shape) << ", scheme " << static_cast<int>(scheme) << ", transfer "
                      << static_cast<int>(transfer));
        ReferenceCase method;
        method.shape = shape;
        method.scheme = scheme;
        method.transfer = transfer;
        method.order = static_cast<int>(shape) % 2 == 0 ? 3 : 1;
        f(method);
      }
    }
  }
}

Vector momentum(const SmallRun& run, std::int64_t first, std::int64_t last) {
  Vector sum{};
  for (const auto& [identity, p] : run.particles()) {
    if (identity < first || identity >= last) continue;
    for (std::size_t a = 0; a < 3; ++a) sum[a] += p.m * p.v[a];
  }
  return sum;
}

}  // namespace

TEST_CASE("Components that do not meet move as without contact, to the last bit") {
  for_each_method([](const ReferenceCase& method) {
    const ReferenceCase c = two_blocks(method, 4.0, {-1, 0.3, 0.2});
    SmallRun one(c, half_of), two(c, half_of, true);
    for (SmallRun* run : {&one, &two}) run->step(10);
    CHECK(one.columns() == two.columns());
  });
}

TEST_CASE("Two blocks bounce: momentum is exact, they part, and they slide without friction") {
  for_each_method([](const ReferenceCase& method) {
    const ReferenceCase c = two_blocks(method, 0.3, {2, 0.5, 0.25});
    SmallRun run(c, half_of, true);
    const Vector first = momentum(run, 0, half_of);
    while (run.model.clock.time < 2.5) run.step();
    const Vector after = momentum(run, 0, half_of), other = momentum(run, half_of, 2 * half_of);
    CAPTURE(first, after, other);
    for (std::size_t a = 0; a < 3; ++a) CHECK(std::abs(after[a] + other[a]) < 1e-12 * first[0]);
    const bool is_pic = method.transfer != ReferenceTransfer::flip && method.order == 1;
    CHECK(after[0] < (is_pic ? -0.3 : -0.5) * first[0]);  // it bounced
    // Along the faces nothing acts but what the tilted normals at their edges give.
    CHECK(after[1] == Approx(first[1]).epsilon(0.15));
    CHECK(after[2] == Approx(first[2]).epsilon(0.15));
  });
}
