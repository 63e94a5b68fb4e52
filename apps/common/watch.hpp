// The scene's guards: Warn, EnergyFraction, near_boundary_stop, loads that end. Only those that it asks for
// cost anything.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "core/model.hpp"
#include "core/step/stepper.hpp"
#include "core/step/totals.hpp"
#include "io/output/log.hpp"

namespace mpm::apps {

class Watch {
 public:
  /// `time`: of the run's start.
  Watch(const core::Scene& scene, double time);

  /// Warnings of the step just done. Throws core::NumericalFailure at level 2, on every rank. Collective.
  void after_step(const core::Model& model, const core::Stepper::Incidents& mine, core::Exchange& exchange,
                  io::Log& log);
  /// Throws core::NumericalFailure if the energy error exceeds EnergyFraction, on every rank.
  void after_report(const core::Model& model, const core::Totals& totals) const;
  /// True, on all ranks, if the scene wants to stop near the boundary and a particle is in the outermost
  /// cells of an open face. Collective.
  bool near_boundary(const core::Model& model, core::Exchange& exchange) const;

 private:
  core::WarnInput warn_;
  const core::Scene& scene_;
  bool warned_[3] = {};
  std::multimap<double, std::string> load_ends_;  ///< when a table of a load ends, and whose it is
};

}  // namespace mpm::apps
