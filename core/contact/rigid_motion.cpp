#include "core/contact/rigid_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/LU>

namespace mpm::core {

namespace {

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

constexpr std::array<double, RigidResponse::size> no_response{};

RigidVelocity motion(const Six& x) { return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}}; }

/// M (q0 - q) + sum B^T P(q), of what can change.
Six residual(const RigidState& s, const RigidVelocity& free, const RigidVelocity& q,
             std::span<const double> response) {
  Six r = both(s.mass * (free.velocity - q.velocity), s.inertia * (free.spin - q.spin));
  const std::array<bool, 6> fixed = held(s);
  for (std::size_t i = 0; i < 6; ++i) r[i] = fixed[i] ? 0 : r[i] + response[i];
  return r;
}

}  // namespace

void RigidResponse::add(const Vec3<double>& p, const Vec3<double>& arm, const Mat3<double>& change) {
  const Six of_p = both(p, cross(arm, p));
  for (std::size_t i = 0; i < 6; ++i) sums[i].add(of_p[i]);
  // Column by column: B of a unit motion is e, or e x arm.
  for (std::size_t j = 0; j < 6; ++j) {
    Vec3<double> e{};
    e[static_cast<int>(j % 3)] = 1;
    const Vec3<double> falls = change * (j < 3 ? e : cross(e, arm));
    const Six column = both(falls, cross(arm, falls));
    for (std::size_t i = 0; i < 6; ++i) sums[6 + 6 * i + j].add(column[i]);
  }
}

RigidResistance::RigidResistance(const RigidState& s, std::span<const double> response) : fixed_(held(s)) {
  using Matrix = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  Matrix a = Eigen::Map<const Matrix>(response.subspan(6).data());
  const Sym3<double>& j = s.inertia;
  a.topLeftCorner<3, 3>().diagonal().array() += s.mass;
  a.bottomRightCorner<3, 3>() += Eigen::Matrix3d{{j.xx, j.xy, j.xz}, {j.xy, j.yy, j.yz}, {j.xz, j.yz, j.zz}};
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k)
      if (fixed_[static_cast<std::size_t>(i)] || fixed_[static_cast<std::size_t>(k)]) a(i, k) = i == k;
  Eigen::Map<Matrix>(inverse_.data()) = a.inverse();
}

Six RigidResistance::answer(const Six& b) const {
  Six x{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t k = 0; k < 6; ++k)
      if (!fixed_[i] && !fixed_[k]) x[i] += inverse_[6 * i + k] * b[k];
  return x;
}

RigidVelocity next_trial(const RigidState& s, const RigidVelocity& free, const RigidVelocity& trial,
                         std::span<const double> response) {
  return trial + motion(RigidResistance(s, response).answer(residual(s, free, trial, response)));
}

void RigidSearch::next(const RigidState& s, std::span<const double> response) {
  constexpr double least_part = 0.1, least_fall = 1e-4;
  const Six rest = residual(s, free_, trial_, response);
  const Six by_mass = RigidResistance(s, no_response).answer(rest);
  const double squared = std::inner_product(rest.begin(), rest.end(), by_mass.begin(), 0.0);
  if (part_ > least_part && !(squared < residual_ * (1 - least_fall * part_))) {
    part_ *= 0.5;
  } else {
    from_ = trial_, residual_ = squared, part_ = 1;
    step_ = motion(RigidResistance(s, response).answer(rest));
  }
  trial_ = from_ + part_ * step_;
  found_ = part_ == 1 && same_motion(s, from_, trial_);
}

bool same_motion(const RigidState& s, const RigidVelocity& a, const RigidVelocity& b) {
  constexpr double small = 1e-9;
  const auto squared = [&](const RigidVelocity& q) {
    return s.mass * dot(q.velocity, q.velocity) + trace(s.inertia) * dot(q.spin, q.spin);
  };
  const double scale = std::max(squared(b), squared({s.velocity, s.spin}));
  return squared(b + -1.0 * a) <= small * small * scale;
}

}  // namespace mpm::core
