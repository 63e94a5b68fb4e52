// Communication that times each kind of call in a step.
#pragma once

#include <array>
#include <string_view>
#include <type_traits>
#include <utility>

#include "benchmarks/common/clock.hpp"
#include "core/communication/communication.hpp"

namespace mpm::benchmarks {

/// Time by kind of communication.
class CommunicationTimes {
 public:
  /// Sending contributions; waiting for the others'; the reductions that end a step; bricks that come and go;
  /// particles that change ranks.
  enum class Part { begin_halo, end_halo, reductions, bricks, particles, count };
  static constexpr std::size_t parts = static_cast<std::size_t>(Part::count);
  static constexpr std::array<std::string_view, parts> part_names{"begin_halo", "end_halo", "reduce",
                                                                  "bricks", "migrate"};
  using Times = std::array<Seconds, parts>;

  /// Since the last call.
  Times take() { return std::exchange(times_, Times{}); }

  template <class F>
  std::invoke_result_t<F> timed(Part part, F f) {
    struct Stop {
      Seconds& total;
      Seconds start = Seconds::now();
      ~Stop() { total += Seconds::now() - start; }
    } const stop{times_[static_cast<std::size_t>(part)]};
    return f();
  }

 private:
  Times times_{};
};

class TimedReductions final : public core::Reductions {
 public:
  TimedReductions(core::Reductions& inner, CommunicationTimes& times) : inner_(inner), times_(times) {}
  int rank() const override { return inner_.rank(); }
  int size() const override { return inner_.size(); }
  bool any(bool mine) override {
    return timed([&] { return inner_.any(mine); });
  }
  void minimum(std::span<double> values) override {
    timed([&] { inner_.minimum(values); });
  }
  void sum(std::span<std::int64_t> values) override {
    timed([&] { inner_.sum(values); });
  }
  void sum(std::span<core::ExactSum> values) override {
    timed([&] { inner_.sum(values); });
  }
  core::StepStatus combine(const core::StepStatus& mine) override {
    return timed([&] { return inner_.combine(mine); });
  }
  std::vector<std::string> gather(const std::string& mine) override { return inner_.gather(mine); }
  core::Spread spread(double mine) override { return inner_.spread(mine); }

 private:
  template <class F>
  std::invoke_result_t<F> timed(F f) {
    return times_.timed(CommunicationTimes::Part::reductions, f);
  }
  core::Reductions& inner_;
  CommunicationTimes& times_;
};

class TimedDirectory final : public core::BrickDirectory {
 public:
  TimedDirectory(core::BrickDirectory& inner, CommunicationTimes& times) : inner_(inner), times_(times) {}
  void partition(core::BrickGrid& grid, std::span<const core::BrickCount> counts,
                 const core::DecompositionInput& how) override {
    times_.timed(CommunicationTimes::Part::bricks, [&] { inner_.partition(grid, counts, how); });
  }
  void activate(core::BrickGrid& grid, std::span<const core::BrickCoord> wanted) override {
    times_.timed(CommunicationTimes::Part::bricks, [&] { inner_.activate(grid, wanted); });
  }
  void deactivate(core::BrickGrid& grid, std::span<const core::BrickCoord> empty) override {
    times_.timed(CommunicationTimes::Part::bricks, [&] { inner_.deactivate(grid, empty); });
  }
  std::int32_t owner_nearby(core::BrickCoord b) const override { return inner_.owner_nearby(b); }
  std::vector<std::int32_t> owners(std::span<const core::BrickCoord> bricks) const override {
    return inner_.owners(bricks);
  }

 private:
  core::BrickDirectory& inner_;
  CommunicationTimes& times_;
};

class TimedTransport final : public core::ParticleTransport {
 public:
  TimedTransport(core::ParticleTransport& inner, CommunicationTimes& times) : inner_(inner), times_(times) {}
  void migrate(const core::BrickGrid& grid, core::MigrationBuffer& particles,
               std::span<const int> columns_of) override {
    times_.timed(CommunicationTimes::Part::particles, [&] { inner_.migrate(grid, particles, columns_of); });
  }
  void scatter(core::MigrationBuffer& particles, std::span<const int> columns_of) override {
    times_.timed(CommunicationTimes::Part::particles, [&] { inner_.scatter(particles, columns_of); });
  }

 private:
  core::ParticleTransport& inner_;
  CommunicationTimes& times_;
};

class TimedHalo final : public core::NodeHalo {
 public:
  TimedHalo(core::NodeHalo& inner, CommunicationTimes& times) : inner_(inner), times_(times) {}
  void begin(core::BrickGrid& grid, core::NodeFields fields) override {
    times_.timed(CommunicationTimes::Part::begin_halo, [&] { inner_.begin(grid, fields); });
  }
  void end(core::BrickGrid& grid) override {
    times_.timed(CommunicationTimes::Part::end_halo, [&] { inner_.end(grid); });
  }
  void exchange_components(const core::BrickGrid& grid,
                           std::vector<std::vector<std::int32_t>>& of_slot) override {
    times_.timed(CommunicationTimes::Part::begin_halo, [&] { inner_.exchange_components(grid, of_slot); });
  }
  void exchange_points(const core::BrickGrid& grid, std::vector<std::vector<double>>& of_slot) override {
    times_.timed(CommunicationTimes::Part::begin_halo, [&] { inner_.exchange_points(grid, of_slot); });
  }

 private:
  core::NodeHalo& inner_;
  CommunicationTimes& times_;
};

class TimedCommunication : public core::Communication, public CommunicationTimes {
 public:
  explicit TimedCommunication(core::Communication& inner)
      : core::Communication{reductions_, directory_, transport_, halo_},
        reductions_(inner.reductions, *this),
        directory_(inner.bricks, *this),
        transport_(inner.particles, *this),
        halo_(inner.halo, *this) {}
  TimedCommunication(const TimedCommunication&) = delete;
  TimedCommunication& operator=(const TimedCommunication&) = delete;

 private:
  TimedReductions reductions_;
  TimedDirectory directory_;
  TimedTransport transport_;
  TimedHalo halo_;
};

}  // namespace mpm::benchmarks
