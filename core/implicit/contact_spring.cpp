#include "core/implicit/contact_spring.hpp"

namespace mpm::core {

namespace {

constexpr Mat3<double> unit{1, 0, 0, 0, 1, 0, 0, 0, 1};
/// How often in a step a place changes between sticking and sliding; and after how many solutions its
/// pressure is the mean of the last two.
constexpr int most_turns = 4, steady = 10;

Mat3<double> outer(const Vec3<double>& a, const Vec3<double>& b) {
  return {a.x * b.x, a.x * b.y, a.x * b.z, a.y * b.x, a.y * b.y, a.y * b.z, a.z * b.x, a.z * b.y, a.z * b.z};
}

}  // namespace

ContactSpring::Response ContactSpring::response(const Vec3<double>& in_step) const {
  const Vec3<double>&n = normal, d = in_step + gap;
  Response found;
  if (tied) {
    found.force = first * n - friction - k * d;
    found.stiffness = k * unit;
    found.pressure = dot(found.force, n);
    return found;
  }
  const double pressing = first - k * dot(d, n);
  found.pressure = std::max(0.0, pressing);
  found.force = found.pressure * n - friction;
  // Where nothing has moved yet they press: a body that contact alone holds is held from the start.
  if (pressing >= 0) found.stiffness = k * outer(n, n);
  if (!sticks) return found;
  found.force = found.force - k * across(d, n);
  found.stiffness = found.stiffness + k * (unit - outer(n, n));
  return found;
}

Vec3<double> ContactSpring::held(const Vec3<double>& in_step) const {
  const Vec3<double> d = in_step + gap;
  if (tied) return d;
  Vec3<double> part{};
  if (response(in_step).pressure > 0) part = dot(d, normal) * normal;
  return sticks ? part + across(d, normal) : part;
}

void ContactSpring::take_force(const Vec3<double>& d) {
  const Response now = response(d);
  first = now.pressure;
  if (sticks || tied) friction = now.pressure * normal - now.force;
}

void ContactSpring::find_friction(const Vec3<double>& d, double relaxation, bool counts, Changes& changes) {
  if (coefficient == 0 || tied) return;
  const Vec3<double> slip = across(d + gap, normal);
  const bool sticking = sticks;
  const double now = response(d).pressure;
  pressure = solutions++ < steady ? now : 0.5 * (pressure + now);
  const double most = coefficient * pressure;
  const Vec3<double> before = sticking ? friction + k * slip : friction;
  // Friction grows with the slip up to its bound. A place that slides and has turned round sticks; one that
  // has done so several times goes on sliding, as little as it may.
  sticks = sticking ? dot(before, before) <= most * most : turns < most_turns && dot(slip, before) < 0;
  if (sticks && sticking) {
    if (counts) changes.most.add(most);
    return;
  }
  const Vec3<double> wanted = sticking ? before : before + relaxation * cell_stiffness * slip;
  const double length = std::sqrt(dot(wanted, wanted));
  friction = sticks ? Vec3<double>{} : (length > most ? most / length : 1.0) * wanted;
  if (sticks != sticking) ++turns;
  if (!counts) return;
  const Vec3<double> change = friction - before;
  changes.change.add(std::sqrt(dot(change, change)));
  changes.most.add(most);
}

}  // namespace mpm::core
