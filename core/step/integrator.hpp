// Interface of a time integration scheme to the stepper: the phases of a step between the choice of the time
// step and the migration of particles, and the statistics that a rank collects in them. The explicit schemes
// are in core/step/explicit_integrator.cpp.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/communication/communication.hpp"
#include "core/model.hpp"
#include "core/shape/domain_counts.hpp"
#include "core/step/offending_particle.hpp"
#include "core/step/step_length.hpp"

namespace mpm::core {

/// A named part of a step. The log's timing table, the summary and the benchmarks use these names.
struct Phase {
  std::string name;
  std::function<void()> run;
  double seconds = 0;  ///< wall-clock time of this rank since the run began
};

/// Where the time of a phase goes.
struct PartOfPhase {
  std::string phase, name;
  double seconds = 0;
};

/// A particle that leaves its brick or its component.
struct DepartingParticle {
  int tile = 0;
  std::uint32_t index = 0;
  bool eroded = false;  ///< to be deleted
};

/// What a rank collects during a step, to be combined over the ranks at its end.
struct StepStatistics {
  double fastest = 0;        ///< largest (Q + sqrt(Q^2 + c^2)) + |v| of any particle, length/time
  std::int64_t limited = 0;  ///< velocities limited by LimitVelocity
  DomainCounts domains;      ///< of particles
  MaterialEvents events;
  OffendingParticles vanishing,
      negative;            ///< particles of negative volume and energy, where the scene checks for them
  ExactSum work;           ///< external work
  ExactSum internal_lead;  ///< Ledger::internal_lead after this step
  ContactRecord contact;
  std::vector<ReactionSums> reactions;  ///< by number in Model::reactions; may be shorter
  OffendingParticle overlap;            ///< of driven rigid bodies
  OffendingParticle undefined;          ///< for which an expression of the input has no finite value
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  /// In order of execution. Every phase is collective.
  virtual std::vector<Phase> phases() = 0;

  /// Length of the next step; the stepper shortens the last one to end at EndTime. The same on every rank.
  virtual double next_step(const Clock& clock) const = 0;
  /// Called before the phases of every step.
  virtual void begin_step(double dt) = 0;

  /// Largest stable step of this rank's particles after the step just completed.
  virtual double stable_step(const StepStatistics& statistics) const = 0;
  /// Statistics since the last call, over all threads.
  virtual StepStatistics take_statistics() = 0;
  /// The particles of each brick that have left it or been eroded in the step just completed, by slot.
  virtual std::vector<std::vector<DepartingParticle>>& departing() = 0;
  /// In the order of the time table, where an integrator knows more than its phases tell.
  virtual std::vector<PartOfPhase> parts() const { return {}; }
  /// What the log says of the step; empty where there is nothing beyond the time table.
  virtual std::string words_of_step() const { return {}; }
  /// And at the end of the run.
  virtual std::string words_of_run() const { return {}; }
};

/// The scheme that the scene names.
std::unique_ptr<Integrator> make_integrator(Model& model, Communication& communication);

}  // namespace mpm::core
