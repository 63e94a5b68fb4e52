#include "io/output/interval_means.hpp"

#include <catch2/catch.hpp>

namespace mpm::io {
namespace {

using Values = std::vector<double>;
using Names = std::vector<std::string>;

TEST_CASE("Means over the intervals between rows") {
  const Names names{"fx[drive:a]", "fy[drive:a]"};
  IntervalMeans means(2, names);
  CHECK(means.next(0, Values{0, 0}) == Values{0, 0});
  CHECK(means.next(2, Values{6, -1}) == Values{3, -0.5});
  CHECK(means.next(2.5, Values{6, 1}) == Values{0, 4});
  SECTION("the same row again") { CHECK(means.next(2.5, Values{6, 1}) == Values{0, 4}); }
  SECTION("after a restart") {
    IntervalMeans again(2, names);
    again.recall(means.memory());
    CHECK(again.next(2.5, Values{6, 1}) == Values{0, 4});
    CHECK(again.next(3, Values{7, 1}) == Values{2, 0});
  }
  SECTION("after a restart without memory of these sums, since the restart") {
    IntervalMeans again(2, {"fx[drive:b]", "fy[drive:b]"});
    again.begin(3, Values{5, 1});
    again.recall(means.memory());
    again.recall(IntervalMeans(3, names).memory());
    CHECK(again.next(3, Values{5, 1}) == Values{0, 0});
    CHECK(again.next(5, Values{6, 2}) == Values{0.5, 0.5});
  }
}

TEST_CASE("The time of impulses is that of the positions where steps have one length") {
  core::Clock clock;
  CHECK(impulse_time(clock) == 0);
  clock.time = 0.3;
  clock.lag = clock.first_lag = 0.05;
  CHECK(impulse_time(clock) == 0.3);
  clock.lag = 0.02;
  CHECK(impulse_time(clock) == 0.3 + (0.05 - 0.02));
}

TEST_CASE("No sums, no means and no memory") {
  IntervalMeans means;
  CHECK(means.next(1, {}).empty());
  CHECK(means.memory().empty());
  CHECK(means.empty());
}

}  // namespace
}  // namespace mpm::io
