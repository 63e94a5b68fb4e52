// core::Reductions over MPI.
#pragma once

#include "core/communication/reductions.hpp"
#include "parallel/mpi.hpp"

namespace mpm::parallel {

class MpiReductions final : public core::Reductions {
 public:
  explicit MpiReductions(const Communicator& comm) : comm_(comm) {}

  int rank() const override { return comm_.rank(); }
  int size() const override { return comm_.size(); }
  bool any(bool mine) override;
  void minimum(std::span<double> values) override;
  void sum(std::span<std::int64_t> values) override;
  void sum(std::span<core::ExactSum> values) override;
  core::StepStatus combine(const core::StepStatus& mine) override;
  std::vector<std::string> gather(const std::string& mine) override;
  core::Spread spread(double mine) override;

 private:
  const Communicator& comm_;
};

}  // namespace mpm::parallel
