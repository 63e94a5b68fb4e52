// The spring between two bodies at a place: its force and the derivative of it, and its friction.
#include "core/implicit/contact_spring.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

using namespace mpm::core;

namespace {

constexpr double k = 200;
constexpr double rounding = 1e-12;  // of forces of order 10

const std::vector<Vec3<double>> normals{{1, 0, 0},
                                        {0, 0, -1},
                                        {0.6, -0.8, 0},
                                        {2.0 / 3, -1.0 / 3, 2.0 / 3},
                                        {std::sqrt(1.0 / 3), std::sqrt(1.0 / 3), std::sqrt(1.0 / 3)}};

double length(const Vec3<double>& a) { return std::sqrt(dot(a, a)); }

Vec3<double> product(const Mat3<double>& m, const Vec3<double>& a) {
  return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.yx * a.x + m.yy * a.y + m.yz * a.z,
          m.zx * a.x + m.zy * a.y + m.zz * a.z};
}

/// Largest difference of two matrices, by what they make of the axes.
double difference(const Mat3<double>& a, const Mat3<double>& b) {
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3<double> e{};
    e[axis] = 1;
    largest = std::max(largest, length(product(a - b, e)));
  }
  return largest;
}

ContactSpring spring_along(const Vec3<double>& normal) {
  ContactSpring spring;
  spring.normal = normal;
  spring.k = k;
  return spring;
}

/// A spring that is pressed or parted, slides, sticks or is tied, and a displacement that makes it so.
struct Case {
  std::string name;
  ContactSpring spring;
  Vec3<double> d;
  double pressure;
};

/// With and without a force that goes on from the last step.
std::vector<Case> cases(const Vec3<double>& n) {
  const Vec3<double> along = across({0.3, 0.5, -0.7}, n);
  std::vector<Case> all;
  for (const bool goes_on : {false, true})
    for (const double parted : {-0.01, 0.02})  // in the second they part, or are drawn where they are tied
      for (const std::string kind : {"slides", "sticks", "is tied"}) {
        ContactSpring spring = spring_along(n);
        spring.sticks = kind == "sticks";
        spring.tied = kind == "is tied";
        const Vec3<double> d = parted * n + 0.03 * along;
        if (goes_on) {
          spring.first = 1.5;
          spring.friction = 0.4 * cross(n, along);
          spring.gap = 0.002 * n - 0.001 * along;
        }
        const double pressing = spring.first - k * (parted + dot(spring.gap, n));
        all.push_back({kind + (parted < 0 ? ", pressed" : ", parted") + (goes_on ? ", goes on" : ""), spring,
                       d, spring.tied ? pressing : std::max(0.0, pressing)});
      }
  return all;
}

/// Solves `times` times, and finds the same displacement.
ContactSpring::Changes solve(ContactSpring& spring, const Vec3<double>& d, int times = 1,
                             double relaxation = 1) {
  ContactSpring::Changes changes;
  for (int i = 0; i < times; ++i) {
    changes = {};
    spring.find_friction(d, relaxation, true, changes);
  }
  return changes;
}

/// Along z, with a bound of friction of 1 where a displacement presses by 0.01.
ContactSpring rough_spring() {
  ContactSpring spring = spring_along({0, 0, 1});
  spring.coefficient = 0.5;
  spring.cell_stiffness = 2;
  spring.sticks = true;
  return spring;
}

}  // namespace

TEST_CASE("A spring presses and does not draw, and holds what sticks or is tied", "[implicit]") {
  for (const Vec3<double>& n : normals) {
    const Vec3<double> along = across({0.3, 0.5, -0.7}, n), pressed = -0.01 * n + 0.03 * along,
                       parted = 0.01 * n + 0.03 * along;
    ContactSpring spring = spring_along(n);
    CHECK(length(spring.response(pressed).force - 2.0 * n) < rounding);
    CHECK(spring.response(pressed).pressure == Approx(2));
    CHECK(spring.response(parted).force == Vec3<double>{});
    CHECK(spring.response(parted).pressure == 0);
    CHECK(difference(spring.response(parted).stiffness, {}) == 0);
    spring.sticks = true;
    CHECK(length(spring.response(pressed).force - (2.0 * n - 6.0 * along)) < rounding);
    spring.tied = true;
    CHECK(length(spring.response(pressed).force - (2.0 * n - 6.0 * along)) < rounding);
    CHECK(length(spring.response(parted).force - (-2.0 * n - 6.0 * along)) < rounding);
    CHECK(spring.response(parted).pressure == Approx(-2));
  }
}

TEST_CASE("A spring answers from the force and the gap at the start of the step", "[implicit]") {
  for (const Vec3<double>& n : normals)
    for (const Case& c : cases(n)) {
      INFO(c.name);
      const ContactSpring::Response found = c.spring.response(c.d);
      CHECK(found.pressure == Approx(c.pressure).margin(rounding));
      Vec3<double> expected = c.pressure * n - c.spring.friction;
      if (c.spring.sticks || c.spring.tied) expected = expected - k * across(c.d + c.spring.gap, n);
      CHECK(length(found.force - expected) < rounding);
    }
  // Where nothing has moved they press already: a body that contact alone holds is held from the start.
  const ContactSpring at_rest = spring_along({0, 0, 1});
  CHECK(at_rest.response({}).force == Vec3<double>{});
  CHECK(difference(at_rest.response({}).stiffness, {0, 0, 0, 0, 0, 0, 0, 0, k}) == 0);
}

TEST_CASE("The stiffness of a spring is minus the derivative of its force", "[implicit]") {
  constexpr double step = 1e-3;  // forces are linear on either side of contact: any step that stays there
  for (const Vec3<double>& n : normals)
    for (const Case& c : cases(n)) {
      INFO(c.name);
      const Mat3<double> stiffness = c.spring.response(c.d).stiffness;
      for (int axis = 0; axis < 3; ++axis) {
        Vec3<double> e{};
        e[axis] = 1;
        const Vec3<double> slope = (0.5 / step) * (c.spring.response(c.d + step * e).force -
                                                   c.spring.response(c.d - step * e).force);
        CHECK(length(product(stiffness, e) + slope) < rounding / step);
      }
    }
}

TEST_CASE("The directions of a spring are orthonormal and make up its stiffness", "[implicit]") {
  for (const Vec3<double>& n : normals)
    for (const Case& c : cases(n)) {
      INFO(c.name);
      std::vector<Vec3<double>> directions;
      c.spring.for_each_direction(c.d, [&](const Vec3<double>& e) { directions.push_back(e); });
      const bool pressed = c.spring.tied || c.pressure > 0, holds = c.spring.tied || c.spring.sticks;
      CHECK(directions.size() == (pressed ? 1U : 0U) + (holds ? 2U : 0U));
      Mat3<double> sum{};
      for (std::size_t i = 0; i < directions.size(); ++i) {
        const Vec3<double>& e = directions[i];
        const bool is_normal = pressed && i == 0;
        CHECK(std::abs(dot(e, n) - (is_normal ? 1 : 0)) < rounding);
        for (std::size_t j = 0; j <= i; ++j)
          CHECK(std::abs(dot(e, directions[j]) - (i == j ? 1 : 0)) < rounding);
        sum = sum + Mat3<double>{k * e.x * e.x, k * e.x * e.y, k * e.x * e.z, k * e.y * e.x, k * e.y * e.y,
                                 k * e.y * e.z, k * e.z * e.x, k * e.z * e.y, k * e.z * e.z};
      }
      CHECK(difference(sum, c.spring.response(c.d).stiffness) < k * rounding);
    }
}

TEST_CASE("A force that is taken is what the spring exerts where nothing is left of the displacement",
          "[implicit]") {
  for (const Vec3<double>& n : normals)
    for (const Case& c : cases(n)) {
      INFO(c.name);
      const ContactSpring::Response before = c.spring.response(c.d);
      ContactSpring taken = c.spring;
      taken.take_force(c.d);
      CHECK(taken.gap == c.spring.gap);
      CHECK(length(taken.response(-1.0 * taken.gap).force - before.force) < rounding);
      // Solved again with the same displacement, it exerts the force of what it holds once more.
      const Vec3<double> further = before.force - product(before.stiffness, c.d + c.spring.gap);
      CHECK(length(taken.response(c.d).force - further) < rounding);
    }
}

TEST_CASE("A spring that has parted keeps no pressure, and one that is tied keeps its tension",
          "[implicit]") {
  const Vec3<double> parted{0, 0, 0.02};
  ContactSpring spring = spring_along({0, 0, 1});
  spring.first = 1.5;
  spring.take_force(parted);
  CHECK(spring.first == 0);
  spring.tied = true;
  spring.take_force(parted);
  CHECK(spring.first == Approx(-4));
  spring.take_force(parted);
  CHECK(spring.first == Approx(-8));
}

TEST_CASE("What is held of a displacement is what the spring resists", "[implicit]") {
  for (const Vec3<double>& n : normals)
    for (const Case& c : cases(n)) {
      INFO(c.name);
      const Vec3<double> resisted = (1 / k) * product(c.spring.response(c.d).stiffness, c.d + c.spring.gap);
      CHECK(length(c.spring.held(c.d) - resisted) < rounding);
    }
}

TEST_CASE("A place sticks up to its bound of friction and slides beyond it", "[implicit]") {
  ContactSpring spring = rough_spring();
  ContactSpring::Changes changes = solve(spring, {0.003, 0, -0.01});  // 0.6 of the bound
  CHECK(spring.sticks);
  CHECK(changes.change.value() == 0);
  CHECK(changes.most.value() == Approx(1));
  // It goes on from the friction that was taken before: 0.6 + 0.6.
  ContactSpring taken = spring;
  taken.take_force({0.003, 0, -0.01});
  solve(taken, {0.003, 0, 0});
  CHECK_FALSE(taken.sticks);

  const Vec3<double> far{0.03, 0.04, -0.01};
  changes = solve(spring, far);
  CHECK_FALSE(spring.sticks);
  CHECK(length(spring.friction - Vec3<double>{0.6, 0.8, 0}) < rounding);
  CHECK(length(spring.response(far).force - Vec3<double>{-0.6, -0.8, 2}) < rounding);
  CHECK(changes.change.value() == Approx(9));  // from 10 where it stuck
  changes = solve(spring, far);
  CHECK(length(spring.friction - Vec3<double>{0.6, 0.8, 0}) < rounding);
  CHECK(changes.change.value() == Approx(0).margin(rounding));

  // Only places that count are in the sums.
  ContactSpring elsewhere = rough_spring();
  changes = {};
  elsewhere.find_friction(far, 1, false, changes);
  CHECK(length(elsewhere.friction - Vec3<double>{0.6, 0.8, 0}) < rounding);
  CHECK(changes.change.value() == 0);
  CHECK(changes.most.value() == 0);
}

TEST_CASE("Friction of a place that slides follows its slip and its pressure", "[implicit]") {
  ContactSpring spring = rough_spring();
  solve(spring, {0.03, 0.04, -0.01});
  solve(spring, {0.05, 0, -0.01}, 60, 10);  // each adds a bound along x: the rest along y halves at least
  CHECK_FALSE(spring.sticks);
  CHECK(length(spring.friction - Vec3<double>{1, 0, 0}) < rounding);
  solve(spring, {0.05, 0, -0.03}, 60, 10);  // the mean of pressures halves its difference too
  CHECK(length(spring.friction - Vec3<double>{3, 0, 0}) < rounding);
  solve(spring, {0.05, 0, 0.01}, 60, 10);
  CHECK(length(spring.response({0.05, 0, 0.01}).force) < rounding);

  // Below its bound friction grows with the slip: by 0.3 of a cell's stiffness, 2, times 0.05.
  ContactSpring grows = rough_spring();
  grows.sticks = false;
  solve(grows, {0.05, 0, -0.01}, 4, 0.3);
  CHECK(length(grows.friction - Vec3<double>{4 * 0.03, 0, 0}) < rounding);
}

TEST_CASE("A place that sticks and parts has no force after the next solution", "[implicit]") {
  ContactSpring spring = rough_spring();
  const Vec3<double> parted{0.003, 0, 0.01};
  solve(spring, parted);
  CHECK_FALSE(spring.sticks);
  CHECK(spring.response(parted).force == Vec3<double>{});
}

TEST_CASE("A place that slides sticks once its slip turns round, a few times in a step", "[implicit]") {
  const Vec3<double> forth{0.03, 0.04, -0.01}, back{-0.003, 0.001, -0.01};
  ContactSpring spring = rough_spring();
  solve(spring, forth);
  REQUIRE_FALSE(spring.sticks);
  solve(spring, back);
  CHECK(spring.sticks);
  CHECK(spring.friction == Vec3<double>{});
  CHECK(length(spring.response(back).force - Vec3<double>{0.6, -0.2, 2}) < rounding);
  solve(spring, back);
  CHECK(spring.sticks);

  int sticking = 0;
  for (int i = 0; i < 20; ++i) {
    solve(spring, forth);
    solve(spring, back);
    sticking += spring.sticks ? 1 : 0;
  }
  CHECK(sticking > 0);
  CHECK(sticking < 4);
  CHECK_FALSE(spring.sticks);
  // It goes on sliding as little as it may: friction falls against the slip, from its bound on.
  solve(spring, forth);
  const double before = dot(spring.friction, back);
  solve(spring, back);
  CHECK_FALSE(spring.sticks);
  CHECK(dot(spring.friction, back) > before);
  CHECK(dot(spring.friction, back) < 0);
}

TEST_CASE("The bound of friction settles where the pressure goes to and fro", "[implicit]") {
  ContactSpring spring = rough_spring();
  const Vec3<double> low{0.05, 0, -0.01}, high{0.05, 0, -0.02};
  for (int i = 0; i < 5; ++i) {
    solve(spring, low);
    CHECK(spring.pressure == Approx(2));
    solve(spring, high);
    CHECK(spring.pressure == Approx(4));
  }
  solve(spring, low);
  const double before = spring.pressure;
  solve(spring, high);
  CHECK(std::abs(spring.pressure - before) <= 1);
}

TEST_CASE("Without friction, and where bodies are tied, solutions change nothing", "[implicit]") {
  const Vec3<double> d{0.05, 0, -0.01};
  ContactSpring smooth = rough_spring(), tied = rough_spring();
  smooth.coefficient = 0;
  smooth.sticks = false;
  tied.tied = true;
  for (ContactSpring* spring : {&smooth, &tied}) {
    const Vec3<double> force = spring->response(d).force;
    const ContactSpring::Changes changes = solve(*spring, d);
    CHECK(spring->response(d).force == force);
    CHECK(changes.change.value() == 0);
    CHECK(changes.most.value() == 0);
  }
}
