// The two instances of every law: the vector types of the production code, and scalars, with which the tests
// compare them.
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
