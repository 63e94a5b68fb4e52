#include "core/contact/rigid_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace mpm::core {

namespace {

using Six = std::array<double, 6>;

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

/// x with A x = b, A positive definite: L D L^T in place of its lower triangle.
Six solve(std::array<double, 21> a, Six b) {
  const auto at = [&](int i, int j) -> double& { return a[static_cast<std::size_t>(triangle(i, j))]; };
  const auto x = [&](int i) -> double& { return b[static_cast<std::size_t>(i)]; };
  for (int j = 0; j < 6; ++j) {
    for (int k = 0; k < j; ++k) at(j, j) -= at(j, k) * at(j, k) * at(k, k);
    for (int i = j + 1; i < 6; ++i) {
      for (int k = 0; k < j; ++k) at(i, j) -= at(i, k) * at(j, k) * at(k, k);
      at(i, j) /= at(j, j);
    }
  }
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < i; ++k) x(i) -= at(i, k) * x(k);
  for (int i = 0; i < 6; ++i) x(i) /= at(i, i);
  for (int i = 5; i >= 0; --i)
    for (int k = i + 1; k < 6; ++k) x(i) -= at(k, i) * x(k);
  return b;
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

RigidVelocity next_trial(const RigidState& s, const RigidVelocity& free, const RigidVelocity& trial,
                         std::span<const double> response) {
  std::array<double, 21> a;
  std::ranges::copy(response.subspan(6), a.begin());
  const auto at = [&](int i, int j) -> double& { return a[static_cast<std::size_t>(triangle(i, j))]; };
  for (int i = 0; i < 3; ++i) at(i, i) += s.mass;
  const Sym3<double>& j = s.inertia;
  at(3, 3) += j.xx, at(4, 4) += j.yy, at(5, 5) += j.zz;
  at(4, 3) += j.xy, at(5, 4) += j.yz, at(5, 3) += j.xz;
  Six b = both(s.mass * (free.velocity - trial.velocity), j * (free.spin - trial.spin));
  const std::array<bool, 6> fixed = held(s);
  for (std::size_t i = 0; i < 6; ++i) {
    b[i] = fixed[i] ? 0 : b[i] + response[i];
    for (std::size_t k = 0; k <= i; ++k)
      if (fixed[i] || fixed[k])
        a[static_cast<std::size_t>(triangle(static_cast<int>(i), static_cast<int>(k)))] = i == k;
  }
  const Six d = solve(a, b);
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
