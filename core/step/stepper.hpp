// One time step: the choice of its length, the phases of the scene's integrator, and the migration of
// particles. The names of all phases stand in the log's timing table, in the summary and in the benchmarks.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/step/integrator.hpp"
#include "core/step/migration.hpp"

namespace mpm::core {

/// The run cannot go on: what happened, to which particle, where and when. The same on every rank.
class NumericalFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Stepper {
 public:
  /// From here on denormal numbers count as zero in the calling thread and its OpenMP threads.
  Stepper(Model& model, Communication& communication);
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  /// Advance the model by one step. Throws NumericalFailure on every rank together. Collective.
  void step();

  const std::vector<Phase>& phases() const { return phases_; }

  /// Ask for the run to stop; any rank may, at any time.
  void request_stop() { stop_requested_ = true; }
  /// True, on all ranks after the same step, once some rank has asked.
  bool stopping() const { return stopping_; }

  /// Of the last step, on this rank: for the scene's warnings.
  struct Incidents {
    MaterialEvents events;
    OffendingParticles vanishing, negative;
    std::int64_t left_grid = 0;
    OffendingParticles first_left;
  };
  const Incidents& incidents() const { return incidents_; }

  /// Particles are brought into the order of their cells, and empty bricks forgotten, every so many steps.
  static constexpr std::int64_t sorting_interval = 20;

 private:
  std::vector<Phase> make_phases();
  void choose_time_step();
  void reduce_status();

  Model& model_;
  Communication& communication_;
  std::unique_ptr<Integrator> integrator_;
  Migration migration_;
  std::vector<Phase> phases_;
  Incidents incidents_;
  bool needs_bricks_ = false;
  std::string failure_;  ///< agreed upon; thrown once every particle is home
  bool stop_requested_ = false;
  bool stopping_ = false;
};

}  // namespace mpm::core
