// The plastic strain increment of a law whose yield stress depends on it through rate, heat or nonlinear
// hardening:
//   f(x) = trial - 3 G x - sigma_y(x) = 0,   0 <= x <= trial/(3 G)
// Newton's method safeguarded by a shrinking bracket, all lanes at once; converged lanes no longer change, so
// their result does not depend on their neighbours. Converged means |f| below 1e-12 of the yield stress, or
// a Newton step below 1e-6 x: x f''/f' of rate, heat and hardening is of order one or less, so that what is
// left is about 1e-12 x, and the yield stress, which costs most, is not evaluated once more. The derivatives
// of x follow from f(x) = 0 at the result.
#pragma once

#include "core/simd/dual.hpp"
#include "core/tensor/tensor.hpp"

namespace mpm::physics {

template <class T>
struct FlowStress {
  T value;
  T slope;  ///< with respect to the plastic strain increment
};

/// `threshold` is the yield stress for a vanishing increment: where the trial stress does not exceed it the
/// result is zero. Its slope is that of hardening alone, as far as it is known without a rate; it and
/// `start`, the stress at which flow starts, the greater of the threshold and the stress before the step,
/// make the first guess, with which a steady flow is nearly found. `flow(x)` returns the yield stress; for a
/// law with a tangent it must take x with and without derivatives (core::as).
template <class T, class Flow>
T plastic_increment(const T& trial, const FlowStress<T>& threshold, const T& start, double shear,
                    const Flow& flow) {
  using core::abs;
  using core::exp;
  using core::max;
  const double stiffness = 3 * shear;
  if constexpr (core::derivatives_of < T >> 0) {
    using Value = decltype(trial.v);
    const FlowStress<Value> first{threshold.value.v, threshold.slope.v};
    const Value x = plastic_increment(trial.v, first, start.v, shear, flow);
    const FlowStress<T> yield = flow(T(x));
    const T f = trial - stiffness * T(x) - yield.value;
    return core::select(x > 0.0, core::implicit_root(T(x), f, stiffness + yield.slope), T(x));
  } else {
    const core::MaskOf<T> plastic = trial > threshold.value;
    T x = core::select(
        plastic,
        max((trial - start) / (stiffness + threshold.slope), (1e-3 / stiffness) * (trial - threshold.value)),
        0.0);
    if (!core::any(plastic)) return x;
    T low = 0.0, high = trial * (1 / stiffness);
    core::MaskOf<T> open = plastic;
    for (int iteration = 0; iteration < 100; ++iteration) {
      const FlowStress<T> yield = flow(x);
      const T f = trial - stiffness * x - yield.value;
      open = open & (abs(f) > 1e-12 * yield.value + 1e-15 * trial);
      if (!core::any(open)) break;
      low = core::select(f > 0.0, x, low);
      high = core::select(f > 0.0, high, x);
      const T step = f / (stiffness + yield.slope);
      T next = x + step;
      const core::MaskOf<T> inside = (next > low) & (next < high);
      if (core::any(open & !inside)) {
        const T scaled = x * exp(step / x);
        next = core::select(inside, next,
                            core::select((scaled > low) & (scaled < high), scaled, 0.5 * (low + high)));
      }
      x = core::select(open, next, x);
      open = open & !(inside & (abs(step) <= 1e-6 * x));
      if (!core::any(open)) break;
    }
    return x;
  }
}

}  // namespace mpm::physics
