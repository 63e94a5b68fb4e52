// The scheme of an input that leaves it to the program (`algorithm="auto"`). Most runs need no more than
// MUSL, the manual's scheme, which costs least. Where particles cross cells under load, where bodies of very
// different stiffness push each other, or with one particle in a cell, MUSL gains or loses energy, and USAVG
// does not (docs/stability.md). Which of them a run is, its energy balance tells: it begins with MUSL and
// goes on with USAVG once the balance is off by more than `tolerated_drift`, or drifts on in a long run.
//
// The change comes between two steps. MUSL leaves the strains of whole steps behind, so that the first step
// of USAVG has no second half to make up for; the discrete balance of both (particle_motion.hpp) is the same
// quantity there. The decision depends on exact sums alone: it is the same on any ranks and threads, and a
// restart file remembers it.
#pragma once

#include <cstdint>
#include <optional>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Error of the energy balance, relative to the largest energy that has been in it, that MUSL may have; and
/// what may be added to it after `long_run` steps, by small errors that add up.
inline constexpr double tolerated_drift = 0.005, tolerated_growth = 0.001;
inline constexpr std::int64_t long_run = 10000;
/// A look at the balance costs a fifth of a step. It comes after each of the first steps, in which bodies
/// meet and explosives begin to burn, and then after every twentieth. A body that is set in motion at once
/// has an error in the very first steps that goes again: up to `first_steps` two looks have to agree.
inline constexpr std::int64_t first_look = 5, first_steps = 50, balance_interval = 20;
/// What has begun with less than half of its energy, and falls or is pushed, has an error of 3 % in the first
/// step, and of less than 0.1 % in the fifteenth.
inline constexpr std::int64_t first_look_of_fall = 20;

/// Whether the scheme of a scene may change: `auto`, in explicit steps with FLIP and lumped masses. Other
/// transfers lose energy with any scheme, and contact of types 1 and 2, which that with free rigid bodies
/// always is, gains it with USAVG. What leaves through non-reflecting faces, and what limits of the volume
/// take, is not in the balance.
bool may_change_scheme(const Scene& scene);

/// The relative error of the energy balance after this step if the scheme is to change now; keeps what later
/// looks need in the clock. The same on every rank. Collective.
std::optional<double> drift_beyond_tolerance(Model& model, Reductions& ranks);

/// Between two steps: the next ones are those of `scheme`, and an integrator made before must be replaced.
/// The critical step of MUSL is stable with USAVG, whose limits are no smaller (wave_limit.hpp).
void change_scheme(Model& model, Scheme scheme);
/// Goes on with the scheme that `model.clock`, read from a file, says.
void continue_scheme(Model& model);

}  // namespace mpm::core
