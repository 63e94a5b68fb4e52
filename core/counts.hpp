// Products of counts that a user gives.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>

namespace mpm::core {

/// The product, or nothing where it does not fit in 64 bits: computed modulo 2^64 it may happen to be the
/// number that is asked for.
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
