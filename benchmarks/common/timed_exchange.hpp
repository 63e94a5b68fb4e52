// An exchange with a stopwatch on what a step asks of the other ranks, for the parts of communication in its
// time.
#pragma once

#include <array>
#include <string_view>
#include <type_traits>
#include <utility>

#include "benchmarks/common/clock.hpp"
#include "core/step/exchange.hpp"

namespace mpm::benchmarks {

class TimedExchange final : public core::Exchange {
 public:
  /// Sending contributions; waiting for the others'; the minima and sums that end a step; bricks that come
  /// and go; particles that change ranks.
  enum class Part { begin_halo, end_halo, agree, bricks, migrate, count };
  static constexpr std::size_t parts = static_cast<std::size_t>(Part::count);
  static constexpr std::array<std::string_view, parts> part_names{"begin_halo", "end_halo", "agree", "bricks",
                                                                  "migrate"};
  using Times = std::array<Seconds, parts>;

  explicit TimedExchange(core::Exchange& inner) : inner_(inner) {}

  /// Since the last call.
  Times take() { return std::exchange(times_, Times{}); }

  int rank() const override { return inner_.rank(); }
  int size() const override { return inner_.size(); }
  void begin_halo(core::BrickGrid& grid, core::NodeFields fields) override {
    timed(Part::begin_halo, [&] { inner_.begin_halo(grid, fields); });
  }
  void end_halo(core::BrickGrid& grid) override {
    timed(Part::end_halo, [&] { inner_.end_halo(grid); });
  }
  bool any(bool mine) override {
    return timed(Part::agree, [&] { return inner_.any(mine); });
  }
  void minimum(std::span<double> values) override {
    timed(Part::agree, [&] { inner_.minimum(values); });
  }
  void sum(std::span<std::int64_t> values) override {
    timed(Part::agree, [&] { inner_.sum(values); });
  }
  void sum(std::span<core::ExactSum> values) override {
    timed(Part::agree, [&] { inner_.sum(values); });
  }
  void partition(core::BrickGrid& grid, std::span<const core::BrickCount> counts,
                 const core::DecompositionInput& how) override {
    timed(Part::bricks, [&] { inner_.partition(grid, counts, how); });
  }
  void scatter(const core::BrickGrid& grid, core::Travellers& travellers,
               std::span<const int> columns_of) override {
    timed(Part::migrate, [&] { inner_.scatter(grid, travellers, columns_of); });
  }
  void claim(core::BrickGrid& grid, std::span<const core::BrickCoord> wanted) override {
    timed(Part::bricks, [&] { inner_.claim(grid, wanted); });
  }
  void retire(core::BrickGrid& grid, std::span<const core::BrickCoord> empty) override {
    timed(Part::bricks, [&] { inner_.retire(grid, empty); });
  }
  bool exists(const core::BrickGrid& grid, core::BrickCoord b) const override {
    return inner_.exists(grid, b);
  }
  void migrate(const core::BrickGrid& grid, core::Travellers& travellers,
               std::span<const int> columns_of) override {
    timed(Part::migrate, [&] { inner_.migrate(grid, travellers, columns_of); });
  }
  std::vector<std::string> gather(const std::string& mine) override { return inner_.gather(mine); }
  Spread spread(double mine) override { return inner_.spread(mine); }

 private:
  template <class F>
  std::invoke_result_t<F> timed(Part part, F f) {
    struct Stop {
      Seconds& total;
      Seconds start = Seconds::now();
      ~Stop() { total += Seconds::now() - start; }
    } const stop{times_[static_cast<std::size_t>(part)]};
    return f();
  }

  core::Exchange& inner_;
  Times times_{};
};

}  // namespace mpm::benchmarks
