// Means of sums since time zero over the intervals between the rows of a table: mean times interval, summed
// over the rows, is the sum. Tested by tests/io/output/interval_means_test.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/model.hpp"

namespace mpm::io {

/// Up to which the impulses act that the velocities hold: with steps of one length the time of the positions
/// (core/step/step_length.hpp). Each explicit step advances it by the time of its impulses.
inline double impulse_time(const core::Clock& clock) { return clock.time + (clock.first_lag - clock.lag); }

class IntervalMeans {
 public:
  IntervalMeans() = default;
  /// `names`: of the columns, to recognise a memory of other sums.
  IntervalMeans(std::size_t sums, const std::vector<std::string>& names);

  /// The next means are since this time, with the sums until then. Without a call, since time zero.
  void begin(double time, std::span<const double> sums);
  /// The means over the time since the row before, by number of the sum; zero without such time. A row at the
  /// time of the last one has the same interval.
  std::vector<double> next(double time, std::span<const double> sums);

  /// State for restart files: a hash of the names, the last row and the one before; empty without sums.
  std::vector<std::uint64_t> memory() const;
  /// Changes nothing if `memory` is of other sums.
  void recall(std::span<const std::uint64_t> memory);
  bool empty() const { return last_.empty(); }

 private:
  std::uint64_t key_ = 0;
  std::vector<double> last_, earlier_;  ///< rows: time, then the sums until then
};

}  // namespace mpm::io
