#include "io/output/interval_means.hpp"

#include <catch2/catch.hpp>

namespace mpm::io {
namespace {

using Values = std::vector<double>;

TEST_CASE("Means over the intervals between rows") {
  IntervalMeans means(2);
  CHECK(means.next(0, Values{0, 0}) == Values{0, 0});
  CHECK(means.next(2, Values{6, -1}) == Values{3, -0.5});
  CHECK(means.next(2.5, Values{6, 1}) == Values{0, 4});
  SECTION("the same row again") { CHECK(means.next(2.5, Values{6, 1}) == Values{0, 4}); }
  SECTION("after a restart") {
    IntervalMeans again(2);
    CHECK(means.memory().size() == again.memory_length());
    again.recall(means.memory());
    CHECK(again.next(2.5, Values{6, 1}) == Values{0, 4});
    CHECK(again.next(3, Values{7, 1}) == Values{2, 0});
  }
  SECTION("after a restart without memory of these sums, since time zero") {
    IntervalMeans again(2);
    again.recall(IntervalMeans(3).memory());
    CHECK(again.next(4, Values{6, 2}) == Values{1.5, 0.5});
  }
}

TEST_CASE("No sums, no means and no memory") {
  IntervalMeans means;
  CHECK(means.next(1, {}).empty());
  CHECK(means.memory().empty());
  CHECK(means.memory_length() == 0);
}

}  // namespace
}  // namespace mpm::io
