// A rigid body struck at nodes: impulses by its mass and inertia together, against the closed form of one
// node and the balance of several.
#include "core/contact/rigid_motion.hpp"

#include <array>
#include <functional>
#include <vector>

#include <catch2/catch.hpp>

using namespace mpm::core;

namespace {

struct Struck {
  Vec3<double> place{}, normal{};  ///< outward of the body
  double mass = 0;
  Vec3<double> velocity{};  ///< of what strikes, without contact
};

RigidState body() {
  RigidState s;
  s.mass = 3;
  s.centre = {1, 2, 3};
  s.inertia = {2.0, 1.5, 1.0, 0.2, -0.1, 0.3};
  return s;
}

/// Smooth contact: the impulse that brings a node to the body's velocity along the normal, if it approaches.
double impulse_at(const RigidState& s, const RigidVelocity& q, const Struck& node) {
  const double approach = dot(q.at(node.place - s.centre) - node.velocity, node.normal);
  return approach > 0 ? node.mass * approach : 0;
}

RigidVelocity solve(const RigidState& s, const std::vector<Struck>& nodes, int& trials) {
  const RigidVelocity free{s.velocity, s.spin};
  RigidVelocity q = free;
  for (trials = 1; trials <= 20; ++trials) {
    RigidResponse response;
    for (const Struck& node : nodes) {
      const double p = impulse_at(s, q, node);
      if (p > 0) response.add(-p * node.normal, node.place - s.centre, node.normal, node.mass, 0);
    }
    std::array<double, RigidResponse::size> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = response.sums[i].value();
    const RigidVelocity before = q;
    q = next_trial(s, free, before, values);
    if (same_motion(s, before, q)) break;
  }
  return q;
}

}  // namespace

TEST_CASE("one node strikes a free body with its effective mass there") {
  RigidState s = body();
  s.velocity = {1, -1, 2};
  s.spin = {0.5, 0.2, -0.4};
  const Vec3<double> n = {0.6, 0, 0.8};
  const Struck node{{1.5, 2.7, 3.9}, n, 0.7, {-1, 0, -3}};
  const Vec3<double> arm = node.place - s.centre, turn = cross(arm, n);
  // v of the node without contact, and 1/m + 1/M + (r x n).J^-1 (r x n).
  const double approach = dot(RigidVelocity{s.velocity, s.spin}.at(arm) - node.velocity, n);
  const double p = approach / (1 / node.mass + 1 / s.mass + dot(turn, spin_of(s.inertia, turn)));
  int trials = 0;
  const RigidVelocity q = solve(s, {node}, trials);
  CHECK(trials <= 3);
  const Vec3<double> velocity = s.velocity - (p / s.mass) * n, spin = s.spin - p * spin_of(s.inertia, turn);
  for (int a = 0; a < 3; ++a) {
    CHECK(q.velocity[a] == Approx(velocity[a]).epsilon(1e-12));
    CHECK(q.spin[a] == Approx(spin[a]).epsilon(1e-12));
  }
  CHECK(impulse_at(s, q, node) == Approx(p).epsilon(1e-12));
}

TEST_CASE("of several nodes those press that the body's motion leaves approaching") {
  RigidState s = body();
  s.velocity = {0, 0, -1};
  // The first one, heavy and far from the centre, turns the body so that the last one parts.
  const std::vector<Struck> nodes = {{{2, 2, 2.5}, {0, 0, -1}, 50, {0, 0, 0}},
                                     {{1.2, 2.4, 2.5}, {0, 0, -1}, 0.5, {0, 0, 0}},
                                     {{-1.5, 2, 2.5}, {0, 0, -1}, 0.1, {0, 0, -1.05}},
                                     {{1, 1, 3.5}, {0, 0, 1}, 5, {0, 0, -0.2}}};
  int trials = 0;
  const RigidVelocity q = solve(s, nodes, trials);
  CHECK(trials <= 8);
  Vec3<double> momentum = s.mass * s.velocity, angular = s.inertia * s.spin;
  int pressing = 0;
  for (const Struck& node : nodes) {
    const double p = impulse_at(s, q, node);
    pressing += p > 0;
    momentum = momentum - p * node.normal;
    angular = angular - p * cross(node.place - s.centre, node.normal);
  }
  CHECK(pressing > 0);
  CHECK(pressing < 4);
  for (int a = 0; a < 3; ++a) {
    CHECK(s.mass * q.velocity[a] == Approx(momentum[a]).margin(1e-12));
    CHECK((s.inertia * q.spin)[a] == Approx(angular[a]).margin(1e-12));
  }
}

TEST_CASE("a body that symmetry planes cut moves along them") {
  RigidState s = body();
  s.velocity = {0, 1, -1};
  s.cut = {1, 0, 0};
  int trials = 0;
  const RigidVelocity q = solve(s, {{{1.5, 2.7, 2}, {0.6, 0, -0.8}, 2, {}}}, trials);
  CHECK(q.velocity.x == 0);
  CHECK(q.velocity.z > -1);
  CHECK(q.spin.x != 0);
  CHECK(q.spin.y == 0);
  CHECK(q.spin.z == 0);
}

TEST_CASE("particles on one line do not turn") {
  RigidState s = body();
  s.inertia = {0, 1, 1, 0, 0, 0};
  s.velocity = {0, 0, -1};
  int trials = 0;
  const RigidVelocity q = solve(s, {{{2, 2, 2}, {0, 0, -1}, 1, {}}}, trials);
  CHECK(q.spin == Vec3<double>{});
  CHECK(q.velocity.z == Approx(-0.75));
}
