// Global reductions: sums, extremes, and the status that ends a step. Every result is the same on every rank
// and, except for `spread`, independent of their number.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/exact_sum.hpp"

namespace mpm::core {

/// What a rank reports at the end of a step.
struct StepStatus {
  double stable_step = 0;     ///< largest stable step of its particles; the smallest of all ranks counts
  bool needs_bricks = false;  ///< one of its particles enters a brick that it does not know
  bool failed = false;        ///< the run cannot continue
  bool stop = false;          ///< a stop was requested
};

/// Spread of a measured value over the ranks, such as seconds or bytes; not reproducible.
struct Spread {
  double min = 0, mean = 0, max = 0;
};

class Reductions {
 public:
  virtual ~Reductions() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;

  /// True on every rank if `mine` is true on any. Collective.
  virtual bool any(bool mine) = 0;
  /// Smallest of every entry over the ranks, in place. Exact; a NaN on any rank is the result on all, and -0
  /// is less than 0. Collective.
  virtual void minimum(std::span<double> values) = 0;
  /// Sum of every entry over the ranks, in place. Collective.
  virtual void sum(std::span<std::int64_t> values) = 0;
  /// The sums are normalised, so their limbs are also the same on any ranks. Collective.
  virtual void sum(std::span<ExactSum> values) = 0;
  /// The smallest step; each flag is true if it is on any rank. Collective.
  virtual StepStatus combine(const StepStatus& mine) = 0;

  /// One line per rank to all ranks, in the order of ranks; for messages that name a particle. Collective.
  virtual std::vector<std::string> gather(const std::string& mine) = 0;
  /// Collective.
  virtual Spread spread(double mine) = 0;

  /// Of one value. Collective.
  double smallest(double mine) {
    minimum(std::span(&mine, 1));
    return mine;
  }
  double largest(double mine) { return -smallest(-mine); }
};

}  // namespace mpm::core
