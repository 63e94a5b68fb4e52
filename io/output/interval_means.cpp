#include "io/output/interval_means.hpp"

#include <algorithm>
#include <bit>

#include "io/output/hash.hpp"

namespace mpm::io {

IntervalMeans::IntervalMeans(std::size_t sums, const std::vector<std::string>& names)
    : last_(sums > 0 ? 1 + sums : 0), earlier_(last_) {
  Hash hash;
  for (const std::string& name : names) hash.add(name);
  key_ = hash.value();
}

void IntervalMeans::begin(double time, std::span<const double> sums) {
  if (sums.empty()) return;
  last_[0] = time;
  std::ranges::copy(sums, last_.begin() + 1);
  earlier_ = last_;
}

std::vector<double> IntervalMeans::next(double time, std::span<const double> sums) {
  if (sums.empty()) return {};
  if (time > last_[0]) {
    earlier_ = last_;
    last_[0] = time;
  }
  std::ranges::copy(sums, last_.begin() + 1);
  const double interval = last_[0] - earlier_[0];
  std::vector<double> means(sums.size());
  for (std::size_t i = 0; i < means.size() && interval > 0; ++i)
    means[i] = (last_[i + 1] - earlier_[i + 1]) / interval;
  return means;
}

std::vector<std::uint64_t> IntervalMeans::memory() const {
  if (empty()) return {};
  std::vector<std::uint64_t> memory{key_};
  for (const std::vector<double>* row : {&last_, &earlier_})
    for (const double value : *row) memory.push_back(std::bit_cast<std::uint64_t>(value));
  return memory;
}

void IntervalMeans::recall(std::span<const std::uint64_t> memory) {
  if (empty() || memory.size() != 1 + last_.size() + earlier_.size() || memory[0] != key_) return;
  auto next = memory.begin() + 1;
  for (std::vector<double>* row : {&last_, &earlier_})
    for (double& value : *row) value = std::bit_cast<double>(*next++);
}

}  // namespace mpm::io
