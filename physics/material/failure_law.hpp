// Type-erased failure model, called once per batch, as physics/material/strength_law.hpp for strength models.
#pragma once

#include <utility>

#include "physics/material/failure_stage.hpp"
#include "physics/material/instance.hpp"

namespace mpm::physics {

class FailureLaw {
 public:
  FailureLaw() = default;
  FailureLaw(const FailureLaw&) = delete;
  FailureLaw& operator=(const FailureLaw&) = delete;
  virtual ~FailureLaw() = default;

  virtual core::ColumnSet columns() const = 0;
  /// See physics/material/failure_stage.hpp.
  virtual void judge(const core::Batch& batch, bool erodes, bool scatters, double* verdict,
                     Instance instance) const = 0;
};

template <class Model>
class FailureOf final : public FailureLaw {
 public:
  explicit FailureOf(Model model) : model_(std::move(model)) {}
  const Model& law() const { return model_; }

  core::ColumnSet columns() const override { return columns_of(model_); }
  void judge(const core::Batch& batch, bool erodes, bool scatters, double* verdict,
             Instance instance) const override {
    as_chosen<Model>(instance, [&]<class T>(std::type_identity<T>) {
      physics::judge<T>(batch, model_, erodes, scatters, verdict);
    });
  }

 private:
  Model model_;
};

}  // namespace mpm::physics
