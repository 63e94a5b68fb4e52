// Conversion of values for particle files: values beyond the range of the output type are clipped to its
// largest number and counted, so that no file contains infinities. NaN (a ratio of two overflows) becomes 0
// and is counted too.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"

namespace mpm::io {

/// Increments `counted` if the value changes by more than rounding.
template <class T>
T narrowed(double value, std::int64_t& counted) {
  if constexpr (std::numeric_limits<T>::is_integer) {
    return static_cast<T>(value);
  } else {
    constexpr T most = std::numeric_limits<T>::max();
    if (std::abs(value) <= static_cast<double>(most)) return static_cast<T>(value);
    ++counted;
    return std::isnan(value) ? T(0) : static_cast<T>(std::copysign(static_cast<double>(most), value));
  }
}

/// Variables of a file that were clipped, for the log.
class CutValues {
 public:
  /// `mine`: counts of the last write on this rank, in the order of `names`. One line when a variable is
  /// clipped for the first time, else empty; the same on all ranks. Collective.
  std::string warning(const std::string& file, std::int64_t step, const std::vector<std::string>& names,
                      std::vector<std::int64_t> mine, core::Reductions& ranks);
  /// Total numbers of clipped values; empty if there were none.
  std::string total(const std::string& file) const;

 private:
  std::map<std::string, std::int64_t> counts_;
};

}  // namespace mpm::io
