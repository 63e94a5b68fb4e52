// Input and result of an equation of state.
#pragma once

#include <array>

#include "physics/history.hpp"

namespace mpm::physics {

template <class T>
struct EosPoint {
  T compression;        ///< mu = rho/rho0 - 1 at the end of the step
  T relative_volume;    ///< V/V0 = 1/(1 + mu)
  T volumetric_strain;  ///< of the step
  T pressure;           ///< at the beginning of the step
  T energy;             ///< E at the beginning of the step, per unit initial volume

  // State: only the columns that the law names in `state` are loaded and stored.
  T max_compression = 0.0;
  T porosity = 0.0;
  T plastic_volumetric_strain = 0.0;
  T bulking_pressure = 0.0;
  T burn_fraction = 0.0;
  T history_4 = 0.0, history_5 = 0.0, history_6 = 0.0, history_7 = 0.0;

  static constexpr auto columns() {
    using P = EosPoint;
    using core::Column;
    return std::array<ColumnMember<P, T>, 9>{{
        {Column::max_compression, &P::max_compression},
        {Column::porosity, &P::porosity},
        {Column::plastic_volumetric_strain, &P::plastic_volumetric_strain},
        {Column::bulking_pressure, &P::bulking_pressure},
        {Column::burn_fraction, &P::burn_fraction},
        {Column::history_4, &P::history_4},
        {Column::history_5, &P::history_5},
        {Column::history_6, &P::history_6},
        {Column::history_7, &P::history_7},
    }};
  }
};

/// The pressure at the new volume, linear in the energy: p = a + b E (thesis 2-91). A nonlinear law gives its
/// tangent at the point's energy. da and db are derivatives with respect to mu at fixed E.
template <class T>
struct LinearisedPressure {
  T a, b, da, db;
};

}  // namespace mpm::physics
