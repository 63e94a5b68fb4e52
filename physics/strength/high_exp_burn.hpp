// High explosive: a fluid whose pressure is scaled by the burn fraction F (manual 3-9 to 3-13):
//   F = max(F1, F2) <= 1,   F1 = (t - tL) D/(1.5 h) from tL on
//   F2 = (1 - V) rho0 D^2/PCJ = (1 - V)/(1 - V_CJ)
// by beta: 2 programmed burn F1 alone, 1 beta burn F2 alone, 0 both. h is the cell size, t the end of the
// step. The lighting time tL is the earliest arrival, at the speed D along straight lines, from any point or
// rectangle of the input; all explosives share these. F never decreases, even where only beta burn has begun
// and the volume grows again (the manual leaves that open). Limits: lines of sight pass through obstacles;
// unlit explosive has no stiffness. s = 2 mu D' as in Null. Tested by tests/physics/burn_test.cpp and
// tests/validation/detonation.py.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/body.hpp"
#include "core/simd/math.hpp"
#include "physics/parameter.hpp"
#include "physics/strength/point.hpp"

namespace mpm::physics {

struct HighExpBurn {
  static constexpr std::string_view name = "HighExpBurn";
  static constexpr std::string_view summary = "high explosive: programmed burn, beta burn or both";
  static constexpr std::array state{core::Column::burn_fraction, core::Column::lighting_time};

  double detonation_velocity = 0;
  double beta = 2;
  double pcj = 0;  ///< stress; 0: not given
  double mu = 0;   ///< stress time
  std::vector<core::DetonationItem> sources;
  double reference_density = 0;  ///< derived
  double compression_burn = 0;   ///< rho0 D^2/PCJ = -dF2/d(V/V0), derived; 0: compression does not burn

  static constexpr auto parameters() {
    using P = HighExpBurn;
    return std::array<Parameter<P>, 4>{{
        {&P::detonation_velocity,
         {.name = "D",
          .required = true,
          .min = 0,
          .min_open = true,
          .dimension = "velocity",
          .meaning = "detonation velocity"}},
        {&P::beta,
         {.name = "beta",
          .default_value = 2,
          .min = 0,
          .max = 2,
          .integer = true,
          .meaning = "burn: 0 programmed and beta, 1 beta, 2 programmed"}},
        {&P::pcj,
         {.name = "PCJ",
          .min = 0,
          .min_open = true,
          .dimension = "stress",
          .meaning = "Chapman-Jouguet pressure, < density D^2; used by beta burn, beta 0 or 1"}},
        {&P::mu,
         {.name = "mu",
          .default_value = 0,
          .min = 0,
          .dimension = "stress time",
          .meaning = "dynamic viscosity of the products"}},
    }};
  }
  std::string fault(double density) const {
    if (beta != 2 && !(pcj > 0)) return "beta burn (beta 0 or 1) needs PCJ";
    const double highest = density * detonation_velocity * detonation_velocity;
    return pcj < highest ? "" : "PCJ must be smaller than density D^2, or V_CJ is not positive";
  }
  void prepare(double density) {
    reference_density = density;
    compression_burn = beta == 2 ? 0 : density * detonation_velocity * detonation_velocity / pcj;
  }

  /// Takes the points of ignition; returns an error if nothing can ignite the explosive.
  std::string light(const std::vector<core::DetonationItem>& detonations) {
    sources = detonations;
    if (beta != 2 || !sources.empty()) return {};
    return "HighExpBurn with beta 2 burns only after ignition: add a Detonation";
  }
  bool programmed() const { return beta != 1 && !sources.empty(); }
  bool is_viscous() const { return mu > 0; }
  bool carries(core::Column column) const { return column != core::Column::lighting_time || programmed(); }

  /// Arrival time of a front that starts at the source's time and moves at D.
  template <class T>
  T arrival(const core::DetonationItem& source, const core::Vec3<T>& x) const {
    using core::max;
    if (source.kind == core::DetonationItem::Kind::point) {
      const auto& at = source.position;
      const core::Vec3<T> way{x.x - at[0], x.y - at[1], x.z - at[2]};
      return source.time + sqrt(dot(way, way)) * (1 / detonation_velocity);
    }
    const T along[3] = {x.x, x.y, x.z};
    const int first = source.normal == 0 ? 1 : 0, second = source.normal == 2 ? 1 : 2;
    const auto beyond = [&](int axis, std::size_t i) {
      return max(max(source.lower[i] - along[axis], along[axis] - source.upper[i]), 0.0);
    };
    const core::Vec3<T> way{along[source.normal] - source.location, beyond(first, 0), beyond(second, 1)};
    return source.time + sqrt(dot(way, way)) * (1 / detonation_velocity);
  }

  /// Initialises a new particle at x.
  template <class T>
  void initialise(StrengthPoint<T>& point, const core::Vec3<T>& x) const {
    if (!programmed()) return;
    T earliest = std::numeric_limits<double>::infinity();
    for (const core::DetonationItem& source : sources) earliest = core::min(earliest, arrival(source, x));
    point.lighting_time = earliest;
  }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    using core::max;
    using core::min;
    point.s = (2 / point.dt * mu) * point.strain;
    point.viscosity = mu;
    T fraction = max(point.burn_fraction, compression_burn * (1.0 - reference_density / point.density));
    if (programmed()) {
      const T run = detonation_velocity * max(point.time - point.lighting_time, 0.0);
      // Without a cell size (a point without a grid) the front has no width.
      const double width = std::max(1.5 * point.cell_size, std::numeric_limits<double>::min());
      fraction = max(fraction, run / max(run, width));
    }
    point.burn_fraction = min(fraction, 1.0);
  }
};

}  // namespace mpm::physics
