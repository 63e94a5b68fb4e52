#include "tests/support/reference_material.hpp"

#include <algorithm>
#include <cmath>

namespace mpm::tests {
namespace {

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}

Matrix transposed(const Matrix& a) {
  Matrix b{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) b[i][j] = a[j][i];
  return b;
}

double contraction(const Matrix& a, const Matrix& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) sum += a[i][j] * b[i][j];
  return sum;
}

/// (I - W/2)^-1 (I + W/2) of a skew W: Hughes and Winget's mid-point rule. With A = W/2 of axial vector a,
/// A^3 = -|a|^2 A, hence I + 2/(1 + |a|^2) (A + A A).
Matrix mid_point_rotation(const Matrix& W) {
  Matrix A{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) A[i][j] = 0.5 * W[i][j];
  const Matrix AA = product(A, A);
  const double k = 2 / (1 + 0.5 * contraction(A, A));
  Matrix R{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) R[i][j] = (i == j ? 1.0 : 0.0) + k * (A[i][j] + AA[i][j]);
  return R;
}

/// Mie-Grueneisen 2-130 as p = A + B E, with dA/dmu for the wave speed.
struct Pressure {
  double A, B, dA_dmu;
};

Pressure gruneisen(const ReferenceMaterial& material, double mu) {
  const double k = material.density * material.c0 * material.c0;
  if (mu < 0) return {k * mu, material.gamma0, k};
  const double a = 1 - material.gamma0 / 2;
  const double b = material.s - 1;
  const double n = mu * (1 + a * mu);
  const double d = 1 - b * mu;
  return {k * n / (d * d), material.gamma0, k * ((1 + 2 * a * mu) / (d * d) + 2 * b * n / (d * d * d))};
}

}  // namespace

double wave_speed(const ReferenceMaterial& material, const ReferenceParticle& particle) {
  const double rho = particle.m / particle.V;
  const double G = material.shear();
  if (!material.gruneisen) return std::sqrt((4 * G + 3 * material.bulk()) / (3 * rho));
  const double rho0 = material.density;
  const Pressure eos = gruneisen(material, rho / rho0 - 1);
  const double relative_volume = rho0 / rho;
  const double bulk_part = eos.dA_dmu / rho0 + particle.p * relative_volume * relative_volume / rho0 * eos.B;
  return std::sqrt(std::max(0.0, 4 * G / (3 * rho) + bulk_part));
}

void update_stress(const ReferenceMaterial& material, double length, double dt, const Matrix& L,
                   ReferenceParticle& particle, double new_viscosity) {
  const double G = material.shear();
  const Matrix Lt = transposed(L);
  Matrix de{}, dw{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      de[i][j] = 0.5 * dt * (L[i][j] + Lt[i][j]);
      dw[i][j] = 0.5 * dt * (L[i][j] - Lt[i][j]);
    }
  const double de_kk = de[0][0] + de[1][1] + de[2][2];

  const double V_old = particle.V;
  const double V_new = V_old * (1 + de_kk);  // 2-87
  const double dV = V_new - V_old;
  const double V_mid = 0.5 * (V_old + V_new);
  const double rho = particle.m / V_new;
  const double V0 = particle.m / material.density;

  // Deviator: rotate, try elastic (2-100), return radially (2-112 to 2-115).
  const Matrix s_old = particle.s;
  const Matrix R = mid_point_rotation(dw);
  Matrix s = product(product(R, s_old), transposed(R));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) s[i][j] += 2 * G * (de[i][j] - (i == j ? de_kk / 3 : 0.0));
  const double sigma_eq = std::sqrt(1.5 * contraction(s, s));
  const double sigma_y = material.yield + material.plastic_modulus * particle.epef;
  if (sigma_eq > sigma_y) {
    const double depef = (sigma_eq - sigma_y) / (3 * G + material.plastic_modulus);
    const double ratio = (sigma_y + material.plastic_modulus * depef) / sigma_eq;
    particle.epef += depef;
    for (auto& row : s)
      for (double& component : row) component *= ratio;
  }

  // Viscosity 2-69 with the density at the end and the wave speed at the start of the update.
  const double D = de_kk / dt;
  const double q_old = particle.q;
  const double q =
      D < 0 ? rho * length * (material.bq1 * length * D * D - material.bq2 * particle.c * D) : 0.0;

  // Energy and pressure together, 2-89 to 2-92.
  double work = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) work += 0.5 * (s_old[i][j] + s[i][j]) * de[i][j];
  const double acting_q = 0.5 * ((2 - new_viscosity) * q_old + new_viscosity * q);
  const double e_star = particle.E * V0 - 0.5 * dV * particle.p - dV * acting_q + V_mid * work;
  double p = 0;
  if (material.gruneisen) {
    const Pressure eos = gruneisen(material, rho / material.density - 1);
    p = (eos.A + eos.B * e_star / V0) / (1 + 0.5 * eos.B * dV / V0);
  } else {
    p = particle.p - material.bulk() * de_kk;  // 2-97
  }

  particle.V = V_new;
  particle.s = s;
  particle.p = p;
  particle.q = q;
  particle.E = (e_star - 0.5 * dV * p) / V0;
  particle.D = D;
  particle.c = wave_speed(material, particle);
}

}  // namespace mpm::tests
