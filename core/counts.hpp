// Products of counts from the input.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>

namespace mpm::core {

/// The product, or nothing where it does not fit in 64 bits: computed modulo 2^64 it might equal the expected
/// number by accident.
constexpr std::optional<std::int64_t> product_of(std::initializer_list<std::int64_t> counts) {
  std::int64_t product = 1;
  for (const std::int64_t n : counts) {
    if (n == 0) return 0;
  }
  for (const std::int64_t n : counts) {
    if (__builtin_mul_overflow(product, n, &product)) return {};
  }
  return product;
}

}  // namespace mpm::core
