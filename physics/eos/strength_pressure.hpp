// The pressure of a material whose strength law computes it with the deviator (`sets_pressure`): the strength
// stage stores it and its modulus in the batch, and the energy follows from it. Not an input type.
// Tested by tests/physics/laws_test.cpp over the samples of such laws.
#pragma once

#include <array>

#include "core/material/batch.hpp"
#include "physics/eos/point.hpp"

namespace mpm::physics {

/// The law's `update` sets the pressure and bulk modulus in the point; `place` initialises them.
template <class Law>
concept SetsPressure = requires {
  requires Law::sets_pressure;
};

struct StrengthPressure {
  static constexpr std::array<core::Column, 0> state{};
  using has_tangent = StrengthPressure;

  double bulk = 0;  ///< K at rest, stress

  template <class T>
  static LinearisedPressure<T> linearise(const core::Batch& batch, int row, const T& relative_volume) {
    return linearise(core::load<T>(batch.law_pressure + row), core::load<T>(batch.bulk_modulus + row),
                     relative_volume);
  }
  template <class T>
  static LinearisedPressure<T> linearise(const T& pressure, const T& modulus, const T& relative_volume) {
    return {pressure, 0.0, modulus * relative_volume, 0.0};
  }

  /// Pressure of a failed particle: from the density alone, so that a gap must close before it carries
  /// pressure.
  template <class T>
  T broken_pressure(const EosPoint<T>& point) const {
    using core::log;
    return -bulk * log(point.relative_volume);
  }
};

}  // namespace mpm::physics
