// Creation of the particles at the start of a run, and of bodies added to a run.
#pragma once

#include <span>

#include "core/communication/communication.hpp"
#include "core/model.hpp"

namespace mpm::core {

/// Creates the particles of a prepared model and starts its clock: first critical step and total energy from
/// the particles' initial state. Throws InputErrors on every rank together for a body outside the grid, an
/// identity or memory limit exceeded, a decomposition that does not fit, and an invalid initial state.
/// Collective.
void build_model(Model& model, Communication& communication);

/// Creates the particles of bodies, given by number, that have none yet in a running model: their identities
/// follow those in use, the critical step includes them, and their energy is added to the initial energy, so
/// that the energy balance contains only the run's own errors. Throws as build_model. Collective.
void add_bodies(Model& model, std::span<const std::size_t> bodies, Communication& communication);

}  // namespace mpm::core
