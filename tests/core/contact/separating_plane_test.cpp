// Normals by regression: exact where symmetry says what they are, upright at edges, the same for both bodies.
#include "core/contact/separating_plane.hpp"

#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "core/contact/node_contact.hpp"

using namespace mpm::core;

namespace {

using Vector = Vec3<double>;
using Cloud = std::vector<Vector>;

double length(const Vector& v) { return std::sqrt(dot(v, v)); }
Vector unit(const Vector& v) { return (1 / length(v)) * v; }
double degrees_between(const Vector& a, const Vector& b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::acos(-1.0);
}

LabelledPoints points_of(const Cloud& first, const Cloud& second, double sign = 1) {
  LabelledPoints points;
  for (const auto& [cloud, label] : {std::pair(&first, -sign), std::pair(&second, sign)}) {
    for (std::size_t p = 0; p < cloud->size(); p += LabelledPoints::lanes) {
      LabelledPoints::Row x[3] = {0.0, 0.0, 0.0}, labels(0.0);
      for (std::size_t l = 0; l < LabelledPoints::lanes && p + l < cloud->size(); ++l) {
        for (int a = 0; a < 3; ++a) x[a].set(static_cast<int>(l), (*cloud)[p + l][a]);
        labels.set(static_cast<int>(l), label);
      }
      points.add(x[0], x[1], x[2], labels);
    }
  }
  return points;
}
std::optional<Vector> separating(const LabelledPoints& points) {
  LabelledPoints scratch;
  return separating_normal(points, scratch);
}
Vector normal(const Cloud& first, const Cloud& second) {
  return separating(points_of(first, second)).value();
}

/// Points of a lattice with spacing 1/2 in the 64 cells around the node, for which `in`.
template <class F>
Cloud lattice(const Vector& offset, F in) {
  Cloud points;
  for (int i = -5; i <= 5; ++i) {
    for (int j = -5; j <= 5; ++j) {
      for (int k = -5; k <= 5; ++k) {
        const Vector x = offset + 0.5 * Vector{double(i), double(j), double(k)};
        const bool near = std::abs(x.x) <= 2 && std::abs(x.y) <= 2 && std::abs(x.z) <= 2;
        if (near && in(x)) points.push_back(x);
      }
    }
  }
  return points;
}

/// A block with its corner over a wider base: both reach the plane z = height.
struct BlockOnBase {
  Cloud base, block;
  Vector gradient_of_base{}, gradient_of_block{};  ///< of mass at the node, linear shape functions
  double weight = 0;                               ///< of the block's mass at the node
};

BlockOnBase block_on_base(double height, double x_end, double y_end, const Vector& shift) {
  BlockOnBase at;
  at.base = lattice({shift.x, shift.y, height - 0.25}, [&](const Vector& x) { return x.z < height; });
  at.block = lattice({x_end - 0.25, y_end - 0.25, height + 0.25},
                     [&](const Vector& x) { return x.z > height && x.x < x_end && x.y < y_end; });
  const auto gradient = [](const Cloud& cloud, double* weight) {
    Vector sum{};
    for (const Vector& x : cloud) {
      const auto w = [&](int a) { return std::max(0.0, 1 - std::abs(x[a])); };
      const auto d = [&](int a) { return w(a) > 0 ? (x[a] > 0 ? 1.0 : -1.0) : 0.0; };
      sum = sum + Vector{d(0) * w(1) * w(2), w(0) * d(1) * w(2), w(0) * w(1) * d(2)};
      if (weight != nullptr) *weight += w(0) * w(1) * w(2);
    }
    return sum;
  };
  // grad S_i of a particle points towards the node: away from it, with the sign changed.
  at.gradient_of_base = -1.0 * gradient(at.base, nullptr);
  at.gradient_of_block = -1.0 * gradient(at.block, &at.weight);
  return at;
}

/// Logistic regression, plainly: the least sum log(1 + exp(-c d)) + lambda/2 n.n, d = n.x + b, by
/// Newton's method from the linear regression; that itself with 0 steps.
Vector logistic_normal(const Cloud& first, const Cloud& second, int steps) {
  constexpr double lambda = 1e-4;
  using Matrix = Eigen::Matrix4d;
  using Column = Eigen::Vector4d;
  Column plane = Column::Zero();
  const Matrix penalty = Column(lambda, lambda, lambda, 1e-12).asDiagonal();
  const auto over_points = [&](auto f) {
    for (const Vector& x : first) f(Column(x.x, x.y, x.z, 1), -1.0);
    for (const Vector& x : second) f(Column(x.x, x.y, x.z, 1), 1.0);
  };
  const auto objective = [&](const Column& at) {
    double sum = 0.5 * at.dot(penalty * at);
    over_points([&](const Column& x, double c) {
      const double d = c * at.dot(x);
      sum += d > 0 ? std::log1p(std::exp(-d)) : std::log1p(std::exp(d)) - d;
    });
    return sum;
  };
  for (int step = 0; step <= steps; ++step) {
    Matrix slope = penalty;
    Column right = -(penalty * plane);
    over_points([&](const Column& x, double c) {
      const double wrong = step == 0 ? 1 : 1 / (1 + std::exp(c * plane.dot(x)));
      right += c * wrong * x;
      slope += (step == 0 ? 1 : wrong * (1 - wrong)) * x * x.transpose();
    });
    const Column change = slope.ldlt().solve(right);
    double part = 1;
    while (step > 0 && objective(plane + part * change) > objective(plane) && part > 1e-6) part /= 2;
    plane += part * change;
  }
  return unit({plane[0], plane[1], plane[2]});
}

}  // namespace

TEST_CASE("Normal by regression: clouds that mirror each other, at any angle") {
  std::mt19937 random(3);
  std::normal_distribution<double> bell;
  std::uniform_real_distribution<double> real(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const Vector n = unit({bell(random), bell(random), bell(random)});
    const double place = 2 * real(random) - 1, gap = 0.3 * real(random) - 0.1;
    Cloud first, second;
    for (int p = 0; p < 20 + trial; ++p) {
      const Vector x{2 * bell(random), 2 * bell(random), 2 * bell(random)};
      const double depth = std::abs(dot(x, n)) + gap;  // with a negative gap some are on the wrong side
      const Vector in_plane = x - dot(x, n) * n;
      first.push_back(in_plane + (place - depth) * n);
      second.push_back(in_plane + (place + depth) * n);
    }
    CHECK(length(normal(first, second) - n) < 1e-12);
  }
}

TEST_CASE("Normal by regression: two bodies of random particles that a plane separates") {
  std::mt19937 random(4);
  std::normal_distribution<double> bell;
  std::uniform_real_distribution<double> real(-2, 2);
  double sum = 0, largest = 0;
  constexpr int trials = 200;
  for (int trial = 0; trial < trials; ++trial) {
    const Vector n = unit({bell(random), bell(random), bell(random)});
    const double place = 0.4 * real(random);
    Cloud first, second;
    for (int p = 0; p < 512; ++p) {
      const Vector x{real(random), real(random), real(random)};
      (dot(x, n) < place ? first : second).push_back(x);
    }
    const double error = degrees_between(normal(first, second), n);
    sum += error / trials;
    largest = std::max(largest, error);
  }
  INFO("mean " << sum << " degrees, largest " << largest);
  CHECK(sum < 1.5);
  CHECK(largest < 6);
}

TEST_CASE("Normal by regression: upright at the edges of a block on a wider base, where others tilt") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> real(-1, 1);
  struct Tilt {
    double mean = 0, largest = 0;  ///< degrees; the mean by mass of the block
    void add(const Vector& n, double weight) {
      const double tilt = degrees_between(n, {0, 0, 1});
      mean += weight * tilt;
      largest = std::max(largest, tilt);
    }
  } regression, gradients, linear, logistic;
  double mass = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const BlockOnBase at = block_on_base(real(random), real(random), trial % 2 == 0 ? 5 : real(random),
                                         {0.25 * real(random), 0.25 * real(random), 0});
    const auto of_gradients = contact_normal({at.gradient_of_base, 0}, {at.gradient_of_block, 0});
    if (!(at.weight > 0) || !of_gradients || at.gradient_of_base == Vector{}) continue;
    mass += at.weight;
    regression.add(normal(at.base, at.block), at.weight);
    gradients.add(*of_gradients, at.weight);
    linear.add(logistic_normal(at.base, at.block, 0), at.weight);
    logistic.add(logistic_normal(at.base, at.block, 30), at.weight);
  }
  for (Tilt* tilt : {&regression, &gradients, &linear, &logistic}) tilt->mean /= mass;
  INFO("mean and largest tilt in degrees: regression "
       << regression.mean << ", " << regression.largest << "; gradients " << gradients.mean << ", "
       << gradients.largest << "; linear regression " << linear.mean << ", " << linear.largest
       << "; logistic regression " << logistic.mean << ", " << logistic.largest);
  // The random clouds depend on the order in which the compiler evaluates arguments.
  CHECK(regression.mean < 0.3);
  CHECK(regression.largest < 2);
  CHECK(gradients.mean > 20);
  CHECK(linear.mean > 5);
  CHECK(logistic.mean > 3 * regression.mean);
}

TEST_CASE("Normal by regression: exactly opposite for the bodies in the other order") {
  std::mt19937 random(6);
  std::normal_distribution<double> bell;
  for (int trial = 0; trial < 100; ++trial) {
    Cloud first, second;
    for (int p = 0; p < 30; ++p) {
      first.push_back({bell(random), bell(random), bell(random) - 1});
      second.push_back({bell(random), bell(random), bell(random) + 1});
    }
    const auto one = separating(points_of(first, second)), other = separating(points_of(first, second, -1));
    CHECK(one.value() == -1.0 * other.value());
    // In another order of the particles all but round-off stays.
    CHECK(length(normal(second, first) + one.value()) < 1e-9);
  }
}

/// The least penalty/2 n.n + 1/2 sum max(0, 1 - c d)^2, d = n.x + b, by plain descent with Newton's matrix
/// over all particles.
Vector hinge_normal(const Cloud& first, const Cloud& second) {
  constexpr double lambda = 0.1;
  using Column = Eigen::Vector4d;
  const auto over_points = [&](auto f) {
    for (const Vector& x : first) f(Column(x.x, x.y, x.z, 1), -1.0);
    for (const Vector& x : second) f(Column(x.x, x.y, x.z, 1), 1.0);
  };
  const Eigen::Matrix4d penalty = Column(lambda, lambda, lambda, 1e-14).asDiagonal();
  const auto objective = [&](const Column& at) {
    double sum = 0.5 * at.dot(penalty * at);
    over_points(
        [&](const Column& x, double c) { sum += 0.5 * std::pow(std::max(0.0, 1 - c * at.dot(x)), 2); });
    return sum;
  };
  Column plane = Column::Zero();
  for (int step = 0; step < 200; ++step) {
    Eigen::Matrix4d slope = penalty;
    Column right = -(penalty * plane);
    over_points([&](const Column& x, double c) {
      const double short_of = std::max(0.0, 1 - c * plane.dot(x));
      right += c * short_of * x;
      if (short_of > 0) slope += x * x.transpose();
    });
    const Column change = slope.ldlt().solve(right);
    double part = 1;
    while (objective(plane + part * change) > objective(plane) && part > 1e-9) part /= 2;
    plane += part * change;
  }
  return unit({plane[0], plane[1], plane[2]});
}

TEST_CASE("Normal by regression: the least of all particles' objective") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> real(-2, 2);
  for (int trial = 0; trial < 200; ++trial) {
    const Vector along = unit({real(random), real(random), real(random)});
    const double at = 0.5 * real(random);
    // Every fourth pair has strays on the wrong side, far from the plane as well.
    const double stray = trial % 4 == 0 ? 0.05 : 0;
    Cloud first, second;
    for (int i = 0; i < 300; ++i) {
      const Vector x{real(random), real(random), real(random)};
      const double d = dot(x, along) - at;
      const bool strays = 0.25 * (real(random) + 2) < stray;
      if (std::abs(d) > 0.1) ((d < 0) != strays ? first : second).push_back(x);
    }
    if (first.empty() || second.empty()) continue;
    INFO("trial " << trial);
    CHECK(length(normal(first, second) - hinge_normal(first, second)) < 1e-6);
  }
}

TEST_CASE("Normal by regression: clouds that do not fix a plane") {
  const Vector a{0.2, -0.4, 0.1}, b{0.7, 0.3, 0.4};
  CHECK(length(normal({a}, {b}) - unit(b - a)) < 1e-12);  // one particle each
  // In a plane, the normal is in it; on a line, along it.
  Cloud left, right, low, high;
  for (int i = 0; i < 5; ++i) {
    left.push_back({-0.3 - 0.1 * i, 0.4 * i, 0.5}), right.push_back({0.3 + 0.1 * i, 0.4 * i, 0.5});
    low.push_back(-0.2 * (i + 1) * unit({1, 2, 3})), high.push_back(0.2 * (i + 1) * unit({1, 2, 3}));
  }
  CHECK(length(normal(left, right) - Vector{1, 0, 0}) < 1e-12);
  CHECK(length(normal(low, high) - unit({1, 2, 3})) < 1e-12);
  CHECK_FALSE(separating(points_of({a, b}, {})).has_value());
  CHECK_FALSE(separating(points_of({}, {a, b})).has_value());
  CHECK_FALSE(separating({}).has_value());
  CHECK_FALSE(separating(points_of({a, b}, {b, a})).has_value());  // in the same place
}

TEST_CASE(
    "Particles behind those of their own body change no bit of the normal, though they change the first "
    "plane") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> jitter(-0.1, 0.1);
  int changed = 0;
  for (int n = 0; n < 400; ++n) {
    const auto shaken = [&](Cloud cloud) {
      for (Vector& x : cloud) x = x + Vector{jitter(random), jitter(random), jitter(random)};
      cloud.resize(cloud.size() / LabelledPoints::lanes * LabelledPoints::lanes);  // whole blocks
      return cloud;
    };
    const Vector offset{jitter(random), jitter(random), 0.25};
    const Cloud below = shaken(lattice(offset, [](const Vector&x) { return x.z < 0; })),
                above = shaken(lattice(offset, [](const Vector&x) { return x.z > 0 && x.x > -0.3; }));
    Cloud more = below;
    for (int p = 0; p < 5 * LabelledPoints::lanes; ++p) more.push_back({1.9, 10 * jitter(random), -1.9});
    const Vector alone = normal(below, above);
    CHECK(normal(more, above) == alone);
    changed += alone != Vector{0, 0, 1};
  }
  CHECK(changed == 400);
}
