#pragma once
// Threads as ranks, of which each knows what the others gather: what communicates by gather() alone, on a few
// ranks of one process.

#include <barrier>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/communication/reductions.hpp"

namespace mpm::core::testing {

class RanksOfThreads {
 public:
  explicit RanksOfThreads(int size)
      : lines_(static_cast<std::size_t>(size)), all_here_(size), all_have_read_(size) {}

  /// f(rank's reductions) on every rank at once.
  void run(const std::function<void(Reductions&)>& f) {
    std::vector<std::jthread> threads;
    for (int r = 0; r < static_cast<int>(lines_.size()); ++r)
      threads.emplace_back([this, &f, r] {
        Rank rank(*this, r);
        f(rank);
      });
  }

 private:
  class Rank final : public Reductions {
   public:
    Rank(RanksOfThreads& all, int rank) : all_(all), rank_(rank) {}
    int rank() const override { return rank_; }
    int size() const override { return static_cast<int>(all_.lines_.size()); }
    std::vector<std::string> gather(const std::string& mine) override {
      all_.lines_[static_cast<std::size_t>(rank_)] = mine;
      all_.all_here_.arrive_and_wait();
      std::vector<std::string> lines = all_.lines_;
      all_.all_have_read_.arrive_and_wait();
      return lines;
    }
    bool any(bool) override { return refuse(), false; }
    void minimum(std::span<double>) override { refuse(); }
    void sum(std::span<std::int64_t>) override { refuse(); }
    void sum(std::span<ExactSum>) override { refuse(); }
    StepStatus combine(const StepStatus&) override { return refuse(), StepStatus{}; }
    Spread spread(double) override { return refuse(), Spread{}; }

   private:
    static void refuse() { throw std::logic_error("threads as ranks only gather"); }
    RanksOfThreads& all_;
    int rank_;
  };

  std::vector<std::string> lines_;
  std::barrier<> all_here_, all_have_read_;
};

}  // namespace mpm::core::testing
