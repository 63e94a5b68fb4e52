// The MPI communicator behind an Exchange, for libraries that need one of their own (parallel HDF5).
#pragma once

#include <mpi.h>

#include "core/step/exchange.hpp"

namespace mpm::parallel {

/// MPI_COMM_SELF for one rank alone. Throws std::logic_error for an exchange over several ranks that is not
/// ours.
MPI_Comm communicator_of(const core::Exchange& exchange);

}  // namespace mpm::parallel
