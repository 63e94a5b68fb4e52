// Input of a failure model: the state at the end of the step.
#pragma once

#include <array>

#include "core/tensor/tensor.hpp"
#include "physics/history.hpp"

namespace mpm::physics {

template <class T>
struct FailurePoint {
  core::Sym3<T> s;  ///< deviatoric stress
  T pressure;       ///< positive in compression

  T threshold_factor = 1.0;  ///< the particle's own, with RandomFailure

  // State: only the columns that the model names in `state` are loaded.
  T effective_plastic_strain = 0.0;
  T damage = 0.0;
  T f_xx = 1.0, f_xy = 0.0, f_xz = 0.0, f_yx = 0.0, f_yy = 1.0, f_yz = 0.0, f_zx = 0.0, f_zy = 0.0,
    f_zz = 1.0;

  static constexpr auto columns() {
    using P = FailurePoint;
    using core::Column;
    return std::array<ColumnMember<P, T>, 11>{{
        {Column::effective_plastic_strain, &P::effective_plastic_strain},
        {Column::damage, &P::damage},
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
