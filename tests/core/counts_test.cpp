// Products of users' counts, and what is asked of the parts of the grid.
#include "core/counts.hpp"

#include <limits>

#include <catch2/catch.hpp>

#include "core/communication/solo.hpp"
#include "core/scene/errors.hpp"

using namespace mpm::core;

TEST_CASE("A product that does not fit is none, whatever it is modulo 2^64") {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  CHECK(product_of({}) == 1);
  CHECK(product_of({3, 4, 5}) == 60);
  CHECK(product_of({-3, 4}) == -12);
  CHECK(product_of({most, 1, 1}) == most);
  CHECK(product_of({most, 0, most}) == 0);
  CHECK_FALSE(product_of({most, 2, 1}));
  CHECK_FALSE(product_of({std::int64_t{1} << 32, std::int64_t{1} << 32, 0x7fff}));
  CHECK_FALSE(product_of({47205953, 1562003, 64544731}));  // 1 modulo 2^64
}

TEST_CASE("Parts of the grid whose number does not fit in 64 bits are not the ranks") {
  DecompositionInput how;
  how.dimensions = {{47205953, 1562003, 64544731}};
  CHECK_THROWS_WITH(check_decomposition(how, 1),
                    Catch::Contains("more than 2^63") && Catch::Contains("which is 1"));
  how.dimensions = {{-2, -2, 1}};
  CHECK_THROWS_AS(check_decomposition(how, 4), InputErrors);
  how.dimensions = {{2, 2, 1}};
  CHECK_NOTHROW(check_decomposition(how, 4));
  CHECK_THROWS_WITH(check_decomposition(how, 3), Catch::Contains(" = 4 must equal"));
}
