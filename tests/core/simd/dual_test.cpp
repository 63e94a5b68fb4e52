// Dual numbers: every operation and function against its derivative, for scalars and vectors, and what they
// do where there is no derivative.

#include "core/simd/dual.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

namespace mpm::tests {

using core::Dual;
using core::Lanes;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const double nan = std::nan("");

/// A function of two variables for any value type, and its partial derivatives, by hand.
struct Row {
  const char* name;
  double lowest;  ///< argument
  double (*value)(double, double);
  Dual<double, 2> (*scalar)(Dual<double, 2>, Dual<double, 2>);
  Dual<Lanes<4>, 2> (*vector)(Dual<Lanes<4>, 2>, Dual<Lanes<4>, 2>);
  double (*by_x)(double, double);
  double (*by_y)(double, double);
};

template <auto f>
Row row(const char* name, double lowest, double (*by_x)(double, double), double (*by_y)(double, double)) {
  return {name,
          lowest,
          [](double x, double y) -> double { return f(x, y); },
          [](Dual<double, 2> x, Dual<double, 2> y) { return Dual<double, 2>(f(x, y)); },
          [](Dual<Lanes<4>, 2> x, Dual<Lanes<4>, 2> y) { return Dual<Lanes<4>, 2>(f(x, y)); },
          by_x,
          by_y};
}

using D = double;
const std::array rows{
    row<[](auto x, auto y) { return x + y; }>(
        "x + y", -2, [](D, D) { return 1.0; }, [](D, D) { return 1.0; }),
    row<[](auto x, auto y) { return x - y; }>(
        "x - y", -2, [](D, D) { return 1.0; }, [](D, D) { return -1.0; }),
    row<[](auto x, auto y) { return x * y; }>(
        "x y", -2, [](D, D y) { return y; }, [](D x, D) { return x; }),
    row<[](auto x, auto y) { return x / y; }>(
        "x / y", 0.1, [](D, D y) { return 1 / y; }, [](D x, D y) { return -x / (y * y); }),
    row<[](auto x, auto y) { return -x * 3.0 + 2.0 * y - (1.0 - x) + (y - 4.0) / 8.0; }>(
        "with constants", -2, [](D, D) { return -2.0; }, [](D, D) { return 2.125; }),
    row<[](auto x, auto y) { return 3.0 / x + 1 * y; }>(
        "3 / x + y", 0.1, [](D x, D) { return -3 / (x * x); }, [](D, D) { return 1.0; }),
    row<[](auto x, auto y) {
      x += y;
      x *= y;
      x -= y;
      x /= y;
      return x;
    }>(
        "assignments: x + y - 1", 0.1, [](D, D) { return 1.0; }, [](D, D) { return 1.0; }),
    row<[](auto x, auto y) {
      using core::sqrt;
      return sqrt(x * x + y);
    }>(
        "sqrt", 0.1, [](D x, D y) { return x / std::sqrt(x * x + y); },
        [](D x, D y) { return 0.5 / std::sqrt(x * x + y); }),
    row<[](auto x, auto y) {
      using core::exp;
      return exp(x * y);
    }>(
        "exp", -2, [](D x, D y) { return y * std::exp(x * y); },
        [](D x, D y) { return x * std::exp(x * y); }),
    row<[](auto x, auto y) {
      using core::log;
      return log(x * y);
    }>(
        "log", 0.1, [](D x, D) { return 1 / x; }, [](D, D y) { return 1 / y; }),
    row<[](auto x, auto y) {
      using core::pow;
      return pow(x, 2.5) + y;
    }>(
        "pow, constant exponent", 0.1, [](D x, D) { return 2.5 * std::pow(x, 1.5); },
        [](D, D) { return 1.0; }),
    row<[](auto x, auto y) {
      using core::pow;
      return pow(x, y);
    }>(
        "pow", 0.1, [](D x, D y) { return y * std::pow(x, y - 1); },
        [](D x, D y) { return std::pow(x, y) * std::log(x); }),
    row<[](auto x, auto y) {
      using core::abs;
      return abs(x) * y;
    }>(
        "abs", -2, [](D x, D y) { return x < 0 ? -y : y; }, [](D x, D) { return std::abs(x); }),
    row<[](auto x, auto y) {
      using core::max;
      using core::min;
      return max(x, y) * 2.0 + min(x, y) + max(x, 0.5) + min(y, 0.25);
    }>(
        "min, max", -2, [](D x, D y) { return (x > y ? 2.0 : 1.0) + (x > 0.5 ? 1 : 0); },
        [](D x, D y) { return (x > y ? 1.0 : 2.0) + (y < 0.25 ? 1 : 0); }),
    row<[](auto x, auto y) {
      using core::floor;
      return floor(x) + y;
    }>(
        "floor", -2, [](D, D) { return 0.0; }, [](D, D) { return 1.0; }),
    row<[](auto x, auto y) { return core::select(x < y, x * y, 7.0) + core::select(x >= 1.0, 2.0, y); }>(
        "select", -2, [](D x, D y) { return x < y ? y : 0; },
        [](D x, D y) { return (x < y ? x : 0) + (x >= 1 ? 0.0 : 1.0); }),
};

template <int N>
Dual<double, N> variable(double x, int k) {
  Dual<double, N> v(x);
  v.d[k] = 1;
  return v;
}

}  // namespace

TEST_CASE("the parts above and below zero have one derivative together at zero", "[core][dual]") {
  const auto x = variable<1>(0, 0);
  CHECK((max(x, 0.0) + min(x, 0.0)).d[0] == 1);
  CHECK((max(x, 0.0) + min(x, 0.0)).v == 0);
}

TEST_CASE("dual numbers carry the derivatives of every operation", "[core][dual]") {
  std::mt19937 random(3);
  for (const Row& r : rows) {
    INFO(r.name);
    std::uniform_real_distribution<double> argument(r.lowest, 2);
    for (int i = 0; i < 200; ++i) {
      Dual<Lanes<4>, 2> x, y;
      for (int lane = 0; lane < 4; ++lane) {
        const double u = argument(random), w = argument(random);
        x.v.set(lane, u), x.d[0].set(lane, 1), x.d[1].set(lane, 0);
        y.v.set(lane, w), y.d[0].set(lane, 0), y.d[1].set(lane, 1);
        const Dual<double, 2> scalar = r.scalar(variable<2>(u, 0), variable<2>(w, 1));
        CHECK(scalar.v == Approx(r.value(u, w)).epsilon(1e-14).margin(1e-14));
        CHECK(scalar.d[0] == Approx(r.by_x(u, w)).epsilon(1e-13).margin(1e-14));
        CHECK(scalar.d[1] == Approx(r.by_y(u, w)).epsilon(1e-13).margin(1e-14));
      }
      const Dual<Lanes<4>, 2> vector = r.vector(x, y);
      for (int lane = 0; lane < 4; ++lane) {
        const double u = x.v[lane], w = y.v[lane];
        CHECK(vector.v[lane] == Approx(r.value(u, w)).epsilon(1e-14).margin(1e-14));
        CHECK(vector.d[0][lane] == Approx(r.by_x(u, w)).epsilon(1e-13).margin(1e-14));
        CHECK(vector.d[1][lane] == Approx(r.by_y(u, w)).epsilon(1e-13).margin(1e-14));
      }
    }
  }
}

TEST_CASE("a dual number without a derivative has a derivative of zero, not NaN", "[core][dual]") {
  const auto zero = variable<1>(0, 0);
  CHECK(sqrt(zero).v == 0);
  CHECK(sqrt(zero).d[0] == 0);
  CHECK(exp(0.5 * log(zero)).v == 0);  // 0^0.5, as the laws write it
  CHECK(exp(0.5 * log(zero)).d[0] == 0);
  CHECK(pow(zero, 0.5).d[0] == 0);
  CHECK(pow(zero, 1.0).d[0] == 1);
  CHECK(pow(zero, 2.0).d[0] == 0);
  CHECK(pow(zero, Dual<double, 1>(2.0)).d[0] == 0);
}

TEST_CASE("what select does not choose leaves no trace in a dual number", "[core][dual]") {
  const auto x = variable<2>(2, 0);
  Dual<double, 2> bad(nan);
  bad.d[0] = nan, bad.d[1] = inf;
  for (const Dual<double, 2>& chosen :
       {select(true, x, bad), select(false, bad, x), min(bad, x), max(bad, x)}) {
    CHECK(chosen.v == 2);
    CHECK(chosen.d[0] == 1);
    CHECK(chosen.d[1] == 0);
  }
  CHECK(select(true, 3.0, bad).d[1] == 0);
  // Below the yield surface 0/0 counts as no flow.
  const auto scale = min(x * 0.0 / (x * 0.0), 1.0);
  CHECK(scale.v == 1);
  CHECK(scale.d[0] == 0);
}

TEST_CASE("dual numbers compare by their values", "[core][dual]") {
  const auto x = variable<2>(1, 0), y = variable<2>(1, 1);
  CHECK((x == y && x <= y && x >= y && !(x != y) && !(x < y) && !(x > y) && x < 2.0 && 0.5 < x));
  static_assert(core::derivatives_of<Dual<double, 2>> == 2 && core::derivatives_of<Lanes<4>> == 0);
  static_assert(core::LaneTraits<Dual<Lanes<4>, 2>>::width == 4);
  static_assert(std::is_same_v<core::MaskOf<Dual<Lanes<4>, 2>>, core::MaskOf<Lanes<4>>>);
}

TEST_CASE("dual numbers lie in memory as values, each derivative at a fixed distance", "[core][dual]") {
  using Value = Dual<Lanes<4>, 2>;
  std::vector<double> memory(3 * core::shadow_distance, -1.0);
  for (int part = 0; part < 3; ++part) {
    for (int lane = 0; lane < 4; ++lane)
      memory[static_cast<std::size_t>(part * core::shadow_distance + 8 + lane)] = 10 * part + lane;
  }
  const auto x = core::load<Value>(memory.data() + 8);
  for (int lane = 0; lane < 4; ++lane) {
    CHECK(x.v[lane] == lane);
    CHECK(x.d[0][lane] == 10 + lane);
    CHECK(x.d[1][lane] == 20 + lane);
  }
  core::store(memory.data() + 16, 2.0 * x);
  const auto y = core::load<Value>(memory.data() + 16);
  CHECK((y.v[1] == 2 && y.d[0][1] == 22 && y.d[1][3] == 46));
  CHECK((memory[15] == -1 && memory[20] == -1));
}

TEST_CASE("the derivatives of a root follow from its equation", "[core][dual]") {
  // x^3 = p, so dx/dp = 1/(3 x^2).
  const auto p = variable<1>(8, 0);
  const Dual<double, 1> x(2.0), root = implicit_root(x, p - x * x * x, 3.0 * x * x);
  CHECK(root.v == 2);
  CHECK(root.d[0] == Approx(1.0 / 12).epsilon(1e-15));
}

}  // namespace mpm::tests
