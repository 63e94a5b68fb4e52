// Porous metal of Gurson, Tvergaard and Needleman (manual 3.2.1.18; Tvergaard and Needleman, Acta
// Metallurgica 32 (1984) 157; integration in the invariants after Aravas, Int. J. Numer. Methods Eng. 24
// (1987) 1395):
//   Phi = (q/M)^2 + 2 q1 f* cosh(3 q2 sigma_m/(2 M)) - 1 - (q1 f*)^2,   f* of f by (3.38)       (3.37)
//   df = (1 - f) d eps_v + A(e) de,  A the normal distribution fN, eN, sN                       (3.39 - 3.42)
//   Under pressure no voids nucleate: the manual does not say, but particles debond from the matrix and crack
//   under tension, and pressure would close such voids at once.
//   (1 - f) M de = sigma : d eps_p,   M(e) the stress of the matrix:
//   TangMod: linear;  N_hard: Yield0 (1 + Young e/Yield0)^(1/N_hard);  B n C epso: Johnson-Cook without heat
// The plastic increment has the direction of the final stress, with f* and M of the start in its proportions,
// and ends on the surface of the final f and M, with Phi to 1e-12 (1e-9 in steps of 1 %): first order. Voids
// closed by pressure, to f < 1e-12, are set to zero. Fails by TEPLA-F (3.43), stored as damage: (f/ff)^2 +
// (eps_p/epmax)^2 >= 1, without epmax by f alone; eps_p is the deviatoric plastic strain, e that of the
// matrix. With Gauss_sn, a standard deviation, the initial f of each particle is drawn from its identity:
// normal with mean Gauss_f0 (f0 if absent), truncated to [0, ff). The law computes its own pressure: no
// EquationOfState. Limit: steps of more than some 5 % of strain, or first voids that nucleate under a tension
// of more than some 15 M, may end inside the surface, without deviator; they are counted. Tested by
// tests/physics/gurson_test.cpp.
#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "physics/strength/johnson_cook_flow.hpp"
#include "physics/strength/plasticity.hpp"

namespace mpm::physics {

struct Gurson : MisesPlasticity {
  static constexpr std::string_view name = "Gurson";
  static constexpr std::string_view summary = "porous metal: growth, nucleation and coalescence of voids";
  /// history_0: plastic strain of the matrix.
  static constexpr std::array state{core::Column::effective_plastic_strain, core::Column::porosity,
                                    core::Column::history_0, core::Column::damage};
  static constexpr bool sets_pressure = true, may_not_resolve = true;

  static constexpr double not_given = -1;
  double q1 = 0, q2 = 0;
  double f0 = 0, mean_f0 = not_given, deviation_f0 = 0;
  double fc = 0, ff = 0;
  double fn = 0, sn = 1, en = 0;  ///< nucleation
  double epmax = not_given;
  double tangent_modulus = not_given;            ///< stress
  double power = not_given;                      ///< N_hard
  double b = not_given, n = 0, c = 0, epso = 1;  ///< Johnson-Cook: stress, 1, 1, 1/time
  double hardening = 0;                          ///< of the linear matrix, derived

  static constexpr auto parameters() {
    using P = Gurson;
    return join(
        plastic_parameters<P>(),
        std::array<Parameter<P>, 17>{{
            {&P::q1,
             {.name = "q1", .required = true, .min = 0, .min_open = true, .meaning = "Tvergaard constant"}},
            {&P::q2,
             {.name = "q2", .required = true, .min = 0, .min_open = true, .meaning = "Tvergaard constant"}},
            {&P::f0,
             {.name = "f0",
              .required = true,
              .min = 0,
              .max = 1,
              .max_open = true,
              .meaning = "initial void fraction, < ff"}},
            {&P::mean_f0,
             {.name = "Gauss_f0",
              .min = 0,
              .max = 1,
              .max_open = true,
              .meaning = "mean of a scattered initial void fraction; f0 where absent"}},
            {&P::deviation_f0,
             {.name = "Gauss_sn",
              .default_value = 0,
              .min = 0,
              .meaning = "standard deviation of a scattered initial void fraction; 0: no scatter"}},
            {&P::fc,
             {.name = "fc",
              .required = true,
              .min = 0,
              .max = 1,
              .min_open = true,
              .max_open = true,
              .meaning = "void fraction at which voids begin to coalesce, < ff and < 1/q1"}},
            {&P::ff,
             {.name = "ff",
              .required = true,
              .min = 0,
              .max = 1,
              .min_open = true,
              .meaning = "void fraction at failure"}},
            {&P::fn,
             {.name = "fN",
              .min = 0,
              .max = 1,
              .meaning = "void fraction that can nucleate, under tension",
              .group = "fN, sN, eN"}},
            {&P::sn,
             {.name = "sN",
              .min = 0,
              .min_open = true,
              .meaning = "standard deviation of the nucleation strain",
              .group = "fN, sN, eN"}},
            {&P::en, {.name = "eN", .min = 0, .meaning = "mean nucleation strain", .group = "fN, sN, eN"}},
            {&P::epmax,
             {.name = "epmax",
              .min = 0,
              .min_open = true,
              .meaning = "failure strain of TEPLA-F; without it the void fraction alone determines failure"}},
            {&P::tangent_modulus,
             {.name = "TangMod",
              .min = 0,
              .dimension = "stress",
              .meaning = "matrix with linear hardening: its tangent modulus, < Young"}},
            {&P::power,
             {.name = "N_hard", .min = 1, .min_open = true, .meaning = "matrix with power hardening: N"}},
            {&P::b,
             {.name = "B",
              .min = 0,
              .dimension = "stress",
              .meaning = "Johnson-Cook matrix: hardening constant",
              .group = "B, n, C, epso"}},
            {&P::n,
             {.name = "n",
              .min = 0,
              .meaning = "Johnson-Cook matrix: hardening exponent",
              .group = "B, n, C, epso"}},
            {&P::c,
             {.name = "C",
              .min = 0,
              .meaning = "Johnson-Cook matrix: strain-rate constant",
              .group = "B, n, C, epso"}},
            {&P::epso,
             {.name = "epso",
              .min = 0,
              .min_open = true,
              .dimension = "1/time",
              .meaning = "Johnson-Cook matrix: reference strain rate",
              .group = "B, n, C, epso"}},
        }});
  }

  std::string fault() const {
    const int matrices = int(tangent_modulus != not_given) + int(power != not_given) + int(b != not_given);
    if (matrices != 1) return "Gurson needs one matrix: TangMod, or N_hard, or B, n, C and epso";
    if (std::string wrong = tangent_modulus_fault(young, tangent_modulus); !wrong.empty()) return wrong;
    if (!(fc < ff)) return "fc must be smaller than ff";
    if (!(fc < 1 / q1)) return "fc must be smaller than 1/q1";
    if (!(f0 < ff)) return "f0 must be smaller than ff";
    if (mean_f0 >= ff) return "Gauss_f0 must be smaller than ff";
    return "";
  }
  void prepare() {
    derive_moduli();
    if (tangent_modulus >= 0) hardening = plastic_modulus(young, tangent_modulus);
  }
  static constexpr bool fails_by_damage() { return true; }
  bool scatters() const { return deviation_f0 > 0; }

  template <class T>
  T place(StrengthPoint<T>& point, const T& relative_volume) const {
    point.porosity = f0;
    if (scatters()) {
      const T drawn = (mean_f0 >= 0 ? mean_f0 : f0) + deviation_f0 * point.deviate;
      point.porosity = core::min(core::max(drawn, 0.0), 0.999 * ff);
    }
    return MisesPlasticity::place(point, relative_volume);
  }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    elastic_step_with_pressure(point);
    Step<T> step;
    step.q = mises(point.s), step.mean = -point.pressure;
    step.f = point.porosity, step.strain = point.history_0;
    step.matrix = matrix(step.strain, T(0.0), point.dt).value;
    step.effective = effective_porosity(step.f);
    const Reached<T> end = flow(step, point.dt);
    point.s = (1.0 - end.shrink) * point.s;
    point.pressure = -end.mean;
    point.effective_plastic_strain += end.shear_strain;
    point.history_0 += end.matrix_strain;
    point.porosity = end.f;
    point.yield_stress = end.matrix;
    point.plastic_work = end.work;
    // Where pressure has closed the last voids, q < M is elastic.
    const core::MaskOf<T> off =
        (core::abs(end.phi) > 1e6 * tolerance) & ((end.f > 0.0) | (end.phi > 0.0) | (end.mean > 0.0));
    point.unresolved = core::select((end.shrink > 0.0) & off, T(1.0), T(0.0));
    const T void_part = end.f * (1 / ff), strain_part = point.effective_plastic_strain * (1 / epmax);
    const T tepla = void_part * void_part + (epmax > 0 ? strain_part * strain_part : T(0.0));
    point.damage = core::max(point.damage, core::min(tepla, 1.0));
  }

 private:
  /// Trial stress and the state before the step.
  template <class T>
  struct Step {
    T q, mean, f, strain, matrix, effective;
  };
  template <class T>
  struct Reached {
    T shrink, mean, shear_strain, matrix_strain, f, matrix, work, phi;
  };

  template <class T>
  FlowStress<T> matrix(const T& strain, const T& increment, double dt) const {
    if (b >= 0) {
      return power_hardening(yield0, b, n, T(strain + increment)) * rate_factor(c, increment, epso * dt);
    }
    const T reached = strain + increment;
    if (power > 1) {
      using core::exp;
      using core::log;
      const T ratio = 1.0 + (young / yield0) * reached, value = yield0 * exp((1 / power) * log(ratio));
      return {value, (young / (yield0 * power)) * value / ratio};
    }
    return {yield0 + hardening * reached, hardening};
  }
  /// The plastic strain x of the matrix with x M(x) = work.
  template <class T>
  T matrix_increment(const Step<T>& step, const T& work, double dt) const {
    T x = work / step.matrix;
    for (int newton = 0; newton < 2; ++newton) {
      const FlowStress<T> m = matrix(step.strain, x, dt);
      // x is zero where work is; the slope of a power may be unbounded there.
      x = core::select(x > 0.0, (work + x * x * m.slope) / (m.value + x * m.slope), 0.0);
    }
    return x;
  }
  template <class T>
  T effective_porosity(const T& f) const {
    const double acceleration = (1 / q1 - fc) / (ff - fc);
    return core::select(f > fc, core::min(fc + acceleration * (f - fc), 1 / q1), f);
  }
  template <class T>
  T nucleation(const T& strain) const {
    using core::exp;
    const T z = (strain - en) * (1 / sn);
    return (fn / (sn * std::sqrt(2 * std::acos(-1.0)))) * exp(-0.5 * z * z);
  }

  /// sinh and cosh without overflow; sinh by its series where e^y - e^-y would cancel.
  template <class T>
  static T hyperbolic_sine(const T& y) {
    using core::exp;
    const T e = exp(core::min(y, largest_argument)), y2 = y * y;
    const T series =
        y *
        (1.0 + y2 * (1.0 / 6) * (1.0 + y2 * (1.0 / 20) * (1.0 + y2 * (1.0 / 42) * (1.0 + y2 * (1.0 / 72)))));
    return core::select(y < 0.1, series, 0.5 * (e - 1.0 / e));
  }
  template <class T>
  static T hyperbolic_cosine(const T& y) {
    using core::exp;
    const T e = exp(core::min(y, largest_argument));
    return 0.5 * (e + 1.0 / e);
  }
  static constexpr double largest_argument = 300;
  static constexpr double round_off = 1e-6;  ///< a smaller pressure, over M, is none
  static constexpr double closed = 1e-12;    ///< a smaller void fraction is set to zero

  /// The root y of y + b sinh(y) = z for b, z >= 0. The function is convex and the start is above the root:
  /// Newton's method converges without a bracket.
  template <class T>
  static T pulled_back(const T& z, const T& b) {
    using core::log;
    const T r = z / core::max(b, 1e-300);
    T y = core::min(z, log(r + sqrt(r * r + 1.0)));
    for (int iteration = 0; iteration < 60; ++iteration) {
      const T step = (y + b * hyperbolic_sine(y) - z) / (1.0 + b * hyperbolic_cosine(y));
      const core::MaskOf<T> open = core::abs(step) > 1e-15 * y;
      if (!core::any(open)) break;
      y = core::select(open, core::max(y - step, 0.0), y);
    }
    return y;
  }

  /// Result of a plastic multiplier, expressed as `shrink`, the fraction by which it reduces the deviator.
  template <class T>
  Reached<T> reach(const Step<T>& step, const T& shrink, double dt) const {
    const T k = (1.5 * q2) / step.matrix, z = k * core::abs(step.mean);
    const T b_end = shrink / (1.0 - shrink) * (0.75 * bulk / shear * q1 * q2 * q2) * step.effective;
    // Without voids the mean stress stays bitwise unchanged: round-off would count as void growth.
    const T size = core::select(b_end > 0.0, pulled_back(z, b_end) / k, core::abs(step.mean));
    Reached<T> end;
    end.shrink = shrink;
    end.mean = core::select(step.mean < 0.0, -size, size);
    const T q = step.q * (1.0 - shrink);
    const T expansion = (step.mean - end.mean) * (1 / bulk);
    end.shear_strain = (step.q - q) * (1 / (3 * shear));
    end.work = end.mean * expansion + q * end.shear_strain;
    end.matrix_strain = matrix_increment(step, T(end.work / (1.0 - step.f)), dt);
    T grown = step.f + expansion;
    if (fn > 0) {
      const T opened = nucleation(step.strain + 0.5 * end.matrix_strain) * end.matrix_strain;
      grown += core::select(step.mean < -round_off * step.matrix, T(0.0), opened);
    }
    const T f = core::min(grown / core::max(1.0 + expansion, 0.1), 0.999);
    end.f = core::select(f > closed, f, 0.0);
    end.matrix = matrix(step.strain, end.matrix_strain, dt).value;
    const T effective = effective_porosity(end.f), ratio = q / end.matrix;
    end.phi = ratio * ratio + (2 * q1) * effective * hyperbolic_cosine((1.5 * q2) * size / end.matrix) - 1.0 -
              (q1 * q1) * effective * effective;
    return end;
  }

  /// Phi = 0 in 0 <= shrink < 1, at whose upper end the stress is zero and Phi = -(1 - q1 f*)^2: the secant
  /// method in a shrinking bracket, independently per lane.
  template <class T>
  Reached<T> flow(const Step<T>& step, double dt) const {
    using core::abs;
    using core::select;
    Reached<T> end = reach(step, T(0.0), dt);
    const core::MaskOf<T> plastic = end.phi > tolerance;
    if (!core::any(plastic)) return where_plastic(plastic, end, step);
    T low = 0.0, high = 1 - 1e-12;
    T last = 0.0, last_phi = end.phi;
    const T q = step.q / step.matrix;
    const T s = hyperbolic_sine((1.5 * q2) / step.matrix * abs(step.mean));
    const T slope =
        2.0 * q * q + (1.5 * bulk / shear * q1 * q1 * q2 * q2) * step.effective * step.effective * s * s;
    T x = select(plastic, core::min(end.phi / slope, 0.9), 0.0);
    for (int iteration = 0; iteration < 100; ++iteration) {
      const Reached<T> now = reach(step, x, dt);
      const core::MaskOf<T> open = plastic & (abs(now.phi) > tolerance) & (high - low > 1e-16 * high);
      end = now;
      if (!core::any(open)) break;
      low = select(now.phi > 0.0, core::max(x, low), low);
      high = select(now.phi > 0.0, high, core::min(x, high));
      T next = x - now.phi * (x - last) / (now.phi - last_phi);
      const bool halve = iteration > 6 && iteration % 2 == 1;
      next = select((next > low) & (next < high), halve ? 0.5 * (low + high) : next, 0.5 * (low + high));
      last = select(open, x, last);
      last_phi = select(open, now.phi, last_phi);
      x = select(open, next, x);
    }
    // Where voids close or open entirely within one step the surface is too steep for double precision: such
    // a lane takes the bracket's inner end.
    const core::MaskOf<T> steep = plastic & (abs(end.phi) > 1e4 * tolerance);
    if (core::any(steep)) end = choose<T>(steep, reach(step, high, dt), end);
    return where_plastic(plastic, end, step);
  }
  static constexpr double tolerance = 1e-13;  ///< of Phi

  /// Lanes that do not flow keep their values bitwise.
  template <class T>
  static Reached<T> where_plastic(core::MaskOf<T> plastic, const Reached<T>& end, const Step<T>& step) {
    return choose<T>(plastic, end, {T(0.0), step.mean, T(0.0), T(0.0), step.f, step.matrix, T(0.0), end.phi});
  }
  template <class T>
  static Reached<T> choose(core::MaskOf<T> first, const Reached<T>& a, const Reached<T>& b) {
    const auto pick = [&](T Reached<T>::*member) -> T { return core::select(first, a.*member, b.*member); };
    return {pick(&Reached<T>::shrink),        pick(&Reached<T>::mean), pick(&Reached<T>::shear_strain),
            pick(&Reached<T>::matrix_strain), pick(&Reached<T>::f),    pick(&Reached<T>::matrix),
            pick(&Reached<T>::work),          pick(&Reached<T>::phi)};
  }
};

}  // namespace mpm::physics
