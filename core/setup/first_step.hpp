// What the particles' first state must allow: finite numbers, and a time step that leads somewhere.
#pragma once

#include <limits>

#include "core/model.hpp"
#include "core/step/exchange.hpp"

namespace mpm::core {

/// This rank's fastest particle, wave speed included; of several, the one with the smallest identity.
struct Fastest {
  double speed = 0, identity = std::numeric_limits<double>::infinity();
  double wave = 0;
  Vec3<double> position{}, velocity{};
  int body = -1;

  /// Lane `i` of a batch of body `number`, its critical speed filled in. A speed that is no number is
  /// infinite.
  void offer(int number, const Batch& batch, int i);
};

/// Throws InputErrors, on every rank, for the first particle whose state or energy is not all finite.
/// Collective.
void refuse_undefined(const Model& model, Exchange& exchange);

/// Throws InputErrors, on every rank, for a first step so short that the steps could not be counted to the
/// end: naming the fastest particle, of which `mine` is this rank's. Collective.
void refuse_endless(const Model& model, const Fastest& mine, Exchange& exchange);

}  // namespace mpm::core
