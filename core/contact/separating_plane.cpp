#include "core/contact/separating_plane.hpp"

#include <algorithm>
#include <cmath>

#include "core/tensor/tensor.hpp"

namespace mpm::core {

namespace {

/// lambda, with lengths in cells. A smaller one follows single particles more closely where the layers that
/// face each other are stairs; a larger one lets the plane tilt at edges.
constexpr double penalty = 0.1;
constexpr int most_steps = 40;
constexpr double rest = 1e-10;    // of the plane, between two steps
constexpr double within = 0.75;   // c (n.x + b) of the first plane below which particles are near it
constexpr double steeper = 3;     // the best plane than the first one, where bodies fill the cells
constexpr double nothing = 1e-8;  // of labels 1 apart, over a cell: bodies in the same place

struct Plane {
  Vec3<double> n{};
  double b = 0;
};

/// F, and the sums over the particles with c (n.x + b) < 1.
struct Sums {
  std::size_t blocks = 0;  ///< with any of them
  double objective = 0;
  double count = 0, label = 0;
  Vec3<double> x{}, label_x{};
  Sym3<double> xx{};
};

using Row = LabelledPoints::Row;

double sum_of_lanes(const Row& v) {
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

/// max(0, 1 - c (n.x + b)) of a block's particles: above 0 for those on the wrong side.
Row short_of_one(const LabelledPoints& points, std::size_t block, const Plane& plane) {
  const Row c = points.row(block, 3), d = plane.n.x * points.row(block, 0) +
                                          plane.n.y * points.row(block, 1) +
                                          plane.n.z * points.row(block, 2) + plane.b;
  return select(c != Row(0.0), max(1.0 - c * d, 0.0), 0.0);
}

/// `all`: over all particles, whatever the plane.
Sums sums_of(const LabelledPoints& points, const Plane& plane, bool all) {
  const Row zero(0.0), one(1.0);
  Sums s;
  Row count(0.0), label(0.0), square(0.0), first[3], labelled[3], second[6];
  for (Row* sums : {first, labelled, second, second + 3})
    for (int a = 0; a < 3; ++a) sums[a] = zero;
  for (std::size_t block = 0; block < points.blocks(); ++block) {
    const Row c = points.row(block, 3), short_of = short_of_one(points, block, plane);
    const auto counts = all ? c != zero : short_of > zero;
    if (!any(counts)) continue;
    ++s.blocks;
    const Row on = select(counts, one, zero);
    const Row x = points.row(block, 0), y = points.row(block, 1), z = points.row(block, 2);
    square += short_of * short_of;
    const Row cx = on * x, cy = on * y, cz = on * z;
    count += on;
    label += on * c;
    first[0] += cx, first[1] += cy, first[2] += cz;
    labelled[0] += c * cx, labelled[1] += c * cy, labelled[2] += c * cz;
    second[0] += cx * x, second[1] += cy * y, second[2] += cz * z;
    second[3] += cx * y, second[4] += cy * z, second[5] += cx * z;
  }
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

/// Newton's method from a plane on, which it moves; the blocks with particles on the wrong side.
std::size_t find_best(const LabelledPoints& points, Plane& plane) {
  Sums sums = sums_of(points, plane, false);
  for (int step = 0; step < most_steps; ++step) {
    const Plane best = regression(sums, plane);
    const Plane change{best.n - plane.n, best.b - plane.b};
    if (!(length(change) > rest * length(plane))) break;
    // Whole steps take the regression itself: the bits of the last one depend on its particles alone, and not
    // on the planes before.
    Plane next = best;
    Sums there;
    double part = 1;
    do {
      if (part < 1) next = {plane.n + part * change.n, plane.b + part * change.b};
      there = sums_of(points, next, false);
      part *= 0.5;
    } while (!(there.objective < sums.objective) && part > 1e-6);
    if (!(there.objective < sums.objective)) break;  // as low as round-off allows
    plane = next, sums = there;
  }
  return sums.blocks;
}

/// Whether a block has a particle for which c (n.x + b) < `below`.
bool is_near(const LabelledPoints& points, std::size_t block, const Plane& plane, double below) {
  return any(short_of_one(points, block, plane) > Row(1 - below));
}

}  // namespace

std::optional<Vec3<double>> separating_normal(const LabelledPoints& points, LabelledPoints& near) {
  const Sums labels = sums_of(points, {}, true);
  if (labels.count == std::abs(labels.label)) return std::nullopt;  // of one body alone
  Plane plane = regression(labels, {});
  // About half of the particles are far from the first plane and stay on the right side of the others: they
  // are left out, and looked at once more at the end. Sums without them have the same bits.
  near.clear();
  for (std::size_t block = 0; block < points.blocks(); ++block)
    if (is_near(points, block, plane, within)) near.add(points, block);
  plane = {steeper * plane.n, steeper * plane.b};
  const std::size_t used = find_best(near, plane);
  std::size_t all = 0;
  for (std::size_t block = 0; block < points.blocks(); ++block) all += is_near(points, block, plane, 1);
  if (all != used) find_best(points, plane);
  const double size = std::sqrt(dot(plane.n, plane.n));
  if (!(size > nothing) || !std::isfinite(size)) return std::nullopt;
  return (1 / size) * plane.n;
}

}  // namespace mpm::core
