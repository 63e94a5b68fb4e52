#include "core/contact/rigid_contact.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace mpm::core {

namespace {

constexpr int even_sweeps = 20, fewest_sweeps = 200, most_sweeps = 4000;
constexpr std::size_t most_work = 2000000;  // sweeps times contacts, where there are many
constexpr double rest = 1e-14;              // of the largest relative velocity, in a sweep
constexpr double most_left = 1e-5;  // of that velocity, with which a body may still approach at the end
constexpr double most_gain = 1e-7;  // of the impulses times that velocity
constexpr double round_off = 1e-9;  // least relative velocity that counts, of that of the driven body

/// A contact with what the body answers to unit impulses along its three axes, the first of them the normal.
struct Touch {
  Vec3<double> arm{}, axis[3], velocity{};
  RigidVelocity answer[3];
  double along = 0, across = 0;  ///< velocity per impulse along the normal, the largest one across it
  double friction = 0;
  double p[3] = {};  ///< impulse along the axes

  double speed(const RigidVelocity& q, int a) const { return dot(q.at(arm) - velocity, axis[a]); }
};

/// q + factor times `by`.
void add(RigidVelocity& q, double factor, const RigidVelocity& by) {
  q.velocity = q.velocity + factor * by.velocity;
  q.spin = q.spin + factor * by.spin;
}

Touch touch_of(const RigidState& s, const RigidResistance& resistance, const RigidContact& contact) {
  Touch t;
  t.arm = contact.place - s.centre;
  t.velocity = contact.velocity;
  t.friction = contact.friction;
  const Vec3<double>& n = t.axis[0] = contact.normal;
  // The second axis: across the one to which the normal is the least aligned.
  const Vec3<double> size{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
  Vec3<double> least{};
  least[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1;
  const Vec3<double> across = cross(n, least);
  t.axis[1] = (1 / std::sqrt(dot(across, across))) * across;
  t.axis[2] = cross(n, t.axis[1]);
  for (int a = 0; a < 3; ++a) {
    const Vec3<double> moment = cross(t.arm, t.axis[a]);
    const Six x = resistance.answer({t.axis[a].x, t.axis[a].y, t.axis[a].z, moment.x, moment.y, moment.z});
    t.answer[a] = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
  }
  const auto per = [&](int a, int b) { return dot(t.answer[b].at(t.arm), t.axis[a]); };
  t.along = per(0, 0);
  const double mean = 0.5 * (per(1, 1) + per(2, 2)), half = 0.5 * (per(1, 1) - per(2, 2));
  t.across = mean + std::sqrt(half * half + per(1, 2) * per(1, 2));
  return t;
}

/// Adds to the impulse what stops the approach of `q`, divided by `parts`, within Coulomb's cone, and its
/// answers to `to`; the largest velocity that it changes.
double press(Touch& t, const RigidVelocity& q, double parts, RigidVelocity& to) {
  const double before = t.p[0];
  t.p[0] = std::max(0.0, before - t.speed(q, 0) / (parts * t.along));
  add(to, t.p[0] - before, t.answer[0]);
  return std::abs(t.p[0] - before) * t.along;
}

double rub(Touch& t, const RigidVelocity& q, double parts, RigidVelocity& to) {
  if (t.friction == 0 || !(t.across > 0)) return 0;
  double next[2], largest = 0;
  for (int a = 0; a < 2; ++a) next[a] = t.p[1 + a] - t.speed(q, 1 + a) / (parts * t.across);
  const double length = std::hypot(next[0], next[1]), most = t.friction * t.p[0],
               kept = length > most ? most / length : 1;
  for (int a = 0; a < 2; ++a) {
    const double change = kept * next[a] - t.p[1 + a];
    t.p[1 + a] = kept * next[a];
    add(to, change, t.answer[1 + a]);
    largest = std::max(largest, std::abs(change) * t.across);
  }
  return largest;
}

/// Whether the body no longer approaches, and has gained no energy, but for a small part of the speed
/// `fastest`.
bool is_settled(std::span<const Touch> touches, const RigidVelocity& without, const RigidVelocity& q,
                double fastest) {
  double work = 0, all = 0;
  for (const Touch& t : touches) {
    if (-t.speed(q, 0) > most_left * fastest) return false;
    for (int a = 0; a < 3; ++a) {
      work += 0.5 * t.p[a] * (t.speed(without, a) + t.speed(q, a));
      all += std::abs(t.p[a]) * fastest;
    }
  }
  return work <= most_gain * all;  // false where it is not a number
}

}  // namespace

bool RigidContact::operator<(const RigidContact& other) const {
  return std::tie(free, node, driven) < std::tie(other.free, other.node, other.driven);
}

bool resolve_rigid_contacts(const RigidState& s, const RigidResistance& resistance, RigidVelocity& q,
                            std::span<RigidContact> contacts) {
  const RigidVelocity without = q;
  std::vector<Touch> touches;
  double fastest = 0, approach = 0;
  for (const RigidContact& contact : contacts) {
    touches.push_back(touch_of(s, resistance, contact));
    const Touch& t = touches.back();
    const Vec3<double> u = q.at(t.arm) - t.velocity;
    const auto speed = [](const Vec3<double>& v) { return std::sqrt(dot(v, v)); };
    fastest = std::max({fastest, speed(u), round_off * speed(t.velocity)});
    // Symmetry planes hold what the body cannot do.
    if (!(t.along > 1e-9 / s.mass)) touches.back().along = 0;
    approach = std::max(approach, -t.speed(q, 0));
  }
  const auto moves = [](const Touch& t) { return t.along > 0; };
  if (approach > 0) {
    const double parts = static_cast<double>(touches.size());
    for (int sweep = 0; sweep < even_sweeps; ++sweep) {
      const RigidVelocity before = q;
      for (Touch& t : touches) {
        if (!moves(t)) continue;
        press(t, before, parts, q);
        rub(t, before, parts, q);
      }
    }
    const int sweeps = std::clamp(static_cast<int>(most_work / touches.size()), fewest_sweeps, most_sweeps);
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      double largest = 0;
      for (Touch& t : touches) {
        if (!moves(t)) continue;
        largest = std::max(largest, press(t, q, 1, q));
        largest = std::max(largest, rub(t, q, 1, q));
      }
      if (!(largest > rest * fastest)) break;
    }
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Touch& t = touches[i];
    contacts[i].impulse = t.p[0] * t.axis[0] + t.p[1] * t.axis[1] + t.p[2] * t.axis[2];
  }
  return approach <= 0 || is_settled(touches, without, q, fastest);
}

}  // namespace mpm::core
