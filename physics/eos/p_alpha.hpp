// Porous solid by the p-alpha law (Herrmann 1969, Carroll and Holt 1972; manual 3-52): with the distension
// alpha = v/v_solid and the equation f of the solid, whose E is per its own initial volume,
//   p = f(v/alpha, e)/alpha
//   crushing  alpha = 1 + (alpha_p - 1) [(Plock - p)/(Plock - Pcrush)]^n,   alpha = 1 from Plock on
//   elastic   alpha = alpha* + k (p* - p),  k = k0 (alpha* - 1)/(alpha_p - 1), from the point (p*, alpha*)
//             where crushing stopped; first that is (Pcrush, alpha_p)
// alpha_p = rho_s/[rho0 (1 + Pcrush/K)] with the solid's density rho_s at that point. K is rho0 C0^2 where C0
// is given; without it, and over Gruneisen, whose C0 is the solid's, the porosity is constant in elastic
// loading: k0 = 0, alpha_p = rho0s/rho0. alpha is found with the energy of the beginning of the step. Tested
// by tests/physics/p_alpha_test.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "core/simd/math.hpp"
#include "physics/eos/point.hpp"
#include "physics/parameter.hpp"

namespace mpm::physics {

/// EOSID: the input's number of the solid's equation. Specialised beside the list of laws.
template <class Solid>
inline constexpr int solid_number = 0;

template <class Solid>
struct PAlpha : Solid {
  static constexpr std::string_view name = "PAlpha";
  static constexpr std::string_view summary = "porous solid: p-alpha about another equation of state";
  static constexpr std::array state{core::Column::porosity};

  double p_lock = 0, p_crush = 0;  ///< stress
  double n = 0;
  double solid_density = 0;
  double number = 0;
  double sound_speed = 0;  ///< of the porous solid at rest; 0: not given
  double density_ratio = 1, first_distension = 1, elastic_slope = 0;   ///< rho0/rho0s, alpha_p, k0, derived
  double compression_limit = std::numeric_limits<double>::infinity();  ///< derived

  PAlpha() {
    for (const auto& [member, info] : Solid::parameters()) {
      if (info.required) this->*member = std::numeric_limits<double>::quiet_NaN();
    }
  }

  static constexpr auto parameters() {
    using P = PAlpha;
    return join(
        std::array<Parameter<P>, 5>{{
            {&P::p_lock,
             {.name = "Plock",
              .required = true,
              .min = 0,
              .min_open = true,
              .dimension = "stress",
              .meaning = "pressure of full compaction, > Pcrush"}},
            {&P::p_crush,
             {.name = "Pcrush",
              .required = true,
              .min = 0,
              .dimension = "stress",
              .meaning = "pressure where pores begin to close"}},
            {&P::n,
             {.name = "n", .required = true, .min = 0, .min_open = true, .meaning = "compaction exponent"}},
            {&P::solid_density,
             {.name = "rho0s",
              .required = true,
              .min = 0,
              .min_open = true,
              .dimension = "density",
              .meaning = "density of the solid, > ReferenceDensity"}},
            {&P::number,
             {.name = "EOSID",
              .required = true,
              .min = 1,
              .max = 3,
              .integer = true,
              .meaning = "equation of the solid: 1 Polynomial, 2 Polynomial2, 3 Gruneisen"}},
        }},
        solid_parameters());
  }
  /// Whether C0 is the solid's.
  static constexpr bool solid_has_sound_speed() {
    for (const auto& parameter : Solid::parameters()) {
      if (parameter.info.name == "C0") return true;
    }
    return false;
  }
  /// The laws of the list share one name: the input's EOSID selects one.
  static bool chosen_by(const core::LawInput& input) {
    return input.value_or("EOSID", 0) == solid_number<Solid>;
  }

  std::string fault(double reference_density) const {
    for (const auto& [member, info] : Solid::parameters()) {
      if (std::isnan(this->*member)) {
        return "EOSID " + std::to_string(static_cast<int>(number)) + ", " + std::string(Solid::name) +
               ", needs the attribute " + std::string(info.name);
      }
    }
    if (!(p_lock > p_crush)) return "Plock must be greater than Pcrush";
    if (!(solid_density > reference_density)) return "rho0s must be greater than ReferenceDensity";
    PAlpha tried = *this;
    tried.prepare(reference_density);
    if (!(tried.elastic_slope >= 0))
      return "C0 must be smaller: the porous solid cannot be stiffer than its solid";
    if (!(tried.first_distension > 1)) return "C0 must be greater: all pores would close below Pcrush";
    return {};
  }
  void prepare(double reference_density) {
    if constexpr (requires { Solid::prepare(solid_density); }) Solid::prepare(solid_density);
    density_ratio = reference_density / solid_density;
    first_distension = 1 / density_ratio;
    elastic_slope = 0;
    if constexpr (requires { Solid::compression_limit; }) {
      compression_limit = (1 + Solid::compression_limit) / density_ratio - 1;
    }
    if (sound_speed > 0 && p_crush > 0) {
      const double modulus = reference_density * sound_speed * sound_speed;
      const double distension = distension_at(p_crush, p_crush / modulus);
      elastic_slope = (first_distension - distension) / p_crush;
      first_distension = distension;
    }
  }

  template <class T>
  void initialise(EosPoint<T>& point) const {
    point.porosity = 1 - 1 / first_distension;
  }

  template <class T>
  LinearisedPressure<T> linearise(EosPoint<T>& point) const {
    using core::pow;
    using core::select;
    const double span = p_lock - p_crush, pores = first_distension - 1;
    const T reached = 1.0 / (1.0 - point.porosity);  // alpha*
    const T x_reached = core::min(pow(core::max((reached - 1.0) * (1 / pores), 0.0), 1 / n), 1.0);
    const T p_reached = p_lock - span * x_reached;
    const T slope = elastic_slope * core::max((reached - 1.0) * (1 / pores), 0.0);

    const T elastic = elastic_distension(point, reached, p_reached, slope);
    const core::MaskOf<T> crushes = (solid(point, elastic).p > p_reached) & (reached > 1.0);
    T distension = elastic;
    if (core::any(crushes)) {
      const T crushed = crushed_distension(point, x_reached, crushes);
      distension = select(crushes, crushed, elastic);
      point.porosity = select(crushes, 1.0 - 1.0 / crushed, point.porosity);
    }
    // The stiffness is that of elastic unloading, the largest.
    const Pressure<T> now = solid(point, distension);
    const T opening = elastic_slope * core::max((1.0 / (1.0 - point.porosity) - 1.0) * (1 / pores), 0.0);
    const T share = 1.0 / (1.0 + opening * now.by_distension);
    const T b = now.b * share;
    return {now.p - b * point.energy, b, now.by_compression * share, 0.0};
  }

 private:
  /// p at a given distension and its derivatives with respect to alpha, mu and E.
  template <class T>
  struct Pressure {
    T p, by_distension, by_compression, b;
  };
  template <class T>
  Pressure<T> solid(const EosPoint<T>& point, const T& distension) const {
    const T density = density_ratio * (1.0 + point.compression);  // over the solid's
    EosPoint<T> inner{};
    inner.compression = distension * density - 1.0;
    if constexpr (requires { Solid::compression_limit; }) {
      inner.compression = core::min(inner.compression, Solid::compression_limit);
    }
    inner.relative_volume = 1.0 / (1.0 + inner.compression);
    inner.energy = point.energy * (1 / density_ratio);
    const LinearisedPressure<T> line = Solid::linearise(inner);
    const T share = 1.0 / distension, slope = line.da + line.db * inner.energy;
    const T p = (line.a + line.b * inner.energy) * share;
    return {p, share * (slope * density - p), density_ratio * slope, line.b * share * (1 / density_ratio)};
  }

  /// alpha = alpha* + k (p* - p)
  template <class T>
  T elastic_distension(const EosPoint<T>& point, const T& reached, const T& p_reached, const T& slope) const {
    T distension = reached;
    if (elastic_slope == 0) return distension;
    for (int iteration = 0; iteration < 50; ++iteration) {
      const Pressure<T> now = solid(point, distension);
      const T f = distension - reached - slope * (p_reached - now.p);
      const core::MaskOf<T> open = core::abs(f) > 4e-15;
      if (!core::any(open)) break;
      distension = core::select(open, distension - f / (1.0 + slope * now.by_distension), distension);
    }
    return distension;
  }

  /// Where p(alpha) meets the crush curve, for the lanes of `crushes`. In x = [(alpha - 1)/(alpha_p -
  /// 1)]^(1/n) the curve is straight, p = Plock - (Plock - Pcrush) x, and f below increases with x: Newton's
  /// method in a shrinking bracket, independently per lane.
  template <class T>
  T crushed_distension(const EosPoint<T>& point, const T& x_reached, core::MaskOf<T> crushes) const {
    using core::pow;
    using core::select;
    const double span = p_lock - p_crush, pores = first_distension - 1;
    const core::MaskOf<T> compacted = solid(point, T(1.0)).p >= p_lock;
    T low = 0.0, high = x_reached, x = x_reached;
    for (int iteration = 0; iteration < 100; ++iteration) {
      const T power = pow(x, n);
      const Pressure<T> now = solid(point, T(1.0 + pores * power));
      const T f = now.p - p_lock + span * x;
      const core::MaskOf<T> open =
          crushes & !compacted & (core::abs(f) > 1e-14 * p_lock + 1e-15 * now.by_compression);
      if (!core::any(open)) break;
      high = select(open & (f > 0.0), x, high);
      low = select(open & !(f > 0.0), x, low);
      const T step = f / (span + now.by_distension * (n * pores) * power / core::max(x, 1e-300));
      const T next = x - step;
      x = select(open, select((next > low) & (next < high), next, 0.5 * (low + high)), x);
    }
    return select(compacted, 1.0, 1.0 + pores * pow(x, n));
  }

  /// alpha with p(alpha) = pressure at the compression mu, without energy; infinite where the solid alone
  /// does not reach the pressure.
  double distension_at(double pressure, double mu) const {
    EosPoint<double> point{};
    point.compression = mu;
    double low = 0.5, high = 1 / density_ratio;
    if (solid(point, high).p < pressure * (1 - 1e-12)) return std::numeric_limits<double>::infinity();
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (solid(point, middle).p < pressure ? low : high) = middle;
    }
    return high;
  }
  /// The solid's attributes, required together for the chosen EOSID; and C0, if it is not among them.
  static constexpr auto solid_parameters() {
    constexpr auto inner = Solid::parameters();
    std::array<Parameter<PAlpha>, inner.size()> table{};
    for (std::size_t i = 0; i < inner.size(); ++i) {
      table[i] = {inner[i].member, inner[i].info};
      table[i].info.required = false;
    }
    if constexpr (solid_has_sound_speed()) {
      return table;
    } else {
      return join(
          table,
          std::array<Parameter<PAlpha>, 1>{
              {{&PAlpha::sound_speed,
                {.name = "C0",
                 .min = 0,
                 .min_open = true,
                 .dimension = "velocity",
                 .meaning = "sound speed at rest: of the solid with EOSID 3, else of the porous solid"}}}});
    }
  }
};

}  // namespace mpm::physics
