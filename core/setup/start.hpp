// The particles' initial state and its requirements: finite values, and a time step large enough to reach
// EndTime.
#pragma once

#include <span>

#include "core/communication/reductions.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Initialises every particle by its material; first critical step and total energy. Throws InputErrors on
/// every rank together where a state or an energy is not finite, and where the first step is so short that
/// the number of steps to the end would overflow. Collective.
void start_run(Model& model, Reductions& ranks);

/// The same for bodies added to a run, given by number: the critical step is the smaller of the run's and
/// theirs, and their energy is added to the initial one. Collective.
void start_bodies(Model& model, std::span<const std::size_t> bodies, Reductions& ranks);

}  // namespace mpm::core
