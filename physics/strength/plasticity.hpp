// Common part of the von Mises laws: yield stress and heating as parameters, and the radial return.
#pragma once

#include <array>
#include <string>

#include "physics/strength/elasticity.hpp"

namespace mpm::physics {

struct MisesPlasticity : IsotropicElasticity {
  double yield0 = 0;                    ///< initial yield stress
  double plastic_work_coefficient = 0;  ///< fraction of the plastic work that is converted to heat

  /// Records the plastic strain increment and scales the trial stress back to the yield surface (thesis 2-112
  /// to 2-120). `before` and `after` are the yield stress at the ends of the plastic part of the step; where
  /// the increment is zero the trial stress is unchanged.
  template <class T>
  static void radial_return(StrengthPoint<T>& point, const T& trial, const T& before, const T& after,
                            const T& increment) {
    using core::min;
    // Below the yield surface the ratio exceeds one; 0/0 at zero stress counts as below.
    point.s = min(after / trial, 1.0) * point.s;
    point.effective_plastic_strain += increment;
    point.yield_stress = after;
    point.plastic_work = 0.5 * (before + after) * increment;
  }

  /// The same for an increment found by iteration. `start` is the stress at which flow starts: `threshold`,
  /// the yield stress for a vanishing increment, or the stress before the step where that is greater, as in
  /// fast flow.
  template <class T>
  void return_to(StrengthPoint<T>& point, const T& trial, const T& start, const T& threshold,
                 const T& increment) const {
    const T after = core::select(increment > 0.0, trial - (3 * shear) * increment, threshold);
    radial_return(point, trial, start, after, increment);
  }
};

/// Linear isotropic hardening: E_p = d yield stress / d plastic strain, of the tangent modulus
/// d stress / d strain of a bar beyond yield.
inline double plastic_modulus(double young, double tangent_modulus) {
  return young * tangent_modulus / (young - tangent_modulus);
}
inline std::string tangent_modulus_fault(double young, double tangent_modulus) {
  return tangent_modulus < young ? "" : "TangMod must be smaller than Young";
}

template <class Law>
constexpr auto plastic_parameters() {
  return join(elastic_parameters<Law>(),
              std::array<Parameter<Law>, 2>{
                  {{&Law::yield0, yield0_row}, {&Law::plastic_work_coefficient, plastic_work_row}}});
}

}  // namespace mpm::physics
