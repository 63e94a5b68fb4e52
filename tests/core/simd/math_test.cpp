// Vector exp, log and pow against long double, over the whole range; the bounds are those that
// core/simd/math.hpp promises.

#include "core/simd/math.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

namespace mpm::tests {

using core::Lanes;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// |value - exact| in units of the last place of the exact value.
double ulps(double value, long double exact) {
  const double nearest = static_cast<double>(exact);
  if (std::isinf(nearest)) return value == nearest ? 0 : inf;
  const double magnitude = std::abs(nearest);
  const double ulp = std::nextafter(magnitude, inf) - magnitude;
  return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / ulp);
}

struct Worst {
  double exp = 0, log = 0, pow = 0;
};

/// Arguments about zero and one, in the middle, and out to where results overflow and underflow.
template <int L>
Worst worst_errors() {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  Worst worst;
  for (int i = 0; i < 40000; ++i) {
    Lanes<L> x, y, z;
    for (int lane = 0; lane < L; ++lane) {
      const double u = unit(random), v = unit(random);
      const double exponents[] = {u, 709 * u, 1e-3 * u, -735 + 10 * u};
      const double arguments[] = {1 + 0.5 * u, std::exp(700 * u), 1 + 1e-5 * u,
                                  std::ldexp(1 + std::abs(u), -1022 - static_cast<int>(50 * std::abs(v)))};
      x.set(lane, exponents[i % 4]);
      y.set(lane, arguments[i % 4]);
      z.set(lane, 3 * v);
    }
    const Lanes<L> e = exp(x), l = log(y), p = pow(y, z);
    for (int lane = 0; lane < L; ++lane) {
      worst.exp = std::max(worst.exp, ulps(e[lane], std::exp(static_cast<long double>(x[lane]))));
      worst.log = std::max(worst.log, ulps(l[lane], std::log(static_cast<long double>(y[lane]))));
      const long double exact =
          std::pow(static_cast<long double>(y[lane]), static_cast<long double>(z[lane]));
      if (exact < 1e-300L || exact > 1e300L) continue;
      const double bound = 2.3e-16 * (3 + 2 * std::abs(z[lane] * std::log(y[lane])));
      worst.pow = std::max(worst.pow, static_cast<double>(std::abs(p[lane] / exact - 1)) / bound);
    }
  }
  return worst;
}

template <int L>
void check_special_values() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto e = [](double x) { return exp(Lanes<L>(x))[0]; };
  const auto l = [](double x) { return log(Lanes<L>(x))[L - 1]; };
  const auto p = [](double x, double y) { return pow(Lanes<L>(x), y)[0]; };
  CHECK(e(0) == 1);
  CHECK(e(-inf) == 0);
  CHECK(e(inf) == inf);
  CHECK(e(710) == inf);
  CHECK(e(-746) == 0);
  CHECK(std::isnan(e(nan)));
  CHECK(l(1) == 0);
  CHECK(l(0) == -inf);
  CHECK(l(-0.0) == -inf);
  CHECK(l(inf) == inf);
  CHECK(std::isnan(l(-1)));
  CHECK(std::isnan(l(nan)));
  CHECK(l(5e-324) == Approx(std::log(5e-324)).epsilon(1e-15));
  CHECK(p(0, 0) == 1);
  CHECK(p(0, 2) == 0);
  CHECK(p(0, -2) == inf);
  CHECK(p(7, 0) == 1);
  CHECK(std::isnan(p(-2, 2)));
  CHECK(std::isnan(p(nan, 2)));
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("vector exp, log and pow keep their bounds", "[core][simd]", ((int L), L), 2, 4, 8) {
  const Worst worst = worst_errors<L>();
  CHECK(worst.exp < 1.5);
  CHECK(worst.log < 1.5);
  CHECK(worst.pow < 1);
}

TEMPLATE_TEST_CASE_SIG("vector exp, log and pow at special values", "[core][simd]", ((int L), L), 2, 4, 8) {
  check_special_values<L>();
}

TEMPLATE_TEST_CASE_SIG("vector floor and square root round as the scalar ones", "[core][simd]", ((int L), L),
                       2, 4, 8) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> values{0.0,  -0.0,  1.0,    -1.0,    0.5,   -0.5,   inf,     -inf,       nan,
                             1e15, -1e15, 0x1p52, -0x1p52, 1e300, 5e-324, -5e-324, 1 - 0x1p-53};
  for (int i = 0; i < 4000; ++i) values.push_back(std::ldexp(unit(random), i % 120 - 60));
  // The same number, or both not a number.
  const auto same = [](double a, double b) {
    return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    Lanes<L> x;
    for (int lane = 0; lane < L; ++lane)
      x.set(lane, values[(i + static_cast<std::size_t>(lane)) % values.size()]);
    const Lanes<L> below = floor(x), root = sqrt(x);
    for (int lane = 0; lane < L; ++lane) {
      CAPTURE(x[lane], lane);
      CHECK(same(below[lane], std::floor(x[lane])));
      CHECK(same(root[lane], std::sqrt(x[lane])));
    }
  }
}

TEST_CASE("a lane's result does not depend on the other lanes", "[core][simd]") {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(-20, 20);
  for (int i = 0; i < 1000; ++i) {
    Lanes<8> x;
    for (int lane = 0; lane < 8; ++lane) x.set(lane, unit(random));
    const Lanes<8> together = exp(x), together_log = log(abs(x));
    for (int lane = 0; lane < 8; ++lane) {
      CHECK(exp(Lanes<8>(x[lane]))[7 - lane] == together[lane]);
      CHECK(log(abs(Lanes<8>(x[lane])))[7 - lane] == together_log[lane]);
    }
  }
}

}  // namespace mpm::tests
