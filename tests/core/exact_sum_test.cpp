// The exact sum against __float128, where that is exact too, and against what must hold for any sum.
#include "core/exact_sum.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

using mpm::core::ExactSum;

namespace {

using Limits = std::numeric_limits<double>;
__extension__ using Wide = __float128;

ExactSum sum_of(const std::vector<double>& values) {
  ExactSum sum;
  for (const double x : values) sum.add(x);
  return sum;
}

double value_of(const std::vector<double>& values) { return sum_of(values).value(); }

}  // namespace

TEST_CASE("An exact sum is the sum in 113 bits where those suffice, rounded once") {
  std::mt19937_64 random(1);
  // 53 bits, 2^40 between the largest and the smallest exponent and 2^10 addends: 103 bits.
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-20, 20);
  for (int trial = 0; trial < 200; ++trial) {
    const int offset = 40 * (trial % 40) - 800;
    std::vector<double> values;
    Wide wide = 0;
    for (int i = 0; i < 1000; ++i) {
      // Whole multiples of 2^(offset - 73): nothing is below the last of the 113 bits.
      const double x =
          std::ldexp(std::nearbyint(std::ldexp(mantissa(random), exponent(random) + 53)), offset - 73);
      values.push_back(x);
      wide += x;
    }
    REQUIRE(value_of(values) == static_cast<double>(wide));
  }
}

TEST_CASE("An exact sum does not depend on the order of its addends nor on partial sums") {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<std::uint64_t> any_bits;
  std::vector<double> values;
  while (values.size() < 3000) {  // all exponents, both signs, subnormal numbers too
    std::uint64_t bits = any_bits(random);
    if (values.size() % 100 == 0) bits &= ~(std::uint64_t{0x7ff} << 52);
    double x = 0;
    std::memcpy(&x, &bits, sizeof x);
    if (std::isfinite(x)) values.push_back(x / 4096);
  }
  const double once = value_of(values);
  REQUIRE(std::isfinite(once));
  for (int trial = 0; trial < 20; ++trial) {
    std::shuffle(values.begin(), values.end(), random);
    REQUIRE(value_of(values) == once);
    ExactSum parts[5];
    for (std::size_t i = 0; i < values.size(); ++i) parts[i % 5].add(values[i]);
    ExactSum all;
    for (const ExactSum& part : parts) all += part;
    REQUIRE(all.value() == once);
    ExactSum limbs;  // as ranks are combined
    for (ExactSum& part : parts) {
      part.normalise();
      for (std::size_t i = 0; i < part.raw().size(); ++i) limbs.raw()[i] += part.raw()[i];
    }
    REQUIRE(limbs.value() == once);
  }
  std::vector<double> both = values;
  for (const double x : values) both.push_back(-x);
  std::shuffle(both.begin(), both.end(), random);
  REQUIRE(value_of(both) == 0);
}

TEST_CASE("An exact sum keeps what cancellation leaves") {
  CHECK(value_of({1e300, 1, -1e300}) == 1);
  CHECK(value_of({-1e300, 5e-324, 1e300}) == 5e-324);
  CHECK(value_of({Limits::max(), Limits::max(), -Limits::max()}) == Limits::max());
  CHECK(value_of({Limits::denorm_min(), Limits::denorm_min()}) == 2 * Limits::denorm_min());
  CHECK(value_of({Limits::min(), -Limits::denorm_min()}) == Limits::min() - Limits::denorm_min());
  CHECK(value_of({}) == 0);
  CHECK(value_of({0.0, -0.0}) == 0);
  CHECK(value_of({-3.25}) == -3.25);
  ExactSum doubled = sum_of({0.1, -7e20});
  doubled += doubled;
  CHECK(doubled.value() == 2 * value_of({0.1, -7e20}));
}

TEST_CASE("An exact sum rounds to nearest, ties to even, however far away what breaks the tie") {
  const double ulp = Limits::epsilon();
  CHECK(value_of({1, ulp / 2}) == 1);
  CHECK(value_of({1 + ulp, ulp / 2}) == 1 + 2 * ulp);
  CHECK(value_of({1, ulp / 2, 5e-324}) == 1 + ulp);
  CHECK(value_of({1, ulp / 2, -5e-324}) == 1);
  CHECK(value_of({-1, -ulp / 2, -5e-324}) == -1 - ulp);
  CHECK(value_of({-1, -ulp / 2, 5e-324}) == -1);
}

TEST_CASE("An exact sum beyond the range of doubles is infinite; what is no number poisons it for good") {
  CHECK(value_of({Limits::max(), Limits::max()}) == Limits::infinity());
  CHECK(value_of({-Limits::max(), -Limits::max()}) == -Limits::infinity());
  for (const double poison : {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()}) {
    CHECK(std::isnan(value_of({1, poison, 2})));
    ExactSum sum = sum_of({poison});
    sum += sum_of({3});
    sum.normalise();
    CHECK(std::isnan(sum.value()));
  }
  CHECK(std::isnan(value_of({Limits::infinity(), -Limits::infinity()})));
}
