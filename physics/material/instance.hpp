// The two instances of every law: the vectors of the production code, and one number after another, which the
// tests compare with them.
#pragma once

#include <type_traits>

#include "core/simd/lanes.hpp"

namespace mpm::physics {

enum class Instance { vectors, scalars };

/// f(std::type_identity<T>()) with the value type of the instance.
template <class F>
void as_chosen(Instance instance, F f) {
  if (instance == Instance::vectors)
    f(std::type_identity<core::Real>());
  else
    f(std::type_identity<double>());
}

}  // namespace mpm::physics
