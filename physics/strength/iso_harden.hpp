// Von Mises plasticity with linear isotropic hardening (manual 3.2.1.4, thesis 2-98 to 2-115):
//   sigma_y = Yield0 + E_p epef,   E_p = Young TangMod / (Young - TangMod)
// Radial return; exact for one step of any size along a fixed direction. Tested by tests/physics/j2_test.cpp.
#pragma once

#include <string>
#include <string_view>

#include "physics/strength/plasticity.hpp"

namespace mpm::physics {

struct IsoHarden : MisesPlasticity {
  static constexpr std::string_view name = "IsoHarden";
  static constexpr std::string_view summary = "elastic-plastic, von Mises, linear isotropic hardening";
  using has_tangent = IsoHarden;
  static constexpr std::array state{core::Column::effective_plastic_strain};

  double tangent_modulus = 0;  ///< d stress / d strain of a bar beyond yield
  double hardening = 0;        ///< E_p, derived

  static constexpr auto parameters() {
    return join(plastic_parameters<IsoHarden>(),
                std::array<Parameter<IsoHarden>, 1>{{{&IsoHarden::tangent_modulus, tangent_modulus_row}}});
  }
  std::string fault() const { return tangent_modulus_fault(young, tangent_modulus); }
  void prepare() {
    derive_moduli();
    hardening = plastic_modulus(young, tangent_modulus);
  }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    using core::max;
    elastic_step(point);
    const T trial = mises(point.s);
    const T yield = yield0 + hardening * point.effective_plastic_strain;
    const T increment = max(trial - yield, 0.0) * (1 / (3 * shear + hardening));  // 2-112
    radial_return(point, trial, yield, yield + hardening * increment, increment);
  }
};

}  // namespace mpm::physics
