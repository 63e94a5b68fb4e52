// Metal foam of Deshpande and Fleck (manual 3.2.1.17; J. Mech. Phys. Solids 48 (2000) 1253; hardening: Reyes,
// Hopperstad, Berstad, Langseth, 8th International LS-DYNA Users Conference, 2004):
//   hat^2 = (sigma_e^2 + alfa^2 sigma_m^2)/(1 + (alfa/3)^2) = Y^2,   associated flow
//   Y = Yield0 + gama r + alal ln(1/(1 - r^bebe)),   r = hat_eps/epsud
// hat_eps is the strain conjugate to hat: in uniaxial stress both are the axial ones. It follows from the
// consistency condition with stress and Y at the end of the step. The logarithm locks the foam at r = 1; r is
// limited to 1 - 1e-12, above which Y is constant. Fails where ln(V/V0) reaches vole; 0 disables this. The
// law computes its own pressure: no EquationOfState. Tested by tests/physics/foam_test.cpp.
#pragma once

#include <cmath>
#include <string_view>

#include "core/simd/dual.hpp"
#include "physics/strength/johnson_cook_flow.hpp"
#include "physics/strength/plasticity.hpp"

namespace mpm::physics {

struct DFFoam : MisesPlasticity {  // yield0 is sigma_p
  static constexpr std::string_view name = "DFFoam";
  static constexpr std::string_view summary = "metal foam of Deshpande and Fleck";
  using has_tangent = DFFoam;
  static constexpr std::array state{core::Column::effective_plastic_strain, core::Column::damage};
  static constexpr bool sets_pressure = true;

  double alpha = 0;         ///< shape of the surface: 0 von Mises, 3/sqrt(2) no lateral plastic strain
  double locking = 0;       ///< epsud
  double logarithmic = 0;   ///< alal, stress
  double linear = 0;        ///< gama, stress
  double exponent = 0;      ///< bebe
  double break_strain = 0;  ///< vole
  double reference_density = 0;

  static constexpr auto parameters() {
    using P = DFFoam;
    return join(
        plastic_parameters<P>(),
        std::array<Parameter<P>, 6>{{
            {&P::alpha,
             {.name = "alfa",
              .required = true,
              .min = 0,
              .max = 2.1213203435596424,
              .meaning = "shape of the yield surface, alfa^2 <= 4.5"}},
            {&P::locking,
             {.name = "epsud",
              .required = true,
              .min = 0,
              .min_open = true,
              .meaning = "densification strain"}},
            {&P::logarithmic,
             {.name = "alal",
              .required = true,
              .min = 0,
              .dimension = "stress",
              .meaning = "alpha_2 of the hardening"}},
            {&P::linear,
             {.name = "gama",
              .required = true,
              .min = 0,
              .dimension = "stress",
              .meaning = "gamma of the hardening"}},
            {&P::exponent,
             {.name = "bebe",
              .required = true,
              .min = 0,
              .min_open = true,
              .meaning = "beta of the hardening"}},
            {&P::break_strain,
             {.name = "vole", .required = true, .min = 0, .meaning = "ln(V/V0) at which it fails; 0: never"}},
        }});
  }
  void prepare(double density) {
    derive_moduli();
    reference_density = density;
  }
  bool fails_by_damage() const { return break_strain > 0; }
  bool carries(core::Column column) const { return column != core::Column::damage || fails_by_damage(); }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    elastic_step_with_pressure(point);
    const T trial_e = mises(point.s), trial_m = -point.pressure;
    const T strain = point.effective_plastic_strain;
    const T before = yield(strain).value;
    const T increment = flow(trial_e, trial_m, strain, before);
    const T after = yield(strain + increment).value;
    const T x = increment / (shape() * after);
    point.s = (1.0 / (1.0 + (3 * shear) * x)) * point.s;
    point.pressure = -trial_m / (1.0 + (bulk * alpha * alpha) * x);
    point.effective_plastic_strain = strain + increment;
    point.yield_stress = after;
    point.plastic_work = 0.5 * (before + after) * increment;
    if (fails_by_damage()) {
      using core::log;
      const T stretch = -log(point.density * (1 / reference_density));
      point.damage = core::select(stretch >= break_strain, 1.0, point.damage);
    }
  }

 private:
  double shape() const { return 1 + alpha * alpha / 9; }

  template <class T>
  FlowStress<T> yield(const T& strain) const {
    using core::log;
    const T r = core::min(strain * (1 / locking), 1 - 1e-12);
    const FlowStress<T> power = power_hardening(0.0, 1.0, exponent, r);  // r^bebe and its slope
    const T left = 1.0 - power.value;
    const T slope = (linear + logarithmic * power.slope / left) * (1 / locking);
    return {yield0 + linear * r - logarithmic * log(left),
            core::select(strain < locking * (1 - 1e-12), slope, 0.0)};
  }

  /// The increment d of hat_eps: hat(d) - Y = 0, where the radial flow reduces the trial stress to
  ///   sigma_e/(1 + 3 G d/(k Y)),  sigma_m/(1 + K alfa^2 d/(k Y)),  k = 1 + (alfa/3)^2.
  /// Its derivatives follow from the equation at the result.
  template <class T>
  T flow(const T& trial_e, const T& trial_m, const T& strain, const T& start) const {
    const T ee = trial_e * trial_e * (1 / shape()), mm = trial_m * trial_m * (alpha * alpha / shape());
    if constexpr (core::derivatives_of < T >> 0) {
      const auto d = increment(ee.v, mm.v, strain.v, start.v);
      const Excess<T> at = excess(ee, mm, strain, T(d));
      return core::select(d > 0.0, core::implicit_root(T(d), at.value, -at.slope), T(d));
    } else {
      return increment(ee, mm, strain, start);
    }
  }

  template <class T>
  struct Excess {
    T value, slope, yield;
  };
  /// hat(d) - Y, its derivative with respect to d, and Y.
  template <class T>
  Excess<T> excess(const T& ee, const T& mm, const T& strain, const T& d) const {
    const double stiff_e = 3 * shear / shape(), stiff_m = bulk * alpha * alpha / shape();
    const FlowStress<T> y = yield(strain + d);
    const T u = d / y.value, du = (1.0 - u * y.slope) / y.value;
    const T pe = 1.0 / (1.0 + stiff_e * u), pm = 1.0 / (1.0 + stiff_m * u);
    const T hat = sqrt(ee * pe * pe + mm * pm * pm);
    return {hat - y.value, -(stiff_e * ee * pe * pe * pe + stiff_m * mm * pm * pm * pm) * du / hat - y.slope,
            y.value};
  }

  /// Newton's method in a shrinking bracket, independently per lane, as plastic_increment.
  template <class T>
  T increment(const T& ee, const T& mm, const T& strain, const T& start) const {
    using core::abs;
    using core::select;
    const double stiff_e = 3 * shear / shape(), stiff_m = bulk * alpha * alpha / shape();
    const T trial = sqrt(ee + mm);
    const core::MaskOf<T> plastic = trial > start;
    T d = 0.0;
    if (!core::any(plastic)) return d;
    const double softest = alpha > 0 ? std::min(stiff_e, stiff_m) : stiff_e;
    T low = 0.0, high = trial * (1 / softest);
    d = select(plastic, (trial - start) * trial / (stiff_e * ee + stiff_m * mm) * start, 0.0);
    d = select(d < high, d, 0.5 * high);
    for (int iteration = 0; iteration < 100; ++iteration) {
      const Excess<T> f = excess(ee, mm, strain, d);
      const core::MaskOf<T> open = plastic & (abs(f.value) > 1e-13 * f.yield) & (high - low > 1e-16 * high);
      if (!core::any(open)) break;
      low = select(f.value > 0.0, d, low);
      high = select(f.value > 0.0, high, d);
      T next = d - f.value / f.slope;
      next = select((next > low) & (next < high), next, 0.5 * (low + high));
      d = select(open, next, d);
    }
    return d;
  }
};

}  // namespace mpm::physics
