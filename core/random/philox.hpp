// Counter-based random numbers: Philox4x32-10 (Salmon, Moraes, Dror and Shaw, SC11 (2011), 4.3) turns a
// counter and a key into four random words. A draw is a pure function of its purpose, such as a particle's
// identity, and therefore the same on any number of ranks and in any order. Shown by
// tests/core/random/philox_test.cpp.
#pragma once

#include <array>
#include <cstdint>

namespace mpm::core {

constexpr std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * counter[0],
                        b = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key = {key[0] + 0x9E3779B9u, key[1] + 0xBB67AE85u};
  }
  return counter;
}

/// Two numbers in the open interval (0, 1) for the `item`-th draw of a kind.
constexpr std::array<double, 2> uniform_pair(std::uint64_t item, std::uint32_t kind, std::uint64_t seed) {
  const auto low = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
  const auto word = philox4x32({low(item), low(item >> 32), kind, 0}, {low(seed), low(seed >> 32)});
  const auto unit = [](std::uint32_t high, std::uint32_t rest) {
    const std::uint64_t bits = (std::uint64_t{high} << 32 | rest) >> 12;
    return (static_cast<double>(bits) + 0.5) * 0x1p-52;
  };
  return {unit(word[0], word[1]), unit(word[2], word[3])};
}

}  // namespace mpm::core
