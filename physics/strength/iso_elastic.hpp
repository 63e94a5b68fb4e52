// Linear elasticity in the Jaumann rate of the Cauchy stress (manual 3.2.1.1, thesis 2.4.2): s += 2 G de'.
// The pressure comes from the equation of state, or from K without one. Hypoelastic: a closed cycle of large
// shear leaves a small residual stress. Tested by tests/physics/elastic_test.cpp.
#pragma once

#include <string_view>

#include "physics/strength/elasticity.hpp"

namespace mpm::physics {

struct IsoElastic : IsotropicElasticity {
  static constexpr std::string_view name = "IsoElastic";
  static constexpr std::string_view summary = "linear elastic";
  using has_tangent = IsoElastic;
  static constexpr std::array<core::Column, 0> state{};

  static constexpr auto parameters() { return elastic_parameters<IsoElastic>(); }
  void prepare() { derive_moduli(); }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    elastic_step(point);
  }
};

}  // namespace mpm::physics
