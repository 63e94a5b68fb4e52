// The deformation gradient, for laws and outputs that need it: F^{n+1} = (I - L dt/2)^-1 (I + L dt/2) F^n
// with L at midstep. Its rotation is that of the stress update (Hughes and Winget 1980), orthogonal to
// round-off, so that rotation causes no strain; second order in dt. A step that would invert the particle, or
// whose L is not finite, leaves F and the volume unchanged (physics/material/kinematics.hpp counts it), and
// so does failure. Shown by tests/physics/principal_failure_test.cpp.
#pragma once

#include "physics/material/kinematics.hpp"

namespace mpm::physics {

template <class T>
[[gnu::noinline, gnu::flatten]] void update_deformation_gradient(core::Batch& batch) {
  using core::Column;
  const core::ColumnLayout& layout = *batch.layout;
  const int f_at = layout.offset(Column::f_xx);
  for_each_vector<T>(batch, [&](double* block, int row) {
    const core::Mat3<T> l = load_gradient<T>(batch, row);
    const core::Mat3<T> ahead = unit_plus(0.5 * batch.dt, l), behind = unit_plus(-0.5 * batch.dt, l);
    const T below = determinant(behind), above = determinant(ahead);
    // The nine columns are adjacent, in the order of Mat3.
    const auto at = [&](int i) { return block + f_at + core::block_lanes * i; };
    const auto get = [&](int i) { return core::load<T>(at(i)); };
    const core::Mat3<T> old{get(0), get(1), get(2), get(3), get(4), get(5), get(6), get(7), get(8)};
    const core::Mat3<T> f = adjugate(behind) * (ahead * old);
    const T scale = 1.0 / below;
    T now[9] = {f.xx, f.xy, f.xz, f.yx, f.yy, f.yz, f.zx, f.zy, f.zz}, size = 0.0;
    for (T& component : now) {
      component *= scale;
      size += component * component;
    }
    const core::MaskOf<T> usable = (below > 0.0) & (above > 0.0) & (size < 1e150);
    for (int i = 0; i < 9; ++i) core::store(at(i), core::select(usable, now[i], get(i)));
  });
}

}  // namespace mpm::physics
