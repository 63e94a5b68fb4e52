// From a batch's displacement gradient G = d u / d x in a step to nodal forces and their derivative.
//
// With F = I + G the deformation of the step, the material receives the increment of the displacement
// gradient at midstep, h = 2 (F - I)(F + I)^-1: then (I - h/2)^-1 (I + h/2) = F, so deformation gradients and
// volumes follow F exactly (physics/material/deformation.hpp) and a rotation causes no strain (Hughes and
// Winget 1980). A particle's force on node i is
//   f_i = - P grad S_i,   P = V' sigma' F^-T
// with the volume and Cauchy stress at the end of the step and gradients at its start (Charlton, Coombs and
// Augarde, Computers and Structures 190 (2017) 108, in their gradients at the end). Its derivative is
//   dP = P (F^-T : dF) + V' dsigma F^-T - P dF^T F^-T,   dh = (2 I - h) dF (F + I)^-1
// Tested by tests/core/implicit/stress_response_test.cpp.
#pragma once

#include "core/material/batch.hpp"
#include "core/material/constitutive_model.hpp"
#include "core/material/stress_tangent.hpp"
#include "core/simd/math.hpp"

namespace mpm::core {

/// Rows of nine components, in the order of Mat3.
using Rows9 = Row[9];

template <class T>
inline Mat3<T> load_rows(const Rows9& rows, int at) {
  const auto get = [&](int i) { return load<T>(rows[i] + at); };
  return {get(0), get(1), get(2), get(3), get(4), get(5), get(6), get(7), get(8)};
}
template <class T>
inline void store_rows(const Mat3<T>& m, Rows9& rows, int at) {
  const T each[9] = {m.xx, m.xy, m.xz, m.yx, m.yy, m.yz, m.zx, m.zy, m.zz};
  for (int i = 0; i < 9; ++i) store(rows[i] + at, each[i]);
}
template <class T>
inline Mat3<T> plus_unit(const Mat3<T>& g, double k) {
  return {g.xx + k, g.xy, g.xz, g.yx, g.yy + k, g.yz, g.zx, g.zy, g.zz + k};
}
template <class T>
inline Mat3<T> transposed(const Mat3<T>& m) {
  return {m.xx, m.yx, m.zx, m.xy, m.yy, m.zy, m.xz, m.yz, m.zz};
}
template <class T>
inline Mat3<T> inverse(const Mat3<T>& m) {
  return (T(1.0) / determinant(m)) * adjugate(m);
}

/// h over dt, into batch.gradient, from the displacement gradients. Returns whether all particles keep their
/// orientation; those that do not, and the lanes out of use, get no strain.
bool set_midstep_gradient(const Rows9& displacement_gradient, Batch& batch);

/// Moves the stress of a batch off a yield surface on which it lies, by a negligible part of it, to the
/// elastic side. A linearised step takes the derivative there, for no strain yet: round-off would choose
/// between the elastic and the plastic one.
void leave_yield_surface(Batch& batch);

/// The stress' derivative by central differences of update(): for laws without a tangent of their own. The
/// batch's blocks hold the state at the start of the step, before and after. `room`: for a copy of them.
void difference_tangent(const ConstitutiveModel& material, const UpdateOptions& options, Batch& batch,
                        double* room, StressTangent& result);

/// P from the updated columns of the batch.
void nodal_stress(const Rows9& displacement_gradient, Batch& batch, Rows9& p);

/// d P_ij / d G_kl of a batch, row 9 (3 i + j) + 3 k + l.
struct ForceTangent {
  alignas(64) Row d[81];
};
/// From the updated columns, batch.gradient and the stress' derivative.
void force_tangent(const Rows9& displacement_gradient, Batch& batch, const Rows9& p,
                   const StressTangent& stress, ForceTangent& result);

}  // namespace mpm::core
