// What a strength law sees: one vector of particles, in the frame of the middle of the step.
#pragma once

#include <array>

#include "core/particles/columns.hpp"
#include "core/tensor/tensor.hpp"
#include "physics/history.hpp"

namespace mpm::physics {

template <class T>
struct StrengthPoint {
  // --- given -------------------------------------------------------------------------------------------
  double dt;             ///< > 0
  double time = 0;       ///< at the end of the step
  double cell_size = 0;  ///< 0: none, a point without a grid
  core::Sym3<T> strain;  ///< deviator of the strain increment
  T volumetric_strain;   ///< its trace
  T pressure;            ///< at the beginning of the step, positive in compression
  T density;             ///< at the end of the step

  // --- changed -----------------------------------------------------------------------------------------
  core::Sym3<T> s;  ///< deviatoric stress

  // --- results beside the stress; laws that have none leave them ----------------------------------------
  T shear_modulus = 0.0;    ///< for the wave speed
  T viscosity = 0.0;        ///< shear viscosity reached, s = 2 viscosity D', for the critical step
  T yield_stress = 0.0;     ///< for output
  T plastic_work = 0.0;     ///< of this step, per current volume: what heats
  T lowest_pressure = 0.0;  ///< read from laws with tension_rules(): the pressure is held at or above it

  // --- state: only the columns that the law names in `state` are loaded and stored -----------------------
  T effective_plastic_strain = 0.0;
  T damage = 0.0;
  T temperature = 0.0;
  T porosity = 0.0;
  T plastic_volumetric_strain = 0.0;
  T bulking_pressure = 0.0;
  T burn_fraction = 0.0;
  T lighting_time = 0.0;
  T history_0 = 0.0, history_1 = 0.0, history_2 = 0.0, history_3 = 0.0;

  static constexpr auto columns() {
    using P = StrengthPoint;
    using core::Column;
    return std::array<ColumnMember<P, T>, 12>{{
        {Column::effective_plastic_strain, &P::effective_plastic_strain},
        {Column::damage, &P::damage},
        {Column::temperature, &P::temperature},
        {Column::porosity, &P::porosity},
        {Column::plastic_volumetric_strain, &P::plastic_volumetric_strain},
        {Column::bulking_pressure, &P::bulking_pressure},
        {Column::burn_fraction, &P::burn_fraction},
        {Column::lighting_time, &P::lighting_time},
        {Column::history_0, &P::history_0},
        {Column::history_1, &P::history_1},
        {Column::history_2, &P::history_2},
        {Column::history_3, &P::history_3},
    }};
  }
};

}  // namespace mpm::physics
