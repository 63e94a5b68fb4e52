#include <bit>
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "parallel/communication.hpp"
#include "tests/parallel/world.hpp"

using namespace mpm::parallel;
using namespace mpm::parallel::test;

TEST_CASE("Exact sums over ranks have the bits of the serial sum") {
  MpiCommunication exchange(world());
  std::mt19937_64 random(1);
  std::vector<mpm::core::ExactSum> serial(3), parallel(3);
  for (int i = 0; i < 30000; ++i) {
    // Magnitudes from subnormal to 1e300, so that any rounded sum would depend on the order.
    const double x =
        std::ldexp(std::uniform_real_distribution<>(-1, 1)(random), static_cast<int>(random() % 2050) - 1060);
    serial[static_cast<std::size_t>(i % 3)].add(x);
    if (static_cast<int>(random() % static_cast<unsigned>(world().size())) == world().rank()) {
      parallel[static_cast<std::size_t>(i % 3)].add(x);
    }
  }
  exchange.reductions.sum(std::span(parallel));
  for (std::size_t i = 0; i < serial.size(); ++i) {
    CHECK(std::bit_cast<std::uint64_t>(parallel[i].value()) ==
          std::bit_cast<std::uint64_t>(serial[i].value()));
    serial[i].normalise();
    CHECK(std::ranges::equal(parallel[i].raw(), serial[i].raw()));
  }
}

TEST_CASE("One addend that is not a number poisons the sum on every rank") {
  MpiCommunication exchange(world());
  mpm::core::ExactSum sum;
  sum.add(world().rank() == world().size() - 1 ? std::nan("") : 1.0);
  exchange.reductions.sum(std::span(&sum, 1));
  CHECK(std::isnan(sum.value()));
}

TEST_CASE("Integer sums are exact beyond the reach of a double") {
  MpiCommunication exchange(world());
  std::vector<std::int64_t> values{(std::int64_t{1} << 53) + 1, world().rank(), -1};
  exchange.reductions.sum(std::span(values));
  const std::int64_t n = world().size();
  CHECK(values == std::vector<std::int64_t>{n * ((std::int64_t{1} << 53) + 1), n * (n - 1) / 2, -n});
}

TEST_CASE("The minimum is exact, and not a number wins from every rank") {
  MpiCommunication exchange(world());
  const double inf = std::numeric_limits<double>::infinity();
  const double tiny = std::numeric_limits<double>::denorm_min();
  const auto agrees = [&](auto of_rank, double expected) {
    double value = of_rank(world().rank());
    exchange.reductions.minimum(std::span(&value, 1));
    return std::bit_cast<std::uint64_t>(value) == std::bit_cast<std::uint64_t>(expected);
  };
  const int last = world().size() - 1;
  CHECK(agrees([](int r) { return 1.0 + r; }, 1.0));
  CHECK(agrees([](int r) { return -1.0 - r; }, -1.0 - last));
  CHECK(agrees([&](int r) { return r == last ? tiny : 1.0; }, tiny));
  CHECK(agrees([&](int r) { return r == last ? -tiny : 0.0; }, -tiny));
  CHECK(agrees([&](int r) { return r == last ? -0.0 : 0.0; }, -0.0));
  CHECK(agrees([&](int) { return inf; }, inf));
  CHECK(agrees([&](int r) { return r == last ? -inf : -1e308; }, -inf));
  for (int bad = 0; bad <= last; ++bad) {
    for (const double nan : {std::nan(""), -std::nan("7")}) {
      std::vector<double> values{1.0 * world().rank(), world().rank() == bad ? nan : -inf};
      exchange.reductions.minimum(std::span(values));
      CHECK(values[0] == 0);
      CHECK(std::isnan(values[1]));
    }
  }
}

TEST_CASE("Any, gather and spread") {
  MpiCommunication exchange(world());
  CHECK(exchange.reductions.rank() == world().rank());
  CHECK(exchange.reductions.size() == world().size());
  const int last = world().size() - 1;
  CHECK_FALSE(exchange.reductions.any(false));
  for (int r = 0; r <= last; ++r) CHECK(exchange.reductions.any(r == world().rank()));

  const auto line = [](int r) {
    return r == 1 ? std::string() : std::string(static_cast<std::size_t>(3 * r + 1), 'a');
  };
  const std::vector<std::string> lines = exchange.reductions.gather(line(world().rank()));
  REQUIRE(lines.size() == static_cast<std::size_t>(world().size()));
  for (int r = 0; r <= last; ++r) CHECK(lines[static_cast<std::size_t>(r)] == line(r));

  const auto spread = exchange.reductions.spread(world().rank());
  CHECK(spread.min == 0);
  CHECK(spread.mean == 0.5 * last);
  CHECK(spread.max == last);
}
