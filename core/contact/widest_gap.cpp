#include "core/contact/widest_gap.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mpm::core {

namespace {

constexpr int most_steps = 100;
constexpr double rest = 1e-12;   // of the distance
constexpr double least = 1e-4;   // of a cell: hulls nearer than that meet
constexpr double inside = 1e-9;  // of the weights of a simplex

/// Up to four points whose hull has the point of least norm in its inside.
struct Simplex {
  Vec3<double> point[4]{};
  double weight[4]{};
  int size = 0;

  void remove(int i) {
    for (int k = i + 1; k < size; ++k) point[k - 1] = point[k], weight[k - 1] = weight[k];
    --size;
  }
  Vec3<double> place() const {
    Vec3<double> x{};
    for (int i = 0; i < size; ++i) x = x + weight[i] * point[i];
    return x;
  }
};

/// Weights of the point of least norm in the plane through the points; false where they lie in less than one.
bool find_least(const Simplex& s, double (&weight)[4]) {
  // |p0 + sum a_i d_i| with d_i = p_i - p0: Gram's matrix, by elimination.
  const int n = s.size - 1;
  double g[3][4]{};
  double size = 0;
  for (int i = 0; i < n; ++i) {
    const Vec3<double> d = s.point[i + 1] - s.point[0];
    for (int j = 0; j < n; ++j) g[i][j] = dot(d, s.point[j + 1] - s.point[0]);
    g[i][3] = -dot(d, s.point[0]);
    size = std::max(size, g[i][i]);
  }
  for (int c = 0; c < n; ++c) {
    if (!(g[c][c] > 1e-12 * size)) return false;
    for (int i = c + 1; i < n; ++i) {
      const double f = g[i][c] / g[c][c];
      for (int j = c; j < 4; ++j) g[i][j] -= f * g[c][j];
    }
  }
  weight[0] = 1;
  for (int i = n - 1; i >= 0; --i) {
    double a = g[i][3];
    for (int j = i + 1; j < n; ++j) a -= g[i][j] * weight[j + 1];
    weight[i + 1] = a / g[i][i];
    weight[0] -= weight[i + 1];
  }
  return true;
}

/// Across the simplex: from its edges, more exactly than from the point of least norm.
Vec3<double> across(const Simplex& s) {
  const Vec3<double> x = s.place();
  if (s.size == 1) return x;
  const Vec3<double> d = s.point[1] - s.point[0];
  if (s.size == 2) return s.point[0] - (dot(s.point[0], d) / dot(d, d)) * d;
  const Vec3<double> n = cross(d, s.point[2] - s.point[0]);
  return dot(n, x) < 0 ? -1.0 * n : n;
}

}  // namespace

std::optional<Vec3<double>> widest_gap_normal(const LabelledPoints& points) {
  std::vector<Vec3<double>> body[2];
  for (std::size_t block = 0; block < points.blocks(); ++block) {
    double lane[4][LabelledPoints::lanes];
    for (int a = 0; a < 4; ++a) store(lane[a], points.row(block, a));
    for (int i = 0; i < LabelledPoints::lanes; ++i)
      if (lane[3][i] != 0) body[lane[3][i] > 0].push_back({lane[0][i], lane[1][i], lane[2][i]});
  }
  if (body[0].empty() || body[1].empty()) return std::nullopt;
  // The first of those that are the farthest, in the points' order.
  const auto farthest = [&](const Vec3<double>& x) {
    const auto along = [&](const Vec3<double>& a, const Vec3<double>& b) { return dot(a, x) < dot(b, x); };
    return *std::ranges::min_element(body[1], along) - *std::ranges::max_element(body[0], along);
  };
  Simplex s;
  s.point[0] = body[1].front() - body[0].front(), s.weight[0] = 1, s.size = 1;
  for (int step = 0; step < most_steps; ++step) {
    const Vec3<double> x = s.place();
    const double square = dot(x, x);
    if (square < least * least) return std::nullopt;
    const Vec3<double> next = farthest(x);
    if (!(dot(x, x - next) > rest * square)) break;
    if (s.size == 4) return std::nullopt;
    s.point[s.size] = next, s.weight[s.size++] = 0;
    // Towards the least point of the plane through all, leaving those out that it is not between.
    for (;;) {
      double weight[4];
      if (!find_least(s, weight)) {
        s.remove(s.size - 1);
        step = most_steps;
        break;
      }
      double part = 1;
      int last = -1;
      for (int i = 0; i < s.size; ++i) {
        if (weight[i] > inside) continue;
        const double until = s.weight[i] / (s.weight[i] - weight[i]);
        if (last < 0 || until < part) part = until, last = i;
      }
      if (last < 0) {
        std::copy_n(weight, s.size, s.weight);
        break;
      }
      for (int i = 0; i < s.size; ++i) s.weight[i] += part * (weight[i] - s.weight[i]);
      s.remove(last);
    }
    if (s.size == 4) return std::nullopt;  // the origin is within
  }
  const Vec3<double> n = across(s);
  const double length = std::sqrt(dot(n, n));
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return (1 / length) * n;
}

}  // namespace mpm::core
