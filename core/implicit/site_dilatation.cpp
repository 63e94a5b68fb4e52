#include "core/implicit/site_dilatation.hpp"

#include <cmath>

namespace mpm::core {

namespace {

double value_of(const Batch& batch, Column c, int i) {
  return batch.block[i / block_lanes][batch.layout->offset(c) + i % block_lanes];
}

double product(const double (&a)[9], const double (&b)[9]) {
  double sum = 0;
  for (int n = 0; n < 9; ++n) sum += a[n] * b[n];
  return sum;
}

Mat3<double> matrix(const double (&a)[9]) { return {a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]}; }
void take(const Mat3<double>& m, double (&a)[9]) {
  const double each[9] = {m.xx, m.xy, m.xz, m.yx, m.yy, m.yz, m.zx, m.zy, m.zz};
  for (int n = 0; n < 9; ++n) a[n] = each[n];
}

}  // namespace

Deformation::Deformation(const Rows9& displacement_gradient, int i)
    : f(plus_unit(load_rows<double>(displacement_gradient, i), 1.0)),
      w(transposed(inverse(f))),
      j(determinant(f)) {}

bool average_gradient(const Deformation& particle, double dilatation, int i, Rows9& averaged) {
  const bool usable = particle.j > 0 && dilatation > 0;
  const double a = usable ? std::cbrt(dilatation / particle.j) : 1;
  store_rows(plus_unit(a * particle.f, -1.0), averaged, i);
  return usable;
}

double mean_stress(const Batch& batch, int i) {
  return (value_of(batch, Column::s_xx, i) + value_of(batch, Column::s_yy, i) +
          value_of(batch, Column::s_zz, i)) /
             3 -
         value_of(batch, Column::pressure, i);
}

void deviatoric_stress(const Deformation& particle, const Batch& batch, int i, Rows9& p) {
  const auto s = [&](Column c) { return value_of(batch, c, i); };
  const double third = (s(Column::s_xx) + s(Column::s_yy) + s(Column::s_zz)) / 3;
  const Mat3<double> deviator{s(Column::s_xx) - third, s(Column::s_xy),         s(Column::s_xz),
                              s(Column::s_xy),         s(Column::s_yy) - third, s(Column::s_yz),
                              s(Column::s_xz),         s(Column::s_yz),         s(Column::s_zz) - third};
  store_rows(value_of(batch, Column::volume, i) * (deviator * particle.w), p, i);
}

DilatationTangent dilatation_tangent(const Deformation& particle, const SiteDilatation::Site& site,
                                     double volume, int i, const Rows9& averaged, const Rows9& p,
                                     ForceTangent& tangent) {
  const double a = std::cbrt(site.dilatation() / particle.j), grown = volume * particle.j;
  double w[9], fm[9], pm[9];
  take(particle.w, w);
  take(plus_unit(load_rows<double>(averaged, i), 1.0), fm);
  take(load_rows<double>(p, i), pm);
  double right[9] = {}, left[9] = {};  // Dm:Fm and Fm:Dm
  for (int ij = 0; ij < 9; ++ij) {
    for (int kl = 0; kl < 9; ++kl) {
      const double d = tangent.d[9 * ij + kl][i];
      right[ij] += d * fm[kl];
      left[kl] += fm[ij] * d;
    }
  }
  double t[9], g[9], m[9], e[9];
  for (int n = 0; n < 9; ++n) t[n] = (pm[n] + left[n]) / 3;
  const double s = product(t, fm) / 3, pressed = grown * site.mean_stress();
  const double turned = pressed - product(pm, fm) / 3;
  for (int n = 0; n < 9; ++n) {
    g[n] = a * (right[n] + pm[n]) / 3 - s * w[n];
    m[n] = a * t[n] - s * w[n];
    e[n] = grown * w[n];
  }
  for (int ij = 0; ij < 9; ++ij) {
    for (int kl = 0; kl < 9; ++kl) {
      // d W_ij/d F_kl = - W_kj W_il
      const double dw = -w[3 * (kl / 3) + ij % 3] * w[3 * (ij / 3) + kl % 3];
      double& d = tangent.d[9 * ij + kl][i];
      d = a * (a * d - (right[ij] + pm[ij]) * w[kl] / 3) + turned * dw + w[ij] * (pressed * w[kl] - m[kl]);
    }
  }
  return {matrix(e), matrix(g), matrix(m), s};
}

}  // namespace mpm::core
