// One time step: the choice of its length, the phases of the scene's integrator, and the migration of
// particles. The log's timing table, the summary and the benchmarks use the names of the phases.
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/step/integrator.hpp"
#include "core/step/migration.hpp"

namespace mpm::core {

/// The run cannot continue: what happened, to which particle, where and when. The same on every rank.
class NumericalFailure : public std::runtime_error {
 public:
  /// `keeps_state`: the model is as it was before the step.
  explicit NumericalFailure(const std::string& what, bool keeps_state = false)
      : std::runtime_error(what), keeps_state_(keeps_state) {}
  bool keeps_state() const { return keeps_state_; }

 private:
  bool keeps_state_;
};

class Stepper {
 public:
  /// Flushes denormal numbers to zero from here on, in the calling thread and its OpenMP threads.
  Stepper(Model& model, Communication& communication);
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  /// Advances the model by one step. Throws NumericalFailure on every rank together. Collective.
  void step();

  /// In order of execution. Phases of a scheme that the run has left come last and do nothing any more.
  const std::vector<Phase>& phases() const { return phases_; }
  /// What the integrator has to say of the last step, for the log; empty for explicit steps.
  std::string words_of_step() const { return integrator_->words_of_step(); }
  std::string words_of_run() const { return integrator_->words_of_run(); }
  /// Where the scheme has changed after the last step: why, and what to do about it; else empty.
  const std::string& words_of_change() const { return words_of_change_; }
  /// Of the phases.
  std::vector<PartOfPhase> parts() const { return integrator_->parts(); }

  /// Requests that the run stops; any rank may, at any time.
  void request_stop() { stop_requested_ = true; }
  /// True, on all ranks after the same step, once any rank has requested a stop.
  bool stopping() const { return stopping_; }

  /// Incidents of the last step on this rank, for the scene's warnings.
  struct Incidents {
    MaterialEvents events;
    OffendingParticles vanishing, negative;
    std::int64_t left_grid = 0;
    OffendingParticles first_left;
  };
  const Incidents& incidents() const { return incidents_; }

  /// Interval, in steps, at which particles are sorted by cell and empty bricks removed.
  static constexpr std::int64_t sorting_interval = 20;

 private:
  std::vector<Phase> make_phases();
  void choose_time_step();
  void go_on_with_usavg();
  void reduce_status();
  [[noreturn]] void fail_collapsed();

  Model& model_;
  Communication& communication_;
  std::unique_ptr<Integrator> integrator_;
  Migration migration_;
  std::vector<Phase> phases_;
  Incidents incidents_;
  bool needs_bricks_ = false;
  bool collapsed_ = false;       ///< the critical step, in this step
  std::optional<double> drift_;  ///< for which the scheme is to change after this step
  std::string words_of_change_;
  std::string failure_;  ///< agreed by all ranks; thrown after the migration is complete
  bool stop_requested_ = false;
  bool stopping_ = false;
};

}  // namespace mpm::core
