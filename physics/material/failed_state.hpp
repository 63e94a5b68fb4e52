// Pressure of a failed particle (manual 3.2.1, FailedType): 0 no tension, 1 none at all, 2 tension down to
// TensileCutoff, and zero beyond.
#pragma once

#include "core/simd/dual.hpp"
#include "physics/eos/point.hpp"

namespace mpm::physics {

struct FailedRules {
  int type = 0;
  double tensile_cutoff = 0;  ///< stress, <= 0
  /// Bears pressure and no tension at all.
  bool no_tension() const { return type == 0 || (type == 2 && tensile_cutoff == 0); }
};

template <class T>
T allowed_pressure(const FailedRules& rules, const T& pressure) {
  switch (rules.type) {
    case 1: return 0.0;
    case 2: return core::select(pressure < rules.tensile_cutoff, 0.0, pressure);
    default: return core::max(pressure, 0.0);
  }
}

/// A failed particle's pressure; `pressure` is that of the equation of state.
template <class T, class Eos>
T broken_pressure(const Eos& eos, const FailedRules& rules, const EosPoint<T>& point, const T& pressure) {
  if constexpr (requires { eos.broken_pressure(point); }) {
    return allowed_pressure(rules, eos.broken_pressure(point));
  } else {
    return allowed_pressure(rules, pressure);
  }
}

}  // namespace mpm::physics
