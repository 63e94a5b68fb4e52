// A time integration scheme as the stepper sees it: the phases of a step between the choice of its length and
// the migration of particles, and what a rank has learnt when they are through. The explicit schemes are
// core/step/explicit_integrator.cpp.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/communication/communication.hpp"
#include "core/model.hpp"
#include "core/step/offending_particle.hpp"

namespace mpm::core {

/// A named part of a step. The names stand in the log's timing table, in the summary and in the benchmarks.
struct Phase {
  std::string name;
  std::function<void()> run;
  double seconds = 0;  ///< wall clock of this rank since the run began
};

/// A particle that leaves its brick.
struct DepartingParticle {
  int tile = 0;
  std::uint32_t index = 0;
  bool eroded = false;  ///< to be deleted; otherwise it has moved out of its brick
};

/// What a rank learns in the course of a step, to be combined over the ranks at its end.
struct StepStatistics {
  double fastest = 0;        ///< largest (Q + sqrt(Q^2 + c^2)) + |v| of any particle, length/time
  std::int64_t limited = 0;  ///< velocities held by LimitVelocity
  MaterialEvents events;
  OffendingParticles vanishing,
      negative;   ///< particles of negative volume and energy, where the scene watches them
  ExactSum work;  ///< external work
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  /// In the order in which they run. Every phase is collective.
  virtual std::vector<Phase> phases() = 0;

  /// Length of the next step as the scheme wants it; the stepper cuts the last one to end on time. The same
  /// on every rank.
  virtual double next_step(const Clock& clock) const = 0;
  /// Called before the phases of every step.
  virtual void begin_step(double dt) = 0;

  /// Largest stable step of this rank's particles after the step just done.
  virtual double stable_step(const StepStatistics& statistics) const = 0;
  /// What was learnt since the last call, over all threads.
  virtual StepStatistics take_statistics() = 0;
  /// The particles of each brick that the step just done has moved out of it or eroded, by slot.
  virtual std::vector<std::vector<DepartingParticle>>& departing() = 0;
};

/// The scheme that the scene names.
std::unique_ptr<Integrator> make_integrator(Model& model, Communication& communication);

}  // namespace mpm::core
