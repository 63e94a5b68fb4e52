// Communication of a single rank.
#pragma once

#include "core/communication/communication.hpp"

namespace mpm::core {

class SoloReductions final : public Reductions {
 public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  bool any(bool mine) override { return mine; }
  void minimum(std::span<double>) override {}
  void sum(std::span<std::int64_t>) override {}
  void sum(std::span<ExactSum> sums) override {
    for (ExactSum& sum : sums) sum.normalise();
  }
  StepStatus combine(const StepStatus& mine) override { return mine; }
  std::vector<std::string> gather(const std::string& mine) override { return {mine}; }
  Spread spread(double mine) override { return {mine, mine, mine}; }
};

/// Every brick is ours; the grid itself stores which exist.
class SoloDirectory final : public BrickDirectory {
 public:
  void partition(BrickGrid& grid, std::span<const BrickCount> counts, const DecompositionInput& how) override;
  void activate(BrickGrid& grid, std::span<const BrickCoord> wanted) override;
  void deactivate(BrickGrid& grid, std::span<const BrickCoord> empty) override;
  std::int32_t owner_nearby(BrickCoord) const override { return 0; }
  std::vector<std::int32_t> owners(std::span<const BrickCoord> bricks) const override {
    return std::vector<std::int32_t>(bricks.size(), 0);
  }
};

class SoloTransport final : public ParticleTransport {
 public:
  void migrate(const BrickGrid&, MigrationBuffer&, std::span<const int>) override {}
  void scatter(MigrationBuffer&, std::span<const int>) override {}
};

class SoloHalo final : public NodeHalo {
 public:
  void begin(BrickGrid&, NodeFields) override {}
  void end(BrickGrid&) override {}
  void exchange_components(const BrickGrid&, std::vector<std::vector<std::int32_t>>&) override {}
  void exchange_points(const BrickGrid&, std::vector<std::vector<double>>&) override {}
};

class SoloCommunication : public Communication {
 public:
  SoloCommunication() : Communication{reductions_, bricks_, particles_, halo_} {}
  SoloCommunication(const SoloCommunication&) = delete;
  SoloCommunication& operator=(const SoloCommunication&) = delete;

 private:
  SoloReductions reductions_;
  SoloDirectory bricks_;
  SoloTransport particles_;
  SoloHalo halo_;
};

}  // namespace mpm::core
