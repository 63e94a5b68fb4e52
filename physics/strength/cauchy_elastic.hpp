// Hooke's law for the whole Cauchy stress (manual 3.2.1.11, which gives its parameters and no equation): as
// IsoElastic, but with Hooke's pressure, p = -K tr(e), so an EquationOfState is rejected.
// Tested by tests/physics/elastic_test.cpp.
#pragma once

#include <string_view>

#include "physics/strength/elasticity.hpp"

namespace mpm::physics {

struct CauchyElastic : IsotropicElasticity {
  static constexpr std::string_view name = "CauchyElastic";
  static constexpr std::string_view summary = "linear elastic, pressure included";
  using has_tangent = CauchyElastic;
  static constexpr std::array<core::Column, 0> state{};
  static constexpr bool own_pressure = true;

  static constexpr auto parameters() { return elastic_parameters<CauchyElastic>(); }
  void prepare() { derive_moduli(); }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    elastic_step(point);
  }
};

}  // namespace mpm::physics
