// Timing of the benchmarks: CPU and wall time, several repeats, best and median.
// With one thread its CPU time is used, which other load disturbs least. With more, waiting threads may sleep
// or spin, so only wall time is meaningful: core time is then wall time multiplied by threads.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <time.h>

namespace mpm::benchmarks {

inline double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Seconds {
  double cpu = 0;  ///< of the calling thread
  double wall = 0;
  static Seconds now() { return {seconds_of(CLOCK_THREAD_CPUTIME_ID), seconds_of(CLOCK_MONOTONIC)}; }
  friend Seconds operator-(Seconds a, Seconds b) { return {a.cpu - b.cpu, a.wall - b.wall}; }
  Seconds& operator+=(Seconds o) {
    cpu += o.cpu;
    wall += o.wall;
    return *this;
  }
  /// Time that the cores have spent.
  double of_cores(int threads) const { return threads == 1 ? cpu : wall * threads; }
};

/// Several measurements of one thing.
class Series {
 public:
  void add(double x) { values_.push_back(x); }
  std::size_t size() const { return values_.size(); }
  double last() const { return values_.back(); }
  double best() const {
    return values_.empty() ? std::numeric_limits<double>::quiet_NaN()
                           : *std::min_element(values_.begin(), values_.end());
  }
  double median() const {
    if (values_.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> sorted = values_;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t n = sorted.size();
    return n % 2 == 1 ? sorted[n / 2] : 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]);
  }
  /// Standard error of the median, from the median distance to it, as if the values were normally
  /// distributed.
  double error_of_median() const {
    Series distances;
    for (const double x : values_) distances.add(std::abs(x - median()));
    return 1.2533 * 1.4826 * distances.median() / std::sqrt(static_cast<double>(values_.size()));
  }
  std::size_t index_of_best() const {
    return static_cast<std::size_t>(std::min_element(values_.begin(), values_.end()) - values_.begin());
  }

 private:
  std::vector<double> values_;
};

/// Prevents the compiler from eliminating the computation of `x`.
template <class T>
inline void keep(const T& x) {
  asm volatile("" : : "r"(&x) : "memory");
}

}  // namespace mpm::benchmarks
