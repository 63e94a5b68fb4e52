// core::ParticleTransport over MPI: particles are sent to neighbouring ranks only, except in scatter().
#pragma once

#include "core/communication/brick_directory.hpp"
#include "core/communication/particle_transport.hpp"
#include "parallel/mpi.hpp"
#include "parallel/node_halo.hpp"

namespace mpm::parallel {

class MpiTransport final : public core::ParticleTransport {
 public:
  /// `halo` provides the neighbouring ranks.
  MpiTransport(const Communicator& comm, const core::BrickDirectory& bricks, MpiHalo& halo)
      : comm_(comm), bricks_(bricks), halo_(halo) {}

  void migrate(const core::BrickGrid& grid, core::MigrationBuffer& particles,
               std::span<const int> columns_of) override;
  void scatter(core::MigrationBuffer& particles, std::span<const int> columns_of) override;

 private:
  const Communicator& comm_;
  const core::BrickDirectory& bricks_;
  MpiHalo& halo_;
};

}  // namespace mpm::parallel
