// The particles of a run that starts, and those of bodies that join a run.
#pragma once

#include <span>

#include "core/communication/communication.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Make the particles of a prepared model and start its clock: first critical step and total energy from the
/// particles' first state. Throws InputErrors on every rank together for a body outside the grid, an identity
/// or a memory range exceeded, a decomposition that does not fit, and a first state that no run can start
/// from. Collective.
void build_model(Model& model, Communication& communication);

/// Make the particles of bodies, by their numbers, that have none yet in a model that holds a run: their
/// identities follow those in use, the critical step accounts for them, and the energy that they bring counts
/// as if it had been there from the start, so that the balance of energy stays one of the run's own errors.
/// Throws as build_model. Collective.
void add_bodies(Model& model, std::span<const std::size_t> bodies, Communication& communication);

}  // namespace mpm::core
