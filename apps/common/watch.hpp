// The scene's guards: Warn, EnergyFraction, near_boundary_stop, loads that end; only those that the scene
// requests have a cost. And the energy balance, at every row of the status file. Their messages are the same
// on any ranks and threads.
#pragma once

#include <deque>
#include <map>
#include <set>
#include <string>

#include "core/model.hpp"
#include "core/step/scheme_change.hpp"
#include "core/step/stepper.hpp"
#include "core/step/totals.hpp"
#include "io/output/log.hpp"

namespace mpm::apps {

/// Energy drift, relative to the largest energy of the balance, above which every run prints a warning. It is
/// averaged over some rows of the status file: kinetic and internal energy belong to times half a step apart,
/// so their sum oscillates with the waves.
inline constexpr double notable_drift = 0.02;
inline constexpr std::size_t judged_rows = 10;
/// The first step of an explicit run that is checked: earlier the total energy may be so small (a body that
/// starts to fall) that the error of one step is a notable fraction of it.
inline constexpr std::int64_t first_judged_step = core::first_steps;
/// An explicit run with fewer steps is judged by its last row: above notable_drift where it has begun with
/// half of its energy or more, above these where it has not: a body that falls from rest for n steps has an
/// error of up to 1/n.
inline constexpr double notable_drift_of_short_run = 0.1;
inline constexpr double notable_steps_of_drift = 2;

class Watch {
 public:
  /// `time`: of the run's start.
  Watch(const core::Scene& scene, double time);

  /// Warnings of the step just done. Throws core::NumericalFailure at level 2, and if the energy error
  /// exceeds EnergyFraction, on every rank. Collective.
  void after_step(const core::Model& model, const core::Stepper::Incidents& mine, core::Reductions& ranks,
                  io::Log& log);
  /// The energy balance at a row of the status file or at the end; warns at the first notable drift.
  void note_balance(const core::Clock& clock, const core::EnergyBalance& balance, io::Log& log);
  std::int64_t last_noted_step() const { return last_step_; }
  /// Message about a notable drift since the start or continuation of this run; empty without one.
  std::string words_of_drift() const;
  /// Reports a notable drift, and what level 1 has counted beyond the particles that it named.
  void conclude(io::Log& log) const;
  /// True, on all ranks, if the scene requests a stop near the boundary and a particle is in the outermost
  /// cells of an open face. Collective.
  bool near_boundary(const core::Model& model, core::Reductions& ranks) const;

 private:
  /// A kind of unphysical incident of a particle.
  struct Kind {
    const char* words;
    std::set<double> named;      ///< identities, at level 1
    std::int64_t incidents = 0;  ///< of all ranks, particles times steps
  };
  void warn(Kind& kind, std::int64_t count, const core::OffendingParticles& first, const core::Model& model,
            io::Log& log) const;
  void check_energy(const core::Model& model, core::Reductions& ranks) const;

  core::WarnInput warn_;
  const core::Scene& scene_;
  Kind kinds_[3] = {{"with internal energy below zero", {}, 0},
                    {"whose volume would have vanished", {}, 0},
                    {"left the grid", {}, 0}};
  double mean_drift() const;
  bool drifted_early() const;
  /// Energies of implicit steps are those of one time, so that all their rows are judged.
  bool is_implicit() const { return scene_.solution.integration == core::Integration::implicit; }
  std::int64_t last_step_ = 0;  ///< of the rows
  double last_drift_ = 0;
  bool began_with_energy_ = false;
  std::deque<double> drifts_;  ///< of the last judged_rows
  double largest_mean_drift_ = 0;
  std::multimap<double, std::string> load_ends_;  ///< end time of each load table, and its owner
};

}  // namespace mpm::apps
