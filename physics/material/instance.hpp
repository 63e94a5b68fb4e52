// The instances of every law: the vector types of the production code, scalars, with which the tests compare
// them, and for laws with a tangent dual numbers, which carry derivatives.
//
// A law declares `using has_tangent = ` its own name where its functions, with dual numbers for T, give the
// derivatives of its results: all functions that it calls must be those of core/simd/dual.hpp, and a value
// found by iteration needs its derivatives from the equation that it solves
// (physics/strength/consistency.hpp). The name, because a law that derives from it may not.
#pragma once

#include <stdexcept>
#include <type_traits>

#include "core/built.hpp"
#include "core/simd/dual.hpp"

namespace mpm::physics {

/// The components of h = dt L with respect to which one sweep differentiates. All nine at once leave too few
/// registers, one at a time repeats the values too often: both take up to twice as long.
inline constexpr int directions_per_sweep = 3;
static_assert(9 % directions_per_sweep == 0);
using DualReal = core::Dual<core::Real, directions_per_sweep>;

enum class Instance { vectors, scalars, derivatives };

template <class Law>
concept HasTangent = std::is_same_v<typename Law::has_tangent, Law>;

/// f(std::type_identity<T>()) with the value type of the instance.
template <class Law, class F>
void as_chosen(Instance instance, F f) {
  if (instance == Instance::vectors) {
    f(std::type_identity<core::Real>());
  } else if (instance == Instance::scalars) {
    f(std::type_identity<double>());
  } else if constexpr (core::built_implicit && HasTangent<Law>) {
    f(std::type_identity<DualReal>());
  } else {
    throw std::logic_error("derivatives of a law that has no tangent, or without implicit steps");
  }
}

}  // namespace mpm::physics
