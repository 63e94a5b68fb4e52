#include "core/discretise/grading.hpp"

#include <algorithm>
#include <cmath>

#include "core/discretise/line.hpp"

namespace mpm::core {

Grading::Grading(double bottom, double top, double height) : first_(bottom) {
  if (std::abs(top - bottom) <= 1e-12 * bottom) {  // round-off of the input, or of a change of units
    layers_ = whole_count(height, bottom);
    return;
  }
  if (height <= std::max(bottom, top)) {
    first_ = std::sqrt(bottom * top);
    return;
  }
  // Sum of the series: height = (factor top - bottom)/(factor - 1), and top = bottom factor^(layers - 1).
  const double log_top = std::log1p((top - bottom) / bottom);
  layers_ = 1 + std::fmax(1, std::floor(log_top / std::log1p((top - bottom) / (height - top)) + 0.5));
  log_ratio_ = log_top / (layers_ - 1);
}

double Grading::thickness(double k) const { return uniform() ? first_ : first_ * std::exp(k * log_ratio_); }

double Grading::lower(double k) const {
  return uniform() ? first_ * k : first_ * std::expm1(k * log_ratio_) / std::expm1(log_ratio_);
}

}  // namespace mpm::core
