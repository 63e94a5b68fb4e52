// A free rigid body against bodies of prescribed motion: slides, sticks, turns and is pressed.
#include "core/contact/rigid_contact.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

using namespace mpm::core;

namespace {

/// A cube with edge 2 about the origin, of mass 3.
RigidState cube() {
  RigidState s;
  s.mass = 3;
  s.inertia = {2, 2, 2, 0, 0, 0};
  return s;
}

/// Under the cube.
std::vector<RigidContact> floor_below(double friction) {
  std::vector<RigidContact> contacts;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      contacts.push_back(
          {.node = 5 * i + j, .place = {0.5 * i, 0.5 * j, -1}, .normal = {0, 0, 1}, .friction = friction});
  return contacts;
}

bool resolve(const RigidState& s, RigidVelocity& q, std::vector<RigidContact>& contacts) {
  const std::array<double, RigidResponse::size> none{};
  return resolve_rigid_contacts(s, RigidResistance(s, none), q, contacts);
}

}  // namespace

TEST_CASE("a cube slides on a floor without friction and is slowed by Coulomb's with it") {
  for (const double friction : {0.0, 0.2}) {
    RigidVelocity q{{3, 0, -0.1}, {}};
    std::vector<RigidContact> contacts = floor_below(friction);
    REQUIRE(resolve(cube(), q, contacts));
    CHECK(q.velocity.x == Approx(3 - friction * 0.1).epsilon(1e-12));
    CHECK(q.velocity.z == Approx(0).margin(1e-13));
    for (int a = 0; a < 3; ++a) CHECK(q.spin[a] == Approx(0).margin(1e-13));
    double pressing = 0;
    for (const RigidContact& contact : contacts) pressing += contact.impulse.z;
    CHECK(pressing == Approx(0.3));
  }
}

TEST_CASE("a cube that is pushed less than friction holds stays") {
  RigidVelocity q{{0.01, 0, -0.1}, {}};
  std::vector<RigidContact> contacts = floor_below(0.2);
  REQUIRE(resolve(cube(), q, contacts));
  for (int a = 0; a < 3; ++a) {
    CHECK(q.velocity[a] == Approx(0).margin(1e-12));
    CHECK(q.spin[a] == Approx(0).margin(1e-12));
  }
}

TEST_CASE("an edge that strikes turns the cube, without a gain of energy") {
  const RigidState s = cube();
  RigidVelocity q{{0, 0, -1}, {}};
  std::vector<RigidContact> contacts;
  for (const RigidContact& contact : floor_below(0))
    if (contact.place.x == 1) contacts.push_back(contact);
  REQUIRE(resolve(s, q, contacts));
  // One effective mass at the edge: 1/(1/M + 1/I).
  const double p = 1 / (1 / s.mass + 1 / s.inertia.yy);
  CHECK(q.velocity.z == Approx(-1 + p / s.mass));
  CHECK(q.spin.y == Approx(-p / s.inertia.yy));
  CHECK(q.velocity.z - q.spin.y == Approx(0).margin(1e-12));
}

TEST_CASE("a cube between a floor and a lid that comes down cannot be held") {
  std::vector<RigidContact> contacts = floor_below(0);
  for (RigidContact contact : floor_below(0)) {
    contact.place.z = 1, contact.normal.z = -1, contact.velocity.z = -0.5;
    contacts.push_back(contact);
  }
  RigidVelocity q{};
  CHECK(!resolve(cube(), q, contacts));
}
