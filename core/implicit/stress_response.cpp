#include "core/implicit/stress_response.hpp"

#include <algorithm>
#include <cmath>

namespace mpm::core {

namespace {

/// f(row) for every vector of the batch.
template <class F>
void for_each_row(const Batch& batch, F f) {
  for (int row = 0; row < block_lanes * batch.blocks; row += real_width) f(row);
}

template <class T>
Sym3<T> cauchy_stress(const Batch& batch, int row) {
  const double* block = batch.block[row / block_lanes] + row % block_lanes;
  const auto get = [&](Column c) { return load<T>(block + batch.layout->offset(c)); };
  const T p = get(Column::pressure);
  return {get(Column::s_xx) - p, get(Column::s_yy) - p, get(Column::s_zz) - p,
          get(Column::s_xy),     get(Column::s_yz),     get(Column::s_xz)};
}
template <class T>
T volume_of(const Batch& batch, int row) {
  return load<T>(batch.block[row / block_lanes] + row % block_lanes + batch.layout->offset(Column::volume));
}
template <class T>
Mat3<T> full(const Sym3<T>& s) {
  return {s.xx, s.xy, s.xz, s.xy, s.yy, s.yz, s.xz, s.yz, s.zz};
}

}  // namespace

bool set_midstep_gradient(const Rows9& displacement_gradient, Batch& batch) {
  bool keep_orientation = true;
  const double per_dt = 1 / batch.dt;
  for_each_row(batch, [&](int row) {
    const Mat3<Real> g = load_rows<Real>(displacement_gradient, row);
    const Real j = determinant(plus_unit(g, 1.0)), sum = determinant(plus_unit(g, 2.0));
    const MaskOf<Real> usable = (j > 0.0) & (sum > 0.0);
    if (!all(usable)) {
      for (int i = 0; i < real_width && row + i < batch.particles; ++i)
        keep_orientation = keep_orientation && test(usable, i);
    }
    const Mat3<Real> h = (2 * per_dt) * (g * inverse(plus_unit(g, 2.0)));
    const Real each[9] = {h.xx, h.xy, h.xz, h.yx, h.yy, h.yz, h.zx, h.zy, h.zz};
    for (int i = 0; i < 9; ++i) store(batch.gradient[i] + row, select(usable, each[i], Real(0.0)));
  });
  return keep_orientation;
}

void leave_yield_surface(Batch& batch) {
  constexpr double part = 1e-8;
  const int deviator = batch.layout->offset(Column::s_xx), pressure = batch.layout->offset(Column::pressure);
  for (int b = 0; b < batch.blocks; ++b) {
    double *const s = batch.block[b] + deviator, *const p = batch.block[b] + pressure;
    for (int i = 0; i < 6 * block_lanes; ++i) s[i] *= 1 - part;
    for (int i = 0; i < block_lanes; ++i) p[i] += part * std::abs(p[i]);  // a limit of tension
  }
}

void difference_tangent(const ConstitutiveModel& material, const UpdateOptions& options, Batch& batch,
                        double* room, StressTangent& result) {
  // The error is of the order of step^2 in a smooth law, and rounding / step of the stress.
  constexpr double step = 1e-6;
  const auto doubles = static_cast<std::size_t>(block_lanes * batch.layout->columns());
  const auto restore = [&](bool keep) {
    for (int b = 0; b < batch.blocks; ++b) {
      double* const copy = room + static_cast<std::size_t>(b) * doubles;
      std::copy_n(keep ? batch.block[b] : copy, doubles, keep ? copy : batch.block[b]);
    }
  };
  restore(true);
  const double change = step / batch.dt;
  for (int kl = 0; kl < 9; ++kl) {
    for (int i = 0; i < 6; ++i) std::fill_n(result.d[i][kl], batch_particles, 0.0);
    for (const double sign : {1.0, -1.0}) {
      for (double& g : batch.gradient[kl]) g += sign * change;
      material.update(batch, options);
      for (double& g : batch.gradient[kl]) g -= sign * change;
      for_each_row(batch, [&](int row) {
        const Sym3<Real> s = cauchy_stress<Real>(batch, row);
        const Real each[6] = {s.xx, s.yy, s.zz, s.xy, s.yz, s.xz};
        for (int i = 0; i < 6; ++i) {
          double* const to = result.d[i][kl] + row;
          store(to, load<Real>(to) + Real(0.5 * sign / step) * each[i]);
        }
      });
      restore(false);
    }
  }
}

void nodal_stress(const Rows9& displacement_gradient, Batch& batch, Rows9& p) {
  for_each_row(batch, [&](int row) {
    const Mat3<Real> f = plus_unit(load_rows<Real>(displacement_gradient, row), 1.0);
    store_rows(volume_of<Real>(batch, row) * (full(cauchy_stress<Real>(batch, row)) * transposed(inverse(f))),
               p, row);
  });
}

void force_tangent(const Rows9& displacement_gradient, Batch& batch, const Rows9& p,
                   const StressTangent& stress, ForceTangent& result) {
  for_each_row(batch, [&](int row) {
    const Mat3<Real> g = load_rows<Real>(displacement_gradient, row);
    const auto as_array = [](const Mat3<Real>& m, Real(&a)[3][3]) {
      const Real each[9] = {m.xx, m.xy, m.xz, m.yx, m.yy, m.yz, m.zx, m.zy, m.zz};
      for (int i = 0; i < 9; ++i) a[i / 3][i % 3] = each[i];
    };
    Real inv[3][3], c[3][3], m[3][3], pk[3][3];  // F^-1, (F + I)^-1, 2 I - h, P
    as_array(inverse(plus_unit(g, 1.0)), inv);
    as_array(inverse(plus_unit(g, 2.0)), c);
    const Mat3<Real> h = Real(batch.dt) * load_rows<Real>(batch.gradient, row);
    as_array(plus_unit(Real(-1.0) * h, 2.0), m);
    as_array(load_rows<Real>(p, row), pk);
    const Real volume = volume_of<Real>(batch, row);

    // V' dsigma / dF, symmetric in the first two indices.
    Real s[6][9];
    for (int ij = 0; ij < 6; ++ij) {
      Real t[3][3], half[3][3];
      for (int i = 0; i < 9; ++i) t[i / 3][i % 3] = load<Real>(stress.d[ij][i] + row);
      for (int k = 0; k < 3; ++k)
        for (int n = 0; n < 3; ++n)
          half[k][n] = volume * (m[0][k] * t[0][n] + m[1][k] * t[1][n] + m[2][k] * t[2][n]);
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          s[ij][3 * k + l] = half[k][0] * c[l][0] + half[k][1] * c[l][1] + half[k][2] * c[l][2];
    }
    static constexpr int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < 3; ++k) {
          for (int l = 0; l < 3; ++l) {
            const int kl = 3 * k + l;
            // (F^-T)_kl = inv[l][k]; (dF^T F^-T)_mj for dF = e_k e_l is delta_ml inv[j][k].
            Real d = pk[i][j] * inv[l][k] - pk[i][l] * inv[j][k];
            for (int n = 0; n < 3; ++n) d += s[sym[i][n]][kl] * inv[j][n];
            store(result.d[9 * (3 * i + j) + kl] + row, d);
          }
        }
      }
    }
  });
}

}  // namespace mpm::core
