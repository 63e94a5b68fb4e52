// Numbers for pictures: what is beyond the type that is written becomes its largest, and is counted; so no
// picture holds an infinity. A quantity that has no value (a ratio of two overflows) becomes 0 and counts
// too.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/communication/reductions.hpp"

namespace mpm::io {

/// `counted` grows by one where the value had to be changed by more than rounding.
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

/// Which variables of a file were cut, for the log.
class CutValues {
 public:
  /// `mine`: counts of the picture just written on this rank, as `names`. One line when a variable is cut for
  /// the first time, else empty; the same on all ranks. Collective.
  std::string warning(const std::string& file, std::int64_t step, const std::vector<std::string>& names,
                      std::vector<std::int64_t> mine, core::Reductions& ranks);
  /// How many values were cut in all pictures; empty if there were none.
  std::string total(const std::string& file) const;

 private:
  std::map<std::string, std::int64_t> counts_;
};

}  // namespace mpm::io
