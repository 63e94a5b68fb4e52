// Second stage: the deviatoric stress. The old stress is rotated by the mid-point rule for the step's spin
// (Hughes and Winget 1980; orthogonal to round-off, instead of thesis 2-81). The strain increment belongs to
// midstep and is rotated by the other half, to first order in the angle: the whole update is then of second
// order, with an unrotated increment of first (tests/physics/laws_test.cpp). Then the law is applied. Failed
// particles have the stress of a fluid, s = 2 FailViscosity D', and their state is frozen.
#pragma once

#include "physics/eos/strength_pressure.hpp"
#include "physics/history.hpp"
#include "physics/material/kinematics.hpp"
#include "physics/strength/point.hpp"

namespace mpm::physics {

struct StrengthRules {
  double fail_viscosity = 0;
  double specific_heat = 0;  ///< 0: no heating
  bool viscous = false;      ///< the law or the failed material has shear viscosity
};

/// Axial vector of the spin increment.
template <class T>
core::Vec3<T> spin_increment(const core::Mat3<T>& l, double dt) {
  const double half = 0.5 * dt;
  return {half * (l.zy - l.yz), half * (l.xz - l.zx), half * (l.yx - l.xy)};
}

/// R a R^T for a deviator a, whose third diagonal component follows from the others.
template <class T>
core::Sym3<T> rotate_deviator(const core::Mat3<T>& r, const core::Sym3<T>& a) {
  const core::Vec3<T> x{r.xx * a.xx + r.xy * a.xy + r.xz * a.xz, r.xx * a.xy + r.xy * a.yy + r.xz * a.yz,
                        r.xx * a.xz + r.xy * a.yz + r.xz * a.zz};
  const core::Vec3<T> y{r.yx * a.xx + r.yy * a.xy + r.yz * a.xz, r.yx * a.xy + r.yy * a.yy + r.yz * a.yz,
                        r.yx * a.xz + r.yy * a.yz + r.yz * a.zz};
  const core::Vec3<T> rx{r.xx, r.xy, r.xz}, ry{r.yx, r.yy, r.yz}, rz{r.zx, r.zy, r.zz};
  const T xx = dot(x, rx), yy = dot(y, ry);
  return {xx, yy, -(xx + yy), dot(x, ry), dot(y, rz), dot(x, rz)};
}

/// a + H a - a H for the skew tensor H of the axial vector h: a rotated by h, to first order.
template <class T>
core::Sym3<T> turn_slightly(const core::Vec3<T>& h, const core::Sym3<T>& a) {
  const T x = h.x * a.yz, y = h.y * a.xz, z = h.z * a.xy;
  return {a.xx + 2.0 * (y - z),
          a.yy + 2.0 * (z - x),
          a.zz + 2.0 * (x - y),
          a.xy + h.z * (a.xx - a.yy) + h.y * a.yz - h.x * a.xz,
          a.yz + h.x * (a.yy - a.zz) + h.z * a.xz - h.y * a.xy,
          a.xz + h.y * (a.zz - a.xx) + h.x * a.xy - h.z * a.yz};
}

/// Input of the law other than its state: strain increment, pressure, density and the rotated stress.
template <class T>
StrengthPoint<T> strength_point(const core::Batch& batch, const double* block, int row) {
  using core::Column;
  const core::ColumnLayout& layout = *batch.layout;
  const auto get = [&](Column c) { return core::load<T>(block + layout.offset(c)); };
  const core::Mat3<T> l = load_gradient<T>(batch, row);
  const core::Vec3<T> spin = spin_increment(l, batch.dt);

  StrengthPoint<T> point;
  point.dt = batch.dt;
  point.time = batch.time;
  point.cell_size = batch.cell_size;
  point.volumetric_strain = core::load<T>(batch.volumetric_strain + row);
  point.strain = turn_slightly(T(0.5) * spin, deviator(strain_increment(l, batch.dt)));
  point.s = rotate_deviator(core::mid_point_rotation(spin), load_deviator<T>(block, layout));
  point.pressure = get(Column::pressure);
  point.density = get(Column::mass) / get(Column::volume);
  point.volume_ratio = get(Column::volume) / core::load<T>(batch.old_volume + row);
  return point;
}

/// The lanes of `failed` become a viscous fluid; their state is restored.
template <class T, class Law>
void hold_failed(StrengthPoint<T>& point, const History<Law, StrengthPoint<T>>& history, const double* block,
                 const StrengthRules& rules, core::MaskOf<T> failed) {
  const auto put = [&](T& value, const T& fluid) { value = core::select(failed, fluid, value); };
  const core::Sym3<T> viscous = T(2 * rules.fail_viscosity / point.dt) * point.strain;
  put(point.s.xx, viscous.xx), put(point.s.yy, viscous.yy), put(point.s.zz, viscous.zz);
  put(point.s.xy, viscous.xy), put(point.s.yz, viscous.yz), put(point.s.xz, viscous.xz);
  put(point.shear_modulus, 0.0), put(point.plastic_work, 0.0), put(point.viscosity, rules.fail_viscosity);
  history.restore(block, point, failed);
}

/// Computes deviatoric_work, shear_modulus and shear_viscosity of the batch, and the rows of a law's own
/// pressure; updates s, the law's state and, where the layout has it, the temperature (thesis 2-119).
template <class T, class Law>
[[gnu::noinline, gnu::flatten]] void update_strength(core::Batch& batch, const Law& law,
                                                     const StrengthRules& rules) {
  using core::Column;
  const core::ColumnLayout& layout = *batch.layout;
  const History<Law, StrengthPoint<T>> history(law, layout);
  const int failed_at = layout.offset(Column::failed), yield_at = layout.offset(Column::yield_stress);
  const int temperature_at = layout.offset(Column::temperature);

  for_each_vector<T, parts_of_strength>(batch, [&](double* block, int row) {
    StrengthPoint<T> point = strength_point<T>(batch, block, row);
    const core::Sym3<T> before = point.s;
    history.load(block, point);
    law.update(point);
    if constexpr (requires { requires Law::may_not_resolve; }) {
      const core::MaskOf<T> unresolved = point.unresolved > 0.5;
      if (core::any(unresolved)) batch.events.unresolved += count<T>(unresolved, row, batch.particles);
    }
    if (failed_at >= 0) {
      hold_failed(point, history, block, rules, core::MaskOf<T>(core::load<T>(block + failed_at) > 0.5));
    }
    history.store(block, point);
    if constexpr (requires { law.plastic_work_coefficient; }) {
      if (temperature_at >= 0) {
        const double heat = law.plastic_work_coefficient / rules.specific_heat;
        double* temperature = block + temperature_at;
        core::store(temperature, core::load<T>(temperature) + heat * point.plastic_work / point.density);
      }
    }
    if (yield_at >= 0) core::store(block + yield_at, point.yield_stress);
    store_deviator(block, layout, point.s);
    core::store(batch.deviatoric_work + row, T(0.5) * contract(before + point.s, point.strain));
    core::store(batch.shear_modulus + row, point.shear_modulus);
    if constexpr (requires { law.tension_rules(); }) {
      core::store(batch.lowest_pressure + row, point.lowest_pressure);
    }
    if constexpr (SetsPressure<Law>) {
      core::store(batch.law_pressure + row, point.pressure);
      core::store(batch.bulk_modulus + row, point.bulk_modulus);
    }
    if (rules.viscous) core::store(batch.shear_viscosity + row, point.viscosity);
  });
}

}  // namespace mpm::physics
