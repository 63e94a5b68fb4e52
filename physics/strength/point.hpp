// Input and result of a strength law: one vector of particles, in the frame of midstep.
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
  T volume_ratio = 1.0;  ///< of the volumes at the end and at the start of the step
  T density;             ///< at the end of the step

  // --- changed -----------------------------------------------------------------------------------------
  /// Positive in compression; at the beginning of the step. Changed only by laws with `sets_pressure`.
  T pressure;
  core::Sym3<T> s;  ///< deviatoric stress

  // --- given only to laws that declare it
  // --------------------------------------------------------------------
  T deviate = 0.0;  ///< standard normal, the particle's own; for `place` of laws that scatter

  // --- results besides the stress; laws without them leave them unchanged -------------------------------
  T shear_modulus = 0.0;    ///< for the wave speed
  T bulk_modulus = 0.0;     ///< the same; used for laws with `sets_pressure`
  T viscosity = 0.0;        ///< current shear viscosity, s = 2 viscosity D', for the critical step
  T yield_stress = 0.0;     ///< for output
  T plastic_work = 0.0;     ///< of this step, per current volume: the source of heat
  T unresolved = 0.0;       ///< used for laws with `may_not_resolve`: 1 where the step was too large for them
  T lowest_pressure = 0.0;  ///< used for laws with tension_rules(): lower limit of the pressure

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
  T f_xx = 0.0, f_xy = 0.0, f_xz = 0.0, f_yx = 0.0, f_yy = 0.0, f_yz = 0.0, f_zx = 0.0, f_zy = 0.0,
    f_zz = 0.0;

  static constexpr auto columns() {
    using P = StrengthPoint;
    using core::Column;
    return std::array<ColumnMember<P, T>, 21>{{
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
        {Column::f_xx, &P::f_xx},
        {Column::f_xy, &P::f_xy},
        {Column::f_xz, &P::f_xz},
        {Column::f_yx, &P::f_yx},
        {Column::f_yy, &P::f_yy},
        {Column::f_yz, &P::f_yz},
        {Column::f_zx, &P::f_zx},
        {Column::f_zy, &P::f_zy},
        {Column::f_zz, &P::f_zz},
    }};
  }
};

}  // namespace mpm::physics
