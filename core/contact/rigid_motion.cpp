#include "core/contact/rigid_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace mpm::core {

namespace {

/// Number of the entry in row i and column j <= i of a lower triangle.
constexpr int triangle(int i, int j) { return i * (i + 1) / 2 + j; }

Six both(const Vec3<double>& a, const Vec3<double>& b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }

/// What cannot change: along the normals of symmetry planes, and turning about axes in them; turning at all
/// of particles on one line.
std::array<bool, 6> held(const RigidState& s) {
  RigidState moves = s;
  moves.velocity = moves.spin = {1, 1, 1};
  keep_symmetry(moves);
  if (spin_with(s, {s.inertia.xx, s.inertia.yy, s.inertia.zz}) == Vec3<double>{}) moves.spin = {};
  const Six free = both(moves.velocity, moves.spin);
  std::array<bool, 6> is{};
  for (std::size_t i = 0; i < 6; ++i) is[i] = free[i] == 0;
  return is;
}

}  // namespace

void RigidResponse::add(const Vec3<double>& p, const Vec3<double>& arm, const Vec3<double>& normal,
                        double along, double across) {
  const Six g = both(p, cross(arm, p));
  for (std::size_t i = 0; i < 6; ++i) sums[i].add(g[i]);
  // k = across 1 + (along - across) n n^T, and B^T e = (e, arm x e).
  const Six n = both(normal, cross(arm, normal));
  Six axes[3];
  for (int a = 0; a < 3; ++a) {
    Vec3<double> e{};
    e[a] = 1;
    axes[a] = both(e, cross(arm, e));
  }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double value = (along - across) * n[i] * n[j];
      for (const Six& e : axes) value += across * e[i] * e[j];
      sums[6 + triangle(static_cast<int>(i), static_cast<int>(j))].add(value);
    }
  }
}

RigidResistance::RigidResistance(const RigidState& s, std::span<const double> response) : fixed_(held(s)) {
  std::ranges::copy(response.subspan(6), factor_.begin());
  const auto at = [&](int i, int j) -> double& { return factor_[static_cast<std::size_t>(triangle(i, j))]; };
  for (int i = 0; i < 3; ++i) at(i, i) += s.mass;
  const Sym3<double>& j = s.inertia;
  at(3, 3) += j.xx, at(4, 4) += j.yy, at(5, 5) += j.zz;
  at(4, 3) += j.xy, at(5, 4) += j.yz, at(5, 3) += j.xz;
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k <= i; ++k)
      if (fixed_[static_cast<std::size_t>(i)] || fixed_[static_cast<std::size_t>(k)]) at(i, k) = i == k;
  for (int c = 0; c < 6; ++c) {
    for (int k = 0; k < c; ++k) at(c, c) -= at(c, k) * at(c, k) * at(k, k);
    for (int i = c + 1; i < 6; ++i) {
      for (int k = 0; k < c; ++k) at(i, c) -= at(i, k) * at(c, k) * at(k, k);
      at(i, c) /= at(c, c);
    }
  }
}

Six RigidResistance::answer(Six b) const {
  const auto at = [&](int i, int j) { return factor_[static_cast<std::size_t>(triangle(i, j))]; };
  const auto x = [&](int i) -> double& { return b[static_cast<std::size_t>(i)]; };
  for (std::size_t i = 0; i < 6; ++i)
    if (fixed_[i]) b[i] = 0;
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < i; ++k) x(i) -= at(i, k) * x(k);
  for (int i = 0; i < 6; ++i) x(i) /= at(i, i);
  for (int i = 5; i >= 0; --i)
    for (int k = i + 1; k < 6; ++k) x(i) -= at(k, i) * x(k);
  return b;
}

RigidVelocity next_trial(const RigidState& s, const RigidVelocity& free, const RigidVelocity& trial,
                         std::span<const double> response) {
  Six b = both(s.mass * (free.velocity - trial.velocity), s.inertia * (free.spin - trial.spin));
  for (std::size_t i = 0; i < 6; ++i) b[i] += response[i];
  const Six d = RigidResistance(s, response).answer(b);
  return {trial.velocity + Vec3<double>{d[0], d[1], d[2]}, trial.spin + Vec3<double>{d[3], d[4], d[5]}};
}

bool same_motion(const RigidState& s, const RigidVelocity& a, const RigidVelocity& b) {
  constexpr double small = 1e-9;
  const auto squared = [&](const Vec3<double>& v, const Vec3<double>& w) {
    return s.mass * dot(v, v) + trace(s.inertia) * dot(w, w);
  };
  return squared(b.velocity - a.velocity, b.spin - a.spin) <= small * small * squared(b.velocity, b.spin);
}

}  // namespace mpm::core
