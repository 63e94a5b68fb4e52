#include "core/exact_sum.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace mpm::core {

namespace {
constexpr int lowest_exponent = -1088;  // of bit 0 of limb 0; the smallest subnormal is 2^-1074
}

void ExactSum::add(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int field = static_cast<int>((bits >> 52) & 0x7ff);
  if (field == 0x7ff) {
    ++limb_[limbs];
    return;
  }
  std::uint64_t mantissa = bits & ((std::uint64_t{1} << 52) - 1);
  if (field != 0) mantissa |= std::uint64_t{1} << 52;
  // x = +-mantissa * 2^(max(field, 1) - 1075)
  const int shift = (field == 0 ? 1 : field) - 1075 - lowest_exponent;
  const std::size_t limb = static_cast<std::size_t>(shift / 32);
  const unsigned __int128 wide = static_cast<unsigned __int128>(mantissa) << (shift % 32);
  const std::int64_t sign = (bits >> 63) != 0 ? -1 : 1;
  constexpr std::uint64_t low = 0xffffffffu;
  limb_[limb] += sign * static_cast<std::int64_t>(static_cast<std::uint64_t>(wide) & low);
  limb_[limb + 1] += sign * static_cast<std::int64_t>(static_cast<std::uint64_t>(wide >> 32) & low);
  limb_[limb + 2] += sign * static_cast<std::int64_t>(static_cast<std::uint64_t>(wide >> 64) & low);
  if (++additions_ == (1u << 29)) normalise();
}

ExactSum& ExactSum::operator+=(const ExactSum& other) {
  ExactSum o = other;
  o.normalise();
  normalise();
  for (std::size_t i = 0; i <= limbs; ++i) limb_[i] += o.limb_[i];
  additions_ = 1;
  return *this;
}

void ExactSum::normalise() {
  for (std::size_t i = 0; i + 1 < limbs; ++i) {
    const std::int64_t carry = limb_[i] >> 32;  // floor, also for negative limbs
    limb_[i] -= carry * (std::int64_t{1} << 32);
    limb_[i + 1] += carry;
  }
  additions_ = 0;
}

double ExactSum::value() const {
  if (limb_[limbs] != 0) return std::numeric_limits<double>::quiet_NaN();
  ExactSum n = *this;
  n.normalise();
  const bool negative = n.limb_[limbs - 1] < 0;
  if (negative) {
    for (std::size_t i = 0; i < limbs; ++i) n.limb_[i] = -n.limb_[i];
    n.normalise();
  }
  std::size_t top = limbs;
  while (top > 0 && n.limb_[top - 1] == 0) --top;
  if (top == 0) return 0;
  // The leading 96 bits contain the whole mantissa; the lower ones can only break a tie.
  unsigned __int128 head = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    head <<= 32;
    if (top > i) head |= static_cast<std::uint64_t>(n.limb_[top - 1 - i]) & 0xffffffffu;
  }
  bool rest = false;
  for (std::size_t i = 0; i + 3 < top; ++i) rest = rest || n.limb_[i] != 0;
  if (rest) head |= 1;
  // 62 bits with the rest folded into the last one: the conversion to double then rounds once, to nearest.
  const int width = 128 - std::countl_zero(static_cast<std::uint64_t>(head >> 64));
  const int drop = width - 62;
  const bool sticky = (head & ((static_cast<unsigned __int128>(1) << drop) - 1)) != 0;
  const std::uint64_t mantissa = static_cast<std::uint64_t>(head >> drop) | (sticky ? 1 : 0);
  const int exponent = lowest_exponent + 32 * (static_cast<int>(top) - 3) + drop;
  const double magnitude = std::ldexp(static_cast<double>(mantissa), exponent);
  return negative ? -magnitude : magnitude;
}

}  // namespace mpm::core
