// One run of the solver, from the command line's options to the exit code.
#pragma once

#include "apps/common/options.hpp"
#include "parallel/mpi.hpp"
#include "physics/registry.hpp"

namespace mpm::apps {

/// Everything, on all ranks. Throws InputErrors and FileError on every rank together. Collective.
ExitCode run(const RunOptions& options, const parallel::Communicator& world,
             const physics::Registry& registry);

}  // namespace mpm::apps
