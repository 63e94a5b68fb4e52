// A fast 64-bit hash over words. A single changed word always changes the result: each step is bijective in
// the word and in the previous state.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace mpm::io {

class Hash {
 public:
  void add(std::uint64_t word) { state_ = std::rotl(state_ ^ word, 29) * 0x9e3779b97f4a7c15u; }
  void add(const double* values, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) add(std::bit_cast<std::uint64_t>(values[i]));
  }
  /// The bytes and their number.
  void add(std::string_view bytes) {
    std::size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) add(word(bytes.data() + at, 8));
    if (at < bytes.size()) add(word(bytes.data() + at, bytes.size() - at));
    add(static_cast<std::uint64_t>(bytes.size()));
  }
  std::uint64_t value() const {
    std::uint64_t h = state_ ^ (state_ >> 32);
    h *= 0xd6e8feb86659fd93u;
    return h ^ (h >> 32);
  }

 private:
  static std::uint64_t word(const char* bytes, std::size_t n) {
    std::uint64_t w = 0;
    std::memcpy(&w, bytes, n);
    return w;
  }
  std::uint64_t state_ = 0x243f6a8885a308d3u;
};

}  // namespace mpm::io
