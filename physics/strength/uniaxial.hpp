// Bars (manual 3.2.1.2, 3.2.1.5): the stress along the bar alone, sigma = sigma + Young d_eps, and with
// linear isotropic hardening |sigma| <= Yield0 + E_p epef, E_p = Young TangMod/(Young - TangMod) as for
// IsoHarden. x is the bar's own axis: the caller passes D_xx as the axial strain rate and reads sigma_xx; a
// bar has no spin. The wave speed is sqrt(Young/rho). Poisson is accepted and has no effect. As the Cauchy
// stress is s - p I, s = sigma diag(2, -1, -1)/3 and p = -sigma/3. A bar of another density is not
// prestressed. Tested by tests/physics/bar_law_test.cpp.
#pragma once

#include <string>
#include <string_view>

#include "physics/strength/plasticity.hpp"

namespace mpm::physics {

struct UniaxialElasticity {
  static constexpr bool sets_pressure = true;
  static constexpr bool uniaxial = true;

  double young = 0;                  ///< stress
  static constexpr double bulk = 0;  ///< a broken bar has no stress at any density

  template <class T>
  T place(StrengthPoint<T>& point, const T&) const {
    point.pressure = 0.0;
    return 0.0;
  }

 protected:
  template <class T>
  T trial(const StrengthPoint<T>& point) const {
    return young * (point.strain.xx + (1.0 / 3) * point.volumetric_strain) - 3.0 * point.pressure;
  }
  template <class T>
  void put(StrengthPoint<T>& point, const T& stress) const {
    const T third = (1.0 / 3) * stress;
    point.s = {2.0 * third, -third, -third, 0.0, 0.0, 0.0};
    point.pressure = -third;
    point.shear_modulus = 0.0;
    point.bulk_modulus = young;
  }
};

struct Elastic1D : UniaxialElasticity {
  static constexpr std::string_view name = "Elastic_1D";
  static constexpr std::string_view summary = "linear elastic bar";
  static constexpr std::array<core::Column, 0> state{};

  double poisson = 0;

  static constexpr auto parameters() { return elastic_parameters<Elastic1D>(); }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    put(point, trial(point));
  }
};

struct LinHarElaPlastic1D : UniaxialElasticity {
  static constexpr std::string_view name = "LinHarElaPlastic_1D";
  static constexpr std::string_view summary = "elastic-plastic bar, linear isotropic hardening";
  static constexpr std::array state{core::Column::effective_plastic_strain};

  double yield0 = 0;  ///< stress
  double plastic_work_coefficient = 0;
  double tangent_modulus = 0;  ///< stress
  double hardening = 0;        ///< E_p, derived

  static constexpr auto parameters() {
    using P = LinHarElaPlastic1D;
    return std::array<Parameter<P>, 4>{{
        {&P::young, young_row},
        {&P::yield0, yield0_row},
        {&P::plastic_work_coefficient, plastic_work_row},
        {&P::tangent_modulus, tangent_modulus_row},
    }};
  }
  std::string fault() const { return tangent_modulus_fault(young, tangent_modulus); }
  void prepare() { hardening = plastic_modulus(young, tangent_modulus); }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    using core::max;
    const T stress = trial(point), size = core::abs(stress);
    const T before = yield0 + hardening * point.effective_plastic_strain;
    const T increment = max(size - before, 0.0) * (1 / (young + hardening));
    const T left = size - young * increment;
    put(point, core::select(stress < 0.0, -left, left));
    point.effective_plastic_strain += increment;
    point.yield_stress = before + hardening * increment;
    point.plastic_work = 0.5 * (before + point.yield_stress) * increment;
  }
};

}  // namespace mpm::physics
