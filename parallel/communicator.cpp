#include "parallel/communicator.hpp"

#include <stdexcept>

#include "parallel/mpi_exchange.hpp"

namespace mpm::parallel {

MPI_Comm communicator_of(const core::Exchange& exchange) {
  if (const auto* ours = dynamic_cast<const MpiExchange*>(&exchange)) return ours->communicator().handle();
  if (exchange.size() != 1) throw std::logic_error("there is no communicator behind this exchange");
  return MPI_COMM_SELF;
}

}  // namespace mpm::parallel
