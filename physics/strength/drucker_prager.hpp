// Drucker-Prager plasticity with a tension cut-off (manual 3.2.1.16, thesis 6.2). With tau = sqrt(J2):
//   shear    f = tau + qfai sigma_m - kfai,   g = tau + qpsi sigma_m       (6-6, 6-9)
//   tension  f = sigma_m - ten_f, associated                               (6-7, 6-10)
// The trial stress returns to the surface along the flow at the end of the step, which is exact for these
// straight lines: to the cone, to the cut-off, or to the edge between them, where both mechanisms flow
// (Koiter). The thesis instead separates the two by a diagonal h (6-11), which near the edge leaves stress
// outside one of the surfaces. Equivalent plastic strain: (6-39) and (6-48) combined. The Mohr-Coulomb
// constants phi, c, psi as an alternative to qfai, kfai, qpsi are matched by (6-50) to (6-58). ten_f may not
// exceed the apex kfai/qfai (6-8), nor qpsi qfai: flow would then release energy. Where qfai = 0 there is no
// apex and ten_f is used as given; the thesis sets it to zero (6-49). With closes="1" material that the
// cut-off has let expand bears pressure only once it is as dense as before; without, as in the manual, at
// once, and loose grains that fall together stay at a low density (A. P. Tampubolon et al., ACM Transactions
// on Graphics 36 (2017) 105, correct the same gain of volume). A volume of 8 m/rho0 is the largest. The law
// computes its own pressure: no EquationOfState. Tested by tests/physics/drucker_prager_test.cpp.
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "physics/strength/elasticity.hpp"

namespace mpm::physics {

struct DruckerPrager : IsotropicElasticity {
  static constexpr std::string_view name = "DruckerPrager";
  static constexpr std::string_view summary =
      "soil: friction, cohesion, dilation, tension cut-off; opens to a volume of 8 m/rho0 at most";
  using has_tangent = DruckerPrager;
  /// The plastic volumetric strain is what the cut-off has let open and is not closed yet; with `closes`
  /// only.
  static constexpr std::array state{core::Column::effective_plastic_strain,
                                    core::Column::plastic_volumetric_strain};
  static constexpr bool sets_pressure = true;
  /// Soil of an eighth of its density consists of grains that have lost touch: a gradient of velocity between
  /// them opens it no further. 8 is the volume of a cell for a particle that it has alone, of two along an
  /// edge.
  static constexpr double largest_volume = 8;

  static constexpr double not_given = -1;
  double friction = not_given;                                    ///< qfai
  double cohesion = not_given;                                    ///< kfai, stress
  double dilation = not_given;                                    ///< qpsi
  double tension = 0;                                             ///< ten_f, stress
  double friction_angle = not_given, dilation_angle = not_given;  ///< phi and psi, degrees
  double coulomb_cohesion = not_given;                            ///< c, stress
  double match = 2;
  double closes = 0;
  double plastic_work_coefficient = 0;
  /// Derived: by how much the tangent along a direction n may exceed K + 4/3 G where the cone is reached.
  /// Non-associated flow reduces that modulus by (G s_nn/tau + K qfai)(G s_nn/tau + K qpsi)/(G + K qfai
  /// qpsi), which is negative between the two roots.
  double stiffening = 0;

  static constexpr auto parameters() {
    using P = DruckerPrager;
    return join(
        elastic_parameters<P>(),
        std::array<Parameter<P>, 10>{{
            {&P::friction,
             {.name = "qfai", .min = 0, .meaning = "friction parameter", .group = "qfai, kfai, qpsi"}},
            {&P::cohesion,
             {.name = "kfai",
              .min = 0,
              .dimension = "stress",
              .meaning = "cohesion parameter: sqrt(J2) at yield without mean stress",
              .group = "qfai, kfai, qpsi"}},
            {&P::dilation,
             {.name = "qpsi",
              .min = 0,
              .meaning = "dilation parameter, <= qfai",
              .group = "qfai, kfai, qpsi"}},
            {&P::tension,
             {.name = "ten_f",
              .required = true,
              .min = 0,
              .dimension = "stress",
              .meaning = "largest mean tension, <= kfai/qfai"}},
            {&P::friction_angle,
             {.name = "phi",
              .min = 0,
              .max = 90,
              .max_open = true,
              .dimension = "degree",
              .meaning = "instead of qfai, kfai and qpsi: Mohr-Coulomb friction angle",
              .group = "phi, c, psi"}},
            {&P::coulomb_cohesion,
             {.name = "c",
              .min = 0,
              .dimension = "stress",
              .meaning = "Mohr-Coulomb cohesion",
              .group = "phi, c, psi"}},
            {&P::dilation_angle,
             {.name = "psi",
              .min = 0,
              .max = 90,
              .max_open = true,
              .dimension = "degree",
              .meaning = "Mohr-Coulomb dilation angle, <= phi",
              .group = "phi, c, psi"}},
            {&P::match,
             {.name = "match",
              .default_value = 2,
              .min = 1,
              .max = 3,
              .integer = true,
              .meaning = "cone for phi, c, psi: 1 through the compressive edges of the Mohr-Coulomb pyramid, "
                         "2 through its tensile edges, 3 inscribed (plane strain)"}},
            {&P::closes,
             {.name = "closes",
              .default_value = 0,
              .min = 0,
              .max = 1,
              .integer = true,
              .meaning = "1: what tension has opened bears no pressure until it is closed"}},
            {&P::plastic_work_coefficient, plastic_work_row},
        }});
  }

  std::string fault() const {
    const bool cone = friction != not_given, pyramid = friction_angle != not_given;
    if (cone == pyramid) return "DruckerPrager needs either qfai, kfai and qpsi or phi, c and psi";
    if (pyramid && dilation_angle > friction_angle) return "psi must not exceed phi";
    if (cone && dilation > friction) return "qpsi must not exceed qfai";
    DruckerPrager law = *this;
    law.match_pyramid();
    if (law.friction == 0 && law.cohesion == 0) return "without friction and cohesion there is no strength";
    if (law.tension > (1 + rounding) * law.apex()) {
      return "ten_f must not exceed the apex of the cone, kfai/qfai = " + std::to_string(law.apex());
    }
    return "";
  }
  void prepare() {
    derive_moduli();
    match_pyramid();
    tension = std::min(tension, apex());
    const double excess = bulk * (friction - dilation);
    stiffening = excess * excess / (4 * (shear + bulk * friction * dilation));
  }
  bool carries(core::Column column) const {
    return closes != 0 || column != core::Column::plastic_volumetric_strain;
  }
  /// kfai/qfai, the mean tension at which the cone ends.
  double apex() const { return friction > 0 ? cohesion / friction : HUGE_VAL; }

  /// What the cut-off does not hold together begins open, without the elastic work of opening it.
  template <class T>
  T place(StrengthPoint<T>& point, const T& relative_volume) const {
    StrengthPoint<T> held{};
    IsotropicElasticity::place(point, relative_volume);
    return IsotropicElasticity::place(held, core::min(relative_volume, T(std::exp(tension / bulk))));
  }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    using core::max;
    using core::select;
    const T mean_before = -point.pressure;
    elastic_step_with_pressure(point);
    T mean = -point.pressure, closing = 0.0;
    if (closes != 0) {
      // The change of the volume's logarithm: rates would let a grain that opens and closes lose volume.
      mean = mean_before + bulk * core::log(max(point.volume_ratio, 0.1));
      closing = core::min(point.plastic_volumetric_strain, max((tension - mean) * (1 / bulk), 0.0));
      mean += bulk * closing;
    }
    const T tau = sqrt(0.5 * contract(point.s, point.s));
    // Shear alone (6-34); where the mean stress then exceeds the cut-off, the tension mechanism is active too
    // and removes the excess, and shear flows only up to the edge (or not at all).
    const double edge = cohesion - friction * tension;
    const T alone = max(tau + friction * mean - cohesion, 0.0) * (1 / (shear + bulk * friction * dilation));
    const core::MaskOf<T> torn = mean - (bulk * dilation) * alone > tension;
    const T slip = select(torn, max(tau - edge, 0.0) * (1 / shear), alone);
    const T expansion = select(torn, (mean - tension) * (1 / bulk), dilation * slip);
    // On the cut-off exactly: what has come apart bears nothing, however large its volume.
    const T mean_after = select(torn, T(tension), mean - bulk * expansion);
    const T tau_after = select(torn, core::min(tau, T(edge)), max(tau - shear * slip, 0.0));
    point.s = select(slip > 0.0, tau_after / tau, T(1.0)) * point.s;
    point.pressure = -mean_after;
    if (closes != 0) point.plastic_volumetric_strain += select(torn, expansion, T(0.0)) - closing;
    point.effective_plastic_strain += sqrt(slip * slip * (1.0 / 3) + expansion * expansion * (2.0 / 9));
    const T strength = cohesion - friction * mean_after;
    point.bulk_modulus = bulk + select(tau_after < (1 - 1e-6) * strength, 0.0, T(stiffening));
    point.yield_stress = std::sqrt(3.0) * strength;
    point.plastic_work = tau_after * slip + mean_after * (expansion - closing);
  }

 private:
  /// How far ten_f may exceed the apex because of rounded constants; it is then set to the apex. The thesis'
  /// own table 6.5 gives 112.21 kPa for an apex of 112.207 kPa.
  static constexpr double rounding = 1e-3;

  void match_pyramid() {
    if (friction_angle == not_given) return;
    const double degree = std::acos(-1.0) / 180;
    friction = slope(friction_angle * degree);
    dilation = slope(dilation_angle * degree);
    const double cosine = std::cos(friction_angle * degree), sine = std::sin(friction_angle * degree);
    cohesion = match == 3 ? 3 * coulomb_cohesion * cosine / std::sqrt(9 * cosine * cosine + 12 * sine * sine)
                          : 6 * coulomb_cohesion * cosine / (std::sqrt(3.0) * (3 - sign() * sine));
  }
  double sign() const { return match == 1 ? 1 : -1; }
  double slope(double angle) const {
    const double cosine = std::cos(angle), sine = std::sin(angle);
    return match == 3 ? 3 * sine / std::sqrt(9 * cosine * cosine + 12 * sine * sine)
                      : 6 * sine / (std::sqrt(3.0) * (3 - sign() * sine));
  }
};

}  // namespace mpm::physics
