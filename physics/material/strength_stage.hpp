// Second stage: the deviatoric stress. Half of the step's rotation, the law in the frame of the middle of the step,
// the other half: so each increment is turned by as much as belongs to it, and the whole is of second order where
// one rotation per step is of first (tests/physics/objectivity_test.cpp). Each half is the mid-point rule for half of
// the spin (Hughes and Winget 1980), orthogonal to round-off, in the place of thesis 2-81.
// Failed particles have the stress of a fluid, s = 2 FailViscosity D', and their state rests.
#pragma once

#include "physics/history.hpp"
#include "physics/material/kinematics.hpp"
#include "physics/strength/point.hpp"

namespace mpm::physics {

struct StrengthRules {
  double fail_viscosity = 0;
  double specific_heat = 0;  ///< 0: nothing heats
};

/// Rotation by half of the step's spin.
template <class T>
core::Mat3<T> half_rotation(const core::Batch& batch, int row) {
  const double quarter = 0.25 * batch.dt;
  const auto get = [&](int i) { return core::load<T>(batch.gradient[i] + row); };
  return core::mid_point_rotation(core::Vec3<T>{quarter * (get(7) - get(5)), quarter * (get(2) - get(6)),
                                                quarter * (get(3) - get(1))});
}

/// Strain increment and density, as the law is given them; the rest of the point is zero.
template <class T>
StrengthPoint<T> strength_point(const core::Batch& batch, const double* block, int row) {
  using core::Column;
  const core::ColumnLayout& layout = *batch.layout;
  const auto get = [&](Column c) { return core::load<T>(block + layout.offset(c)); };
  const auto strain = [&](int i) { return core::load<T>(batch.strain[i] + row); };
  StrengthPoint<T> point;
  point.dt = batch.dt;
  point.strain = deviator(core::Sym3<T>{strain(0), strain(1), strain(2), strain(3), strain(4), strain(5)});
  point.volumetric_strain = core::load<T>(batch.volumetric_strain + row);
  point.pressure = get(Column::pressure);
  point.density = get(Column::mass) / get(Column::volume);
  return point;
}

/// Fills deviatoric_work, shear_modulus and shear_viscosity of the batch; updates s and the law's state.
template <class T, class Law>
[[gnu::noinline]] void update_strength(core::Batch& batch, const Law& law, const StrengthRules& rules) {
  using core::Column;
  const core::ColumnLayout& layout = *batch.layout;
  const History<Law, StrengthPoint<T>> history(law, layout);
  const int failed_at = layout.offset(Column::failed);
  const int yield_at = layout.offset(Column::yield_stress);
  const int temperature_at = layout.offset(Column::temperature);

  for_each_vector<T>(batch, [&](double* block, int row) {
    const core::Mat3<T> half = half_rotation<T>(batch, row);
    StrengthPoint<T> point = strength_point<T>(batch, block, row);
    history.load(block, point);
    const core::Sym3<T> before = rotate(half, load_deviator<T>(block, layout));
    point.s = before;
    law.update(point);

    if (failed_at >= 0) {
      const auto failed = core::load<T>(block + failed_at) > 0.5;
      const T kept = core::select(failed, 0.0, T(1.0)), lost = 1.0 - kept;
      point.s = kept * point.s + (lost * (2 * rules.fail_viscosity / batch.dt)) * point.strain;
      point.shear_modulus *= kept;
      point.plastic_work *= kept;
      point.viscosity = kept * point.viscosity + lost * rules.fail_viscosity;
      history.restore(block, point, failed);
    }
    if constexpr (requires { law.plastic_work_coefficient; }) {
      if (temperature_at >= 0) {  // thesis 2-119
        point.temperature = core::load<T>(block + temperature_at) + (law.plastic_work_coefficient / rules.specific_heat) *
                            point.plastic_work / point.density;
      }
    }
    history.store(block, point);
    if constexpr (requires { law.plastic_work_coefficient; }) {
      if (temperature_at >= 0) core::store(block + temperature_at, point.temperature);
    }
    if (yield_at >= 0) core::store(block + yield_at, point.yield_stress);
    core::store(batch.deviatoric_work + row, T(0.5) * contract(before + point.s, point.strain));
    core::store(batch.shear_modulus + row, point.shear_modulus);
    core::store(batch.shear_viscosity + row, point.viscosity);
    store_deviator(block, layout, rotate(half, point.s));
  });
}

}  // namespace mpm::physics
