// What the log says about the particles of a run: at the start the size and cost of the scene, at the end the
// states that were corrected.
#pragma once

#include "core/communication/reductions.hpp"
#include "core/model.hpp"
#include "core/step/stepper.hpp"
#include "io/output/log.hpp"

namespace mpm::apps {

/// Size and cost of the scene, for a dry run and the head of the log. Collective.
void describe(const core::Model& model, const core::Stepper& stepper, core::Reductions& ranks, int threads,
              io::Log& log);

/// Warns of a specified time step above the critical one.
void warn_of_long_step(const core::Model& model, io::Log& log);

/// A body with an initial temperature, at the density of a cold one, starts under thermal pressure: a note
/// gives the density (to first order) that avoids it. Collective.
void say_thermal_pressures(const core::Model& model, core::Reductions& ranks, io::Log& log);

/// Reports particles whose accumulated strain, at the end, is too large for Volume update_type 4. Collective.
void say_large_strains(const core::Model& model, core::Reductions& ranks, io::Log& log);

/// Reports states that were corrected or limited, in particles times steps. Collective.
void say_what_was_counted(const core::Model& model, core::Reductions& ranks, io::Log& log);

}  // namespace mpm::apps
