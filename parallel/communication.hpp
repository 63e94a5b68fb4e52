// core::Communication over MPI.
#pragma once

#include "core/communication/communication.hpp"
#include "parallel/mpi_reductions.hpp"
#include "parallel/mpi_transport.hpp"
#include "parallel/node_halo.hpp"
#include "parallel/replicated_directory.hpp"

namespace mpm::parallel {

class MpiCommunication : public core::Communication {
 public:
  /// Over the ranks of `parent`. Collective.
  explicit MpiCommunication(const Communicator& parent)
      : core::Communication{reductions_, directory_, transport_, halo_},
        comm_(parent.duplicate()),
        reductions_(comm_),
        directory_(comm_),
        halo_(comm_, directory_),
        transport_(comm_, directory_, halo_) {}
  MpiCommunication(const MpiCommunication&) = delete;
  MpiCommunication& operator=(const MpiCommunication&) = delete;

  const ReplicatedDirectory& directory() const { return directory_; }

 private:
  Communicator comm_;
  MpiReductions reductions_;
  ReplicatedDirectory directory_;
  MpiHalo halo_;
  MpiTransport transport_;
};

}  // namespace mpm::parallel
