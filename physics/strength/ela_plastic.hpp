// Von Mises plasticity without hardening (manual 3.2.1.3, thesis 2-98 to 2-115): sigma_y = Yield0.
// Radial return; exact for one step of any size along a fixed direction. Tested by tests/physics/j2_test.cpp.
#pragma once

#include <string_view>

#include "physics/strength/plasticity.hpp"

namespace mpm::physics {

struct ElaPlastic : MisesPlasticity {
  static constexpr std::string_view name = "ElaPlastic";
  static constexpr std::string_view summary = "elastic, perfectly plastic, von Mises";
  using has_tangent = ElaPlastic;
  static constexpr std::array state{core::Column::effective_plastic_strain};

  static constexpr auto parameters() { return plastic_parameters<ElaPlastic>(); }
  void prepare() { derive_moduli(); }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    elastic_step(point);
    const T trial = mises(point.s), yield = yield0;
    radial_return(point, trial, yield, yield, core::max(trial - yield, 0.0) * (1 / (3 * shear)));
  }
};

}  // namespace mpm::physics
