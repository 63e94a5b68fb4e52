#include "core/contact/separating_plane.hpp"

#include <algorithm>
#include <cmath>

#include "core/simd/lanes.hpp"
#include "core/tensor/tensor.hpp"

namespace mpm::core {

namespace {

/// lambda, with lengths in cells. A smaller one follows single particles more closely where the layers that
/// face each other are stairs; a larger one lets the plane tilt at edges.
constexpr double penalty = 0.1;
constexpr int most_steps = 40;
constexpr double rest = 1e-10;    // of the plane, between two steps
constexpr double nothing = 1e-8;  // of labels 1 apart, over a cell: bodies in the same place

struct Plane {
  Vec3<double> n{};
  double b = 0;
};

/// F, and the sums over the particles with c (n.x + b) < 1.
struct Sums {
  double objective = 0;
  double count = 0, label = 0;
  Vec3<double> x{}, label_x{};
  Sym3<double> xx{};
};

double sum_of_lanes(const Lanes<8>& v) {
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

/// `all`: over all particles, whatever the plane.
Sums sums_of(const LabelledPoints& points, const Plane& plane, bool all) {
  using R = Lanes<8>;
  const R nx(plane.n.x), ny(plane.n.y), nz(plane.n.z), b(plane.b), zero(0.0), one(1.0);
  R count(0.0), label(0.0), square(0.0), first[3], labelled[3], second[6];
  for (R* sums : {first, labelled, second, second + 3})
    for (int a = 0; a < 3; ++a) sums[a] = zero;
  for (std::size_t i = 0; i < points.blocks(); ++i) {
    const R c = load<R>(points.row(i, 3));
    const R x = load<R>(points.row(i, 0)), y = load<R>(points.row(i, 1)), z = load<R>(points.row(i, 2));
    const R short_of = one - c * (nx * x + ny * y + nz * z + b);
    const auto exists = c != zero;
    const R on = select(all ? exists : exists & (short_of > zero), one, zero);
    square += select(exists, max(short_of, zero) * max(short_of, zero), zero);
    const R cx = on * x, cy = on * y, cz = on * z;
    count += on;
    label += on * c;
    first[0] += cx, first[1] += cy, first[2] += cz;
    labelled[0] += c * cx, labelled[1] += c * cy, labelled[2] += c * cz;
    second[0] += cx * x, second[1] += cy * y, second[2] += cz * z;
    second[3] += cx * y, second[4] += cy * z, second[5] += cx * z;
  }
  Sums s;
  s.objective = 0.5 * (penalty * dot(plane.n, plane.n) + sum_of_lanes(square));
  s.count = sum_of_lanes(count);
  s.label = sum_of_lanes(label);
  for (int a = 0; a < 3; ++a) s.x[a] = sum_of_lanes(first[a]), s.label_x[a] = sum_of_lanes(labelled[a]);
  s.xx = {sum_of_lanes(second[0]), sum_of_lanes(second[1]), sum_of_lanes(second[2]),
          sum_of_lanes(second[3]), sum_of_lanes(second[4]), sum_of_lanes(second[5])};
  return s;
}

/// The regression of the labels on those particles: (S + lambda) n = sum c (x - mean x), with S the sum of
/// (x - mean x)(x - mean x), and b = mean c - n.mean x.
Plane regression(const Sums& s, const Plane& without_particles) {
  if (!(s.count > 0)) return {{}, without_particles.b};
  const double inverse = 1 / s.count;
  const Vec3<double> mean = inverse * s.x, right = s.label_x - s.label * mean;
  const double xy = s.xx.xy - s.x.x * mean.y, yz = s.xx.yz - s.x.y * mean.z, xz = s.xx.xz - s.x.x * mean.z;
  const Mat3<double> m{s.xx.xx - s.x.x * mean.x + penalty, xy, xz, xy,
                       s.xx.yy - s.x.y * mean.y + penalty, yz, xz, yz,
                       s.xx.zz - s.x.z * mean.z + penalty};
  const Mat3<double> cofactors = adjugate(m);
  const double scale = 1 / determinant(m);
  const auto row = [&](double a, double b, double c) { return scale * dot(Vec3<double>{a, b, c}, right); };
  const Vec3<double> n{row(cofactors.xx, cofactors.xy, cofactors.xz),
                       row(cofactors.yx, cofactors.yy, cofactors.yz),
                       row(cofactors.zx, cofactors.zy, cofactors.zz)};
  return {n, inverse * s.label - dot(n, mean)};
}

double length(const Plane& p) { return std::sqrt(dot(p.n, p.n) + p.b * p.b); }

}  // namespace

void LabelledPoints::clear() {
  blocks_.clear();
  count_ = {};
  used_ = lanes;
}

std::optional<Vec3<double>> separating_normal(const LabelledPoints& points) {
  if (points.of_first() == 0 || points.of_second() == 0) return std::nullopt;
  Plane plane = regression(sums_of(points, {}, true), {});
  Sums sums = sums_of(points, plane, false);
  for (int step = 0; step < most_steps; ++step) {
    const Plane best = regression(sums, plane);
    const Plane change{best.n - plane.n, best.b - plane.b};
    if (!(length(change) > rest * length(plane))) break;
    Plane next;
    Sums there;
    double part = 1;
    do {
      next = {plane.n + part * change.n, plane.b + part * change.b};
      there = sums_of(points, next, false);
      part *= 0.5;
    } while (!(there.objective < sums.objective) && part > 1e-6);
    if (!(there.objective < sums.objective)) break;  // as low as round-off allows
    plane = next, sums = there;
  }
  const double size = std::sqrt(dot(plane.n, plane.n));
  if (!(size > nothing) || !std::isfinite(size)) return std::nullopt;
  return (1 / size) * plane.n;
}

}  // namespace mpm::core
