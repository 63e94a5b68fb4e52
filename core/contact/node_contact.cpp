#include "core/contact/node_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace mpm::core {

namespace {

constexpr int most_sweeps = 200;
constexpr double rest = 1e-13;  // of the largest speed

/// The part of `p` along `n` is made not negative, the rest at most `friction` times as long.
Vec3<double> within_cone(const Vec3<double>& p, const ContactPair& pair) {
  if (pair.holds == ContactPair::Holds::all) return p;
  const Vec3<double>& n = pair.normal;
  const double friction = pair.friction, pressing = std::max(dot(p, n), 0.0);
  const double along = pair.holds == ContactPair::Holds::normal ? dot(p, n) : pressing;
  const Vec3<double> tangential = p - dot(p, n) * n;
  const double length = std::sqrt(dot(tangential, tangential)), most = friction * pressing;
  return along * n + (length > most ? most / length : 1.0) * tangential;
}

/// Adds to the impulse of a pair what stops the approach of its fields, of which it has so many parts;
/// returns what is new.
Vec3<double> stop(ContactPair& pair, const ContactField& a, const ContactField& b, double parts_a,
                  double parts_b) {
  const double mass = 1 / (parts_a / a.mass + parts_b / b.mass);
  const Vec3<double> approach = a.velocity - b.velocity, before = pair.impulse;
  pair.impulse = within_cone(before + mass * approach, pair);
  return pair.impulse - before;
}

/// One pair alone, at once, without the lists of the first sweep, and to its last bit.
void resolve_contact(std::span<ContactField> fields, ContactPair& pair) {
  ContactField &a = fields[static_cast<std::size_t>(pair.first)],
               &b = fields[static_cast<std::size_t>(pair.second)];
  pair.impulse = {};
  const Vec3<double> none{}, impulse = stop(pair, a, b, 1, 1);
  const Vec3<double> of_a = none - (1 / a.mass) * impulse, of_b = none + (1 / b.mass) * impulse;
  a.velocity = a.velocity + of_a;
  b.velocity = b.velocity + of_b;
}

}  // namespace

void resolve_contacts(std::span<ContactField> fields, std::span<ContactPair> pairs) {
  if (pairs.size() == 1) return resolve_contact(fields, pairs[0]);
  const auto field = [&](int f) -> ContactField& { return fields[static_cast<std::size_t>(f)]; };
  std::vector<double> parts(fields.size(), 0.0);
  double fastest = 0;
  for (ContactPair& pair : pairs) {
    pair.impulse = {};
    for (const int f : {pair.first, pair.second}) {
      parts[static_cast<std::size_t>(f)] += 1;
      fastest = std::max(fastest, std::sqrt(dot(field(f).velocity, field(f).velocity)));
    }
  }
  std::vector<Vec3<double>> change(fields.size());
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    std::fill(change.begin(), change.end(), Vec3<double>{});
    for (ContactPair& pair : pairs) {
      const auto a = static_cast<std::size_t>(pair.first), b = static_cast<std::size_t>(pair.second);
      const Vec3<double> more = stop(pair, fields[a], fields[b], parts[a], parts[b]);
      change[a] = change[a] - (1 / fields[a].mass) * more;
      change[b] = change[b] + (1 / fields[b].mass) * more;
    }
    double largest = 0;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      fields[f].velocity = fields[f].velocity + change[f];
      largest = std::max(largest, std::sqrt(dot(change[f], change[f])));
    }
    if (!(largest > rest * fastest)) return;
  }
}

namespace {

/// A vector's part along a normal, and that across it.
struct Parts {
  double along = 0;
  Vec3<double> across{};
  double length_across = 0;
};
Parts parts_of(const Vec3<double>& v, const Vec3<double>& normal) {
  const double along = dot(v, normal);
  const Vec3<double> across = v - along * normal;
  return {along, across, std::sqrt(dot(across, across))};
}

Mat3<double> product(const Vec3<double>& a, const Vec3<double>& b) {
  return {a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y, a.z * b.z};
}
/// along n n^T + across (1 - n n^T)
Mat3<double> about(const Vec3<double>& n, double along, double across) {
  return (along - across) * product(n, n) + Mat3<double>{across, 0, 0, 0, across, 0, 0, 0, across};
}

}  // namespace

Mat3<double> impulse_derivative(const ContactPair& pair, const Vec3<double>& approach, double mass) {
  const Parts u = parts_of(approach, pair.normal);
  const double most = pair.friction * mass * std::max(u.along, 0.0);
  const bool sticks = pair.friction > 0 && mass * u.length_across <= most;
  if (pair.holds == ContactPair::Holds::all || sticks) return about(pair.normal, mass, mass);
  if (!(most > 0)) return about(pair.normal, mass, 0);
  const Vec3<double> t = (1 / u.length_across) * u.across;
  const double turns = most / u.length_across;
  return about(pair.normal, mass, turns) - turns * product(t, t) +
         (pair.friction * mass) * product(t, pair.normal);
}

Mat3<double> impulse_secant(const ContactPair& pair, const Vec3<double>& approach, double mass) {
  const Parts u = parts_of(approach, pair.normal), p = parts_of(pair.impulse, pair.normal);
  const double across = u.length_across > 0 ? std::min(mass, p.length_across / u.length_across) : 0;
  return about(pair.normal, mass, across);
}

std::optional<Vec3<double>> contact_normal(const ContactSurface& first, const ContactSurface& second) {
  const auto direction = [](double sign, const ContactSurface& s) -> std::optional<Vec3<double>> {
    const double length = std::sqrt(dot(s.mass_gradient, s.mass_gradient));
    if (!has_direction(s)) return std::nullopt;
    return sign / length * s.mass_gradient;
  };
  const auto a = direction(1, first), b = direction(-1, second);
  if (!a || !b) return a ? a : b;
  if (const ContactSurface* s = deciding(first, second)) return s == &first ? a : b;
  const Vec3<double> sum = *a + *b;
  const double length = std::sqrt(dot(sum, sum));
  if (!(length >= least_slope)) return std::nullopt;
  return (1 / length) * sum;
}

}  // namespace mpm::core
