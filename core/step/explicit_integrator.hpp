// The explicit schemes MUSL, USAVG, USF and USL as lists of phases (explicit_integrator.cpp).
#pragma once

#include "core/contact/rigid_bodies.hpp"
#include "core/step/cells_in_use.hpp"
#include "core/step/conduction.hpp"
#include "core/step/integrator.hpp"
#include "core/step/passes.hpp"

namespace mpm::core {

class ExplicitIntegrator final : public Integrator {
 public:
  ExplicitIntegrator(Model& model, Communication& communication);

  std::vector<Phase> phases() override;
  double next_step(const Clock& clock) const override;
  void begin_step(double dt) override;
  double stable_step(const StepStatistics& statistics) const override;
  StepStatistics take_statistics() override {
    StepStatistics statistics = passes_->take_statistics();
    statistics.undefined = passes_->loads().take_fault();
    return statistics;
  }
  std::vector<std::vector<DepartingParticle>>& departing() override { return passes_->departing(); }

 private:
  StepLength set_length(double dt);
  void limit_strain();

  Model& model_;
  Reductions& ranks_;
  std::unique_ptr<CellsInUse> cells_;  ///< null where no shape function needs them
  std::unique_ptr<Conduction> heat_;
  std::unique_ptr<RigidBodies> rigid_;  ///< null without any in contact
  std::unique_ptr<Passes> passes_;
  double heat_dt_ = 0;                             ///< over which this step conducts heat
  double lag_before_ = 0, strain_lag_before_ = 0;  ///< Clock::lag and strain_lag at the start of the step
};

}  // namespace mpm::core
