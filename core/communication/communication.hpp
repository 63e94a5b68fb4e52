// The communication that a run needs, in four parts. `parallel` implements them over MPI; SoloCommunication
// is the trivial implementation for one rank. The step uses no other external interface.
#pragma once

#include "core/communication/brick_directory.hpp"
#include "core/communication/node_halo.hpp"
#include "core/communication/particle_transport.hpp"
#include "core/communication/reductions.hpp"

namespace mpm::core {

class NewtonSolver;  // core/implicit/newton_solver.hpp

struct Communication {
  Reductions& reductions;
  BrickDirectory& bricks;
  ParticleTransport& particles;
  NodeHalo& halo;
  NewtonSolver* newton = nullptr;  ///< of implicit steps; null in explicit runs

  /// Most functions need only the reductions.
  operator Reductions&() const { return reductions; }
};

}  // namespace mpm::core
