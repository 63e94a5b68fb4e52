// Contact at a node: two fields against the closed formulas, more of them against what any law of contact
// must fulfil.
#include "core/contact/node_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

using namespace mpm::core;

namespace {

using Vector = Vec3<double>;

double length(const Vector& a) { return std::sqrt(dot(a, a)); }
Vector unit(const Vector& a) { return (1 / length(a)) * a; }

Vector momentum(const std::vector<ContactField>& fields) {
  Vector sum{};
  for (const ContactField& f : fields) sum = sum + f.mass * f.velocity;
  return sum;
}
double energy(const std::vector<ContactField>& fields) {
  double sum = 0;
  for (const ContactField& f : fields) sum += 0.5 * f.mass * dot(f.velocity, f.velocity);
  return sum;
}

struct Two {
  std::vector<ContactField> fields{{2, {1, -0.3, 0.8}}, {5, {-0.4, 0.2, 0.1}}};
  std::vector<ContactPair> pairs{{0, 1, unit({2, 1, -1}), 0}};
  Vector approach() const { return fields[0].velocity - fields[1].velocity; }
};

}  // namespace

TEST_CASE("Contact of two fields: they part freely, stop along the normal, and keep their momentum") {
  Two free;
  free.pairs[0].normal = -1.0 * free.pairs[0].normal;
  const std::vector<ContactField> before = free.fields;
  resolve_contacts(free.fields, free.pairs);
  CHECK(free.pairs[0].impulse == Vector{});
  for (std::size_t f = 0; f < 2; ++f) CHECK(free.fields[f].velocity == before[f].velocity);

  Two smooth;
  const Vector n = smooth.pairs[0].normal, u = smooth.approach(), p = momentum(smooth.fields);
  REQUIRE(dot(u, n) > 0);
  resolve_contacts(smooth.fields, smooth.pairs);
  CHECK(std::abs(dot(smooth.approach(), n)) < 1e-15);
  CHECK(length(smooth.approach() - (u - dot(u, n) * n)) < 1e-15);  // nothing along the surface
  CHECK(length(momentum(smooth.fields) - p) < 1e-15);
  CHECK(length(smooth.pairs[0].impulse - (10.0 / 7 * dot(u, n)) * n) < 1e-15);
}

TEST_CASE("Contact of two fields that hold: nothing parts them") {
  for (const double sign : {1.0, -1.0}) {
    Two held;
    held.pairs[0].normal = sign * held.pairs[0].normal;
    const Vector n = held.pairs[0].normal, u = held.approach(), p = momentum(held.fields);
    held.pairs[0].holds = ContactPair::Holds::normal;
    resolve_contacts(held.fields, held.pairs);
    CHECK(std::abs(dot(held.approach(), n)) < 1e-15);
    CHECK(length(held.approach() - (u - dot(u, n) * n)) < 1e-15);
    CHECK(length(momentum(held.fields) - p) < 1e-15);

    Two stuck;
    stuck.pairs[0].normal = n;
    stuck.pairs[0].holds = ContactPair::Holds::all;
    resolve_contacts(stuck.fields, stuck.pairs);
    CHECK(length(stuck.approach()) < 1e-15);
    CHECK(length(momentum(stuck.fields) - p) < 1e-15);
  }
}

TEST_CASE("Contact of two fields: Coulomb's friction, off all axes") {
  Two at;
  const Vector n = at.pairs[0].normal, u = at.approach(), along = dot(u, n) * n, across = u - along;
  const double limit = length(across) / length(along);
  for (const double friction : {0.5 * limit, 2 * limit}) {
    Two two;
    two.pairs[0].friction = friction;
    const Vector p = momentum(two.fields);
    const double e = energy(two.fields);
    resolve_contacts(two.fields, two.pairs);
    const Vector left = friction > limit ? Vector{} : across - (friction * length(along)) * unit(across);
    CHECK(length(two.approach() - left) < 1e-15);
    CHECK(length(momentum(two.fields) - p) < 1e-15);
    CHECK(energy(two.fields) < e);
  }
}

TEST_CASE("Contact of three blocks at a corner does not depend on the order of the blocks") {
  const std::vector<ContactField> blocks{{1, {1, 0.2, 0}}, {3, {-0.5, 0, 0.4}}, {0.2, {0, -2, 0.3}}};
  const std::vector<ContactPair> touching{
      {0, 1, {1, 0, 0}, 0.3}, {0, 2, {0, 1, 0}, 0.1}, {1, 2, {0, 1, 0}, 0.6}};
  std::vector<int> order{0, 1, 2}, pairs{0, 1, 2};
  std::vector<Vector> first;
  do {
    do {
      std::vector<ContactField> fields(3);
      for (int f = 0; f < 3; ++f)
        fields[static_cast<std::size_t>(order[static_cast<std::size_t>(f)])] =
            blocks[static_cast<std::size_t>(f)];
      std::vector<ContactPair> contacts;
      for (const int p : pairs) {
        ContactPair pair = touching[static_cast<std::size_t>(p)];
        pair.first = order[static_cast<std::size_t>(pair.first)];
        pair.second = order[static_cast<std::size_t>(pair.second)];
        if (pair.first > pair.second) {
          std::swap(pair.first, pair.second);
          pair.normal = -1.0 * pair.normal;
        }
        contacts.push_back(pair);
      }
      const Vector p = momentum(fields);
      resolve_contacts(fields, contacts);
      CHECK(length(momentum(fields) - p) < 1e-14);
      std::vector<Vector> velocities;
      for (int f = 0; f < 3; ++f)
        velocities.push_back(fields[static_cast<std::size_t>(order[static_cast<std::size_t>(f)])].velocity);
      if (first.empty()) first = velocities;
      for (std::size_t f = 0; f < 3; ++f) CHECK(length(velocities[f] - first[f]) < 1e-12);
    } while (std::next_permutation(pairs.begin(), pairs.end()));
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST_CASE("Contact of many fields: no approach, no pull, friction within its cone, energy does not grow") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> real(-1, 1);
  const auto vector = [&] { return Vector{real(random), real(random), real(random)}; };
  for (int trial = 0; trial < 200; ++trial) {
    const int count = 3 + trial % 3;
    std::vector<ContactField> fields;
    for (int f = 0; f < count; ++f) fields.push_back({std::exp(2 * real(random)), vector()});
    // Bodies around a point, as at a node: normals between their centres.
    std::vector<Vector> centres;
    for (int f = 0; f < count; ++f) centres.push_back(unit(vector()));
    std::vector<ContactPair> pairs;
    for (int a = 0; a < count; ++a)
      for (int b = a + 1; b < count; ++b)
        pairs.push_back(
            {a, b, unit(centres[static_cast<std::size_t>(b)] - centres[static_cast<std::size_t>(a)]), 0});
    const Vector p = momentum(fields);
    const double e = energy(fields);
    resolve_contacts(fields, pairs);
    CHECK(length(momentum(fields) - p) < 1e-12);
    CHECK(energy(fields) < e * (1 + 1e-12));
    for (const ContactPair& pair : pairs) {
      const Vector u = fields[static_cast<std::size_t>(pair.first)].velocity -
                       fields[static_cast<std::size_t>(pair.second)].velocity;
      CHECK(dot(u, pair.normal) < 1e-3);  // as many sweeps as there are come this near
      CHECK(dot(pair.impulse, pair.normal) >= 0);
    }
  }
}

TEST_CASE("Normals of contact: the larger weight's, the mean of equal ones, and always opposite") {
  const ContactSurface flat{{0, 0, 3}, 1}, tilted{{0.2, -0.1, -2}, 1};
  const Vector n = contact_normal(flat, tilted).value(), back = contact_normal(tilted, flat).value();
  CHECK(n == -1.0 * back);
  CHECK(length(n - unit(Vector{0, 0, 1} - unit(tilted.mass_gradient))) < 1e-15);
  CHECK(contact_normal({flat.mass_gradient, 2}, tilted).value() == Vector{0, 0, 1});
  CHECK(contact_normal(flat, {tilted.mass_gradient, 2}).value() == -1.0 * unit(tilted.mass_gradient));
  CHECK(contact_normal({{}, 5}, tilted).value() == -1.0 * unit(tilted.mass_gradient));
  CHECK(contact_normal({flat.mass_gradient, 2, true}, tilted).value() == -1.0 * unit(tilted.mass_gradient));
  CHECK(contact_normal({flat.mass_gradient, 2, true}, {tilted.mass_gradient, 0, true}).value() ==
        Vector{0, 0, 1});
  CHECK_FALSE(contact_normal({}, {}).has_value());
  CHECK_FALSE(contact_normal({{1, 0, 0}, 0}, {{1, 0, 0}, 0}).has_value());  // both point the same way
  CHECK_FALSE(contact_normal({{1, 0, 0}, 0}, {{1, 1e-9, 0}, 0}).has_value());
}

TEST_CASE("Normals of contact: gradients of round-off have no direction, in cells of any proportions") {
  const Vector cell{0.5, 2, 1e-3}, along{0, 0, 3};
  const auto surface = [&](const Vector& gradient, double mass, double weight) {
    return ContactSurface{gradient, weight, false, slope_of(gradient, mass, cell)};
  };
  CHECK(slope_of({0, 0, 2e3}, 1, cell) == 2);
  CHECK(slope_of({4, 0, 0}, 1, cell) == 2);
  const ContactSurface inside = surface({1e-14, 2e-15, 3e-14}, 1, 5), other = surface(along, 1e-6, 0);
  CHECK_FALSE(has_direction(inside));
  CHECK(has_direction(other));
  CHECK(has_direction(surface(along, 0, 0)));  // beyond its mass
  CHECK_FALSE(has_direction(surface({}, 0, 0)));
  CHECK(deciding(inside, other) == &inside);
  CHECK(deciding(other, inside) == &inside);
  CHECK(deciding(other, other) == nullptr);
  CHECK(contact_normal(inside, other).value() == Vector{0, 0, -1});
  CHECK(contact_normal(other, inside).value() == Vector{0, 0, 1});
  CHECK_FALSE(contact_normal(inside, inside).has_value());
}
