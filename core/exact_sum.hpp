// A sum of doubles that does not depend on their order: every addend is added without rounding to a wide
// fixed-point number. Energies and momenta are therefore bitwise identical for any ranks, threads and
// partition.
//
// The number is stored in 68 limbs of 32 bits, each in a 64-bit integer, from 2^-1088 up; the spare bits
// allow 2^30 additions before carries must be propagated, and ranks are combined by adding limbs as integers.
// After U. Kulisch's long accumulator (Computer Arithmetic and Validity, de Gruyter, 2008).
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace mpm::core {

class ExactSum {
 public:
  static constexpr int limbs = 68;

  /// After a NaN or an infinity value() is NaN.
  void add(double x);
  ExactSum& operator+=(const ExactSum& other);
  void negate() {
    for (int i = 0; i < limbs; ++i) limb_[static_cast<std::size_t>(i)] *= -1;
  }
  /// The sum, rounded once.
  double value() const;

  /// For communication and restart files: limbs to be added entry by entry; the last one counts non-finite
  /// addends.
  std::span<std::int64_t> raw() { return limb_; }
  std::span<const std::int64_t> raw() const { return limb_; }
  /// Propagates carries, so that limbs may be added over up to 2^30 ranks.
  void normalise();

 private:
  std::array<std::int64_t, limbs + 1> limb_{};
  std::uint32_t additions_ = 0;
};

}  // namespace mpm::core
