// The largest tension that a strength model allows (StrengthPoint::lowest_pressure), and the consequences of
// reaching it besides the limited pressure. A law that limits the tension defines them in tension_rules().
#pragma once

#include <limits>

#include "core/simd/dual.hpp"

namespace mpm::physics {

struct TensionRules {
  bool limited = false;
  double verdict = 0;                                        ///< 1: fails at the limit
  double erosion = std::numeric_limits<double>::infinity();  ///< tension beyond which it is eroded, stress
  bool fails() const { return verdict > 0 || erosion < std::numeric_limits<double>::infinity(); }
};

/// The pressure limited to at least `lowest`; `sentence` is set by the rules where it would be below.
template <class T>
T limit_tension(const TensionRules& rules, const T& pressure, const T& lowest, T& sentence) {
  sentence = core::select(pressure <= lowest, rules.verdict, sentence);
  sentence = core::select(pressure < -rules.erosion, 2.0, sentence);
  return core::max(pressure, lowest);
}

}  // namespace mpm::physics
