#include "core/discretise/rows.hpp"

#include <algorithm>
#include <stdexcept>

namespace mpm::core {

bool RowSource::set_extent(double rows, double width) {
  // Written so that infinities and NaN count as too many.
  if (!(rows * width < static_cast<double>(identity_limit))) {
    identities_ = identity_limit;
    return false;
  }
  if (rows * width >= 1) {
    rows_ = static_cast<std::uint64_t>(rows);
    width_ = static_cast<std::uint64_t>(width);
    identities_ = rows_ * width_;
  }
  return true;
}

void RowSource::generate(std::uint64_t first_unit, std::uint64_t last_unit, std::vector<Seed>& out) const {
  if (!numbered()) throw std::length_error("a body has more particles than can be numbered");
  const std::uint64_t end = std::min(last_unit, units()) * candidates_per_unit;
  const std::uint64_t last = std::min(end, identities_);
  std::uint64_t candidate = std::min(first_unit, units()) * candidates_per_unit;
  while (candidate < last) {
    const std::uint64_t row = candidate / width_;
    const std::uint64_t column = candidate % width_;
    const std::uint64_t stop = std::min(width_, column + (last - candidate));
    append_row(row, column, stop, out);
    candidate += stop - column;
  }
}

}  // namespace mpm::core
