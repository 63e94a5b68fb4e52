// The particles' first state, and what it must allow: finite numbers, and a time step that leads somewhere.
#pragma once

#include <span>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Every particle's first state by its material; first critical step and total energy. Throws InputErrors on
/// every rank together where a state or an energy is not finite, and where the first step is so short that
/// the steps to the end could not be counted. Collective.
void start_run(Model& model, Reductions& ranks);

/// The same for bodies that have joined a run, by their numbers: the critical step is the smaller of the
/// run's and theirs, and their energy joins the initial one. Collective.
void start_bodies(Model& model, std::span<const std::size_t> bodies, Reductions& ranks);

}  // namespace mpm::core
