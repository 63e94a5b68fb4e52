// A rigid body struck at nodes: impulses by its mass and inertia together, against the closed form of one
// node and the balance of several, with friction and of a body that is light beside the nodes.
#include "core/contact/rigid_motion.hpp"

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "core/contact/node_contact.hpp"

using namespace mpm::core;

namespace {

struct Struck {
  Vec3<double> place{}, normal{};  ///< outward of the body
  double mass = 0;
  Vec3<double> velocity{};  ///< of what strikes, without contact
  double friction = 0;
};

RigidState body() {
  RigidState s;
  s.mass = 3;
  s.centre = {1, 2, 3};
  s.inertia = {2.0, 1.5, 1.0, 0.2, -0.1, 0.3};
  return s;
}

/// Its contact with the body, whose motion is given.
ContactPair meet(const RigidState& s, const RigidVelocity& q, const Struck& node) {
  const double heavy = std::numeric_limits<double>::infinity();
  ContactField fields[] = {{heavy, q.at(node.place - s.centre)}, {node.mass, node.velocity}};
  ContactPair pairs[] = {{.first = 0, .second = 1, .normal = node.normal, .friction = node.friction}};
  resolve_contacts(fields, pairs);
  return pairs[0];
}

RigidVelocity solve(const RigidState& s, const std::vector<Struck>& nodes, int& trials) {
  RigidSearch search({s.velocity, s.spin});
  for (trials = 0; trials < 60 && !search.found(); ++trials) {
    RigidResponse response;
    for (const Struck& node : nodes) {
      const Vec3<double> approach = search.trial().at(node.place - s.centre) - node.velocity;
      const ContactPair pair = meet(s, search.trial(), node);
      if (pair.impulse != Vec3<double>{})
        response.add(-1.0 * pair.impulse, node.place - s.centre,
                     impulse_derivative(pair, approach, node.mass));
    }
    std::array<double, RigidResponse::size> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = response.sums[i].value();
    search.next(s, values);
  }
  return search.trial();
}

/// The body's momentum is that of its free motion and of the impulses; how many nodes press.
int require_balance(const RigidState& s, const RigidVelocity& q, const std::vector<Struck>& nodes) {
  Vec3<double> momentum = s.mass * s.velocity, angular = s.inertia * s.spin;
  int pressing = 0;
  for (const Struck& node : nodes) {
    const Vec3<double> p = meet(s, q, node).impulse;
    pressing += p != Vec3<double>{};
    momentum = momentum - p;
    angular = angular - cross(node.place - s.centre, p);
  }
  for (int a = 0; a < 3; ++a) {
    REQUIRE(s.mass * q.velocity[a] == Approx(momentum[a]).margin(1e-12));
    REQUIRE((s.inertia * q.spin)[a] == Approx(angular[a]).margin(1e-12));
  }
  return pressing;
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
  CHECK(dot(meet(s, q, node).impulse, n) == Approx(p).epsilon(1e-12));
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
  const int pressing = require_balance(s, q, nodes);
  CHECK(pressing > 0);
  CHECK(pressing < 4);
}

TEST_CASE("friction on a body of which the nodes have many times the mass") {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (const double mass : {10.0, 1.0, 0.1, 0.01}) {
    for (const double friction : {0.1, 0.3, 0.6, 1.0}) {
      int most = 0;
      for (int scene = 0; scene < 20; ++scene) {
        RigidState s;
        s.mass = mass;
        s.centre = {0.2, 0.2, 0.1};
        s.inertia = {0.02 * mass, 0.02 * mass, 0.03 * mass, 0, 0, 0};
        s.velocity = {between(0, 0.5), between(-0.1, 0.1), between(-0.05, 0)};
        s.spin = {between(-0.1, 0.1), between(-0.1, 0.1), between(-0.1, 0.1)};
        std::vector<Struck> nodes;
        for (int i = 0; i < 25; ++i) {
          const Vec3<double> v{between(-0.03, 0.03), between(-0.03, 0.03), between(-0.03, 0.03)};
          const double size = between(0.2, 1);
          nodes.push_back({{0.1 * (i % 5), 0.1 * static_cast<double>(i / 5), 0},
                           {0, 0, -1},
                           size * size / 2,
                           v,
                           friction});
        }
        int trials = 0;
        const RigidVelocity q = solve(s, nodes, trials);
        REQUIRE(trials < 60);
        most = std::max(most, trials);
        require_balance(s, q, nodes);
      }
      CHECK(most <= (mass >= 1 ? 8 : 40));
    }
  }
}

TEST_CASE("the derivative of a pair's impulse") {
  const ContactPair pair{.first = 0, .second = 1, .normal = Vec3<double>{0.48, 0.6, 0.64}, .friction = 0.4};
  constexpr double mass = 0.7, step = 1e-6, heavy = std::numeric_limits<double>::infinity();
  const auto impulse = [&](const Vec3<double>& u) {
    ContactField fields[] = {{heavy, u}, {mass, {}}};
    ContactPair pairs[] = {pair};
    resolve_contacts(fields, pairs);
    return pairs[0].impulse;
  };
  // It slides, and it sticks.
  for (const Vec3<double>& u : {Vec3<double>{3, 1, -0.5}, Vec3<double>{0.5, 0.7, 0.6}}) {
    const Mat3<double> d = impulse_derivative(pair, u, mass);
    const double columns[3][3] = {{d.xx, d.yx, d.zx}, {d.xy, d.yy, d.zy}, {d.xz, d.yz, d.zz}};
    for (int a = 0; a < 3; ++a) {
      Vec3<double> e{};
      e[a] = step;
      const Vec3<double> seen = (0.5 / step) * (impulse(u + e) - impulse(u - e));
      for (int i = 0; i < 3; ++i) CHECK(columns[a][i] == Approx(seen[i]).margin(1e-8));
    }
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
