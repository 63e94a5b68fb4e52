// The length of an explicit step, as a leapfrog has it (review 22 to 24): velocities are those of the middle
// of the step before and are advanced to the middle of this one; positions, strains and stresses are advanced
// from its start to its end.
//
// With one length for both, a step that is shorter than the last one gains (dt_before - dt)/2 times the power
// of the stresses: 4 % of the energy of a block that vibrates while its step changes by 6 %. USF has one
// length for both (explicit_integrator.cpp). USAVG's strains and stresses end in the middle of the step.
//
// The velocities of the input are those of half a step before time zero, so that after a time t they hold the
// impulses of a time t + first_lag - lag. The last step, which EndTime may shorten to any length, advances
// them to the impulses of the time of the run, as far as it can without going back or standing still: an
// impulse over no time would be no force.
#pragma once

#include <algorithm>

namespace mpm::core {

struct StepLength {
  double dt = 0;           ///< of positions and stresses
  double velocity_dt = 0;  ///< of velocities
  double strain_lag = 0;   ///< USAVG: of strains and stresses behind the positions at the start of the step
  double lag = 0;          ///< of the velocities behind the stresses at the end of the step
  double load_part = 0.5;  ///< of dt, after which loads are evaluated: the middle of their impulses' time
};

inline constexpr double least_impulse = 1.0 / 64;  ///< time of the last step's impulses, over its length

/// `first_lag`: half of the run's first step.
inline StepLength step_length(double dt, double lag_before, double first_lag, bool last) {
  StepLength s{dt};
  s.lag = last ? std::clamp(first_lag, lag_before - dt, lag_before + (1 - least_impulse) * dt) : 0.5 * dt;
  s.velocity_dt = dt + (lag_before - s.lag);
  s.load_part = (first_lag - lag_before + 0.5 * s.velocity_dt) / dt;
  return s;
}

}  // namespace mpm::core
