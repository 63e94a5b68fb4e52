// A rigid body (manual 3.2.1.13): no stress and no deformation, so a wave speed of zero; only its velocity
// enters the critical step. Its volume and energy are constant. Its motion is computed by the time step: free
// under gravity, or prescribed. Tested by tests/physics/rigid_test.cpp.
#pragma once

#include <array>
#include <string_view>

#include "physics/parameter.hpp"
#include "physics/strength/point.hpp"

namespace mpm::physics {

struct Rigid {
  static constexpr std::string_view name = "Rigid";
  static constexpr std::string_view summary = "rigid body, for contact";
  static constexpr std::array<core::Column, 0> state{};
  static constexpr bool sets_pressure = true;
  static constexpr bool rigid = true;

  static constexpr double bulk = 0;

  static constexpr std::array<Parameter<Rigid>, 0> parameters() { return {}; }

  template <class T>
  T place(StrengthPoint<T>& point, const T&) const {
    point.pressure = 0.0;
    return 0.0;
  }
  template <class T>
  void update(StrengthPoint<T>& point) const {
    point.s = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    point.pressure = 0.0;
    point.shear_modulus = point.bulk_modulus = 0.0;
  }
};

}  // namespace mpm::physics
