// Means of sums since time zero over the intervals between the rows of a table: mean times interval, summed
// over the rows, is the sum. Tested by tests/io/output/interval_means_test.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace mpm::io {

class IntervalMeans {
 public:
  IntervalMeans() = default;
  explicit IntervalMeans(std::size_t sums);

  /// The means over the time since the row before, by number of the sum; zero at time zero. A row at the time
  /// of the last one has the same interval.
  std::vector<double> next(double time, std::span<const double> sums);

  /// State for restart files: the last row and the one before; empty without sums.
  std::vector<std::uint64_t> memory() const;
  std::size_t memory_length() const { return last_.size() + earlier_.size(); }
  /// `memory` has memory_length() entries; of another length it is not of these sums, and the next means are
  /// since time zero.
  void recall(std::span<const std::uint64_t> memory);

 private:
  std::vector<double> last_, earlier_;  ///< rows: time, then the sums until then
};

}  // namespace mpm::io
