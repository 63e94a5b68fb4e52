// What a failure model sees: the state reached at the end of the step.
#pragma once

#include <array>

#include "core/tensor/tensor.hpp"
#include "physics/history.hpp"

namespace mpm::physics {

template <class T>
struct FailurePoint {
  core::Sym3<T> s;  ///< deviatoric stress
  T pressure;       ///< positive in compression

  // State: only the columns that the model names in `state` are loaded.
  T effective_plastic_strain = 0.0;
  T damage = 0.0;
  T strain_xx = 0.0, strain_yy = 0.0, strain_zz = 0.0, strain_xy = 0.0, strain_yz = 0.0, strain_xz = 0.0;

  static constexpr auto columns() {
    using P = FailurePoint;
    using core::Column;
    return std::array<ColumnMember<P, T>, 8>{{
        {Column::effective_plastic_strain, &P::effective_plastic_strain},
        {Column::damage, &P::damage},
        {Column::strain_xx, &P::strain_xx},
        {Column::strain_yy, &P::strain_yy},
        {Column::strain_zz, &P::strain_zz},
        {Column::strain_xy, &P::strain_xy},
        {Column::strain_yz, &P::strain_yz},
        {Column::strain_xz, &P::strain_xz},
    }};
  }
};

}  // namespace mpm::physics
