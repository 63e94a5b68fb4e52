// Philox4x32-10 against the known answers that its authors publish, and its uniform numbers.

#include "core/random/philox.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

namespace mpm::tests {

TEST_CASE("Philox4x32-10 gives the published answers", "[core][random]") {
  // Random123 (D. E. Shaw Research), file tests/kat_vectors, lines "philox4x32 10".
  using Words = std::array<std::uint32_t, 4>;
  CHECK(core::philox4x32({0, 0, 0, 0}, {0, 0}) == Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  const std::uint32_t ones = 0xffffffff;
  CHECK(core::philox4x32({ones, ones, ones, ones}, {ones, ones}) ==
        Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(core::philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("uniform pairs fill the open unit square evenly and without correlation", "[core][random]") {
  constexpr int n = 100000, bins = 10;
  std::vector<int> count(bins * bins, 0);
  double product = 0, next_product = 0, last = 0.5;
  for (int i = 0; i < n; ++i) {
    const auto [u, v] = core::uniform_pair(static_cast<std::uint64_t>(i), 1, 7);
    REQUIRE((u > 0 && u < 1 && v > 0 && v < 1));
    ++count[static_cast<std::size_t>(bins * static_cast<int>(bins * u) + static_cast<int>(bins * v))];
    product += (u - 0.5) * (v - 0.5);
    next_product += (u - 0.5) * (last - 0.5);
    last = u;
  }
  double chi2 = 0;
  for (const int c : count) chi2 += std::pow(c - n / 100.0, 2) / (n / 100.0);
  CHECK(chi2 > 61.1);   // 99 degrees of freedom: 0.1 % below this
  CHECK(chi2 < 148.2);  // and 0.1 % above this
  // Correlation coefficients scatter by 1/sqrt(n) = 0.0032.
  CHECK(std::abs(12 * product / n) < 0.01);
  CHECK(std::abs(12 * next_product / n) < 0.01);
  CHECK(core::uniform_pair(3, 1, 7) != core::uniform_pair(3, 2, 7));
  CHECK(core::uniform_pair(3, 1, 7) != core::uniform_pair(3, 1, 8));
  CHECK(core::uniform_pair(3, 1, 7) != core::uniform_pair(3 + (std::uint64_t{1} << 32), 1, 7));
}

}  // namespace mpm::tests
