// What a run needs of the other ranks, in four parts. `parallel` implements them over MPI; SoloCommunication
// is one rank alone, for which every answer is trivial. Nothing else of the outside world reaches the step.
#pragma once

#include "core/communication/brick_directory.hpp"
#include "core/communication/node_halo.hpp"
#include "core/communication/particle_transport.hpp"
#include "core/communication/reductions.hpp"

namespace mpm::core {

struct Communication {
  Reductions& reductions;
  BrickDirectory& bricks;
  ParticleTransport& particles;
  NodeHalo& halo;

  /// Most functions need no more of it.
  operator Reductions&() const { return reductions; }
};

}  // namespace mpm::core
