// What the hyperelastic laws share: their stress follows from the deformation gradient F alone, which is the
// material's (physics/material/deformation.hpp). J is its determinant, not that of the volume column, which
// may drift with the scene's volume update.
#pragma once

#include <array>

#include "physics/strength/elasticity.hpp"

namespace mpm::physics {

inline constexpr std::array deformation_gradient_columns{
    core::Column::f_xx, core::Column::f_xy, core::Column::f_xz, core::Column::f_yx, core::Column::f_yy,
    core::Column::f_yz, core::Column::f_zx, core::Column::f_zy, core::Column::f_zz};

template <class T>
core::Mat3<T> deformation_gradient(const StrengthPoint<T>& point) {
  return {point.f_xx, point.f_xy, point.f_xz, point.f_yx, point.f_yy,
          point.f_yz, point.f_zx, point.f_zy, point.f_zz};
}

/// The point stretched equally in all directions to the relative volume. Returns the stretch.
template <class T>
T stretch_equally(StrengthPoint<T>& point, const T& relative_volume) {
  using core::exp;
  using core::log;
  const T stretch = exp((1.0 / 3) * log(relative_volume));
  point.f_xx = point.f_yy = point.f_zz = stretch;
  point.f_xy = point.f_xz = point.f_yx = point.f_yz = point.f_zx = point.f_zy = 0.0;
  return stretch;
}

/// B = F F^T
template <class T>
core::Sym3<T> left_cauchy_green(const core::Mat3<T>& f) {
  return {f.xx * f.xx + f.xy * f.xy + f.xz * f.xz, f.yx * f.yx + f.yy * f.yy + f.yz * f.yz,
          f.zx * f.zx + f.zy * f.zy + f.zz * f.zz, f.xx * f.yx + f.xy * f.yy + f.xz * f.yz,
          f.yx * f.zx + f.yy * f.zy + f.yz * f.zz, f.xx * f.zx + f.xy * f.zy + f.xz * f.zz};
}

/// m m
template <class T>
core::Sym3<T> squared(const core::Sym3<T>& m) {
  return {m.xx * m.xx + m.xy * m.xy + m.xz * m.xz, m.xy * m.xy + m.yy * m.yy + m.yz * m.yz,
          m.xz * m.xz + m.yz * m.yz + m.zz * m.zz, m.xx * m.xy + m.xy * m.yy + m.xz * m.yz,
          m.xy * m.xz + m.yy * m.yz + m.yz * m.zz, m.xx * m.xz + m.xy * m.yz + m.xz * m.zz};
}

/// The deviator, from differences: exactly zero where all stretches are equal.
template <class T>
core::Sym3<T> differences(const core::Sym3<T>& m) {
  const T xy = (1.0 / 3) * (m.xx - m.yy), yz = (1.0 / 3) * (m.yy - m.zz), zx = (1.0 / 3) * (m.zz - m.xx);
  return {xy - zx, yz - xy, zx - yz, m.xy, m.yz, m.xz};
}

/// Base of the laws whose parameters are Young's modulus and Poisson's ratio at rest.
struct FiniteElasticity : IsotropicElasticity {
  static constexpr auto state = deformation_gradient_columns;
  static constexpr bool sets_pressure = true;
  static constexpr bool hyperelastic = true;

  double lame = 0;  ///< lambda = K - 2 G/3, derived

  void prepare() {
    derive_moduli();
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  }

  /// The wave speed is that of the longitudinal modulus.
  template <class T>
  void set_moduli(StrengthPoint<T>& point, const T& longitudinal) const {
    point.shear_modulus = shear;
    point.bulk_modulus = longitudinal - 4.0 / 3.0 * shear;
  }
};

}  // namespace mpm::physics
