// The oracle's particles and their material: stress update of thesis 2.4.1, J2 return 2.4.3, Mie-Grueneisen
// 2-130, bulk viscosity 2-69. Part of reference_stepper.hpp.
#pragma once

#include <limits>

#include "tests/support/reference_shape.hpp"

namespace mpm::tests {

struct ReferenceMaterial {
  double density = 0;  ///< rho_0
  double young = 0;
  double poisson = 0;
  double yield = std::numeric_limits<double>::infinity();  ///< initial yield stress
  double plastic_modulus = 0;                              ///< E_p, slope of yield stress over plastic strain
  bool gruneisen = false;                                  ///< otherwise dp = -K tr(d eps), 2-96
  double c0 = 0, s = 0, gamma0 = 0;                        ///< Mie-Grueneisen: U_s = c0 + s U_p
  double bq1 = 0, bq2 = 0;                                 ///< quadratic and linear bulk viscosity

  double shear() const { return young / (2 * (1 + poisson)); }
  double bulk() const { return young / (3 * (1 - 2 * poisson)); }
};

/// E_p of a tangent modulus.
constexpr double plastic_modulus(double young, double tangent) { return young * tangent / (young - tangent); }

struct ReferenceParticle {
  Vector x{}, v{};
  double m = 0;
  double V = 0;            ///< current volume
  Matrix s{};              ///< deviator of the Cauchy stress
  double p = 0;            ///< pressure, positive in compression, without q
  double q = 0;            ///< artificial viscous pressure
  double E = 0;            ///< internal energy per unit of initial volume m/rho_0
  double epef = 0;         ///< effective plastic strain
  double c = 0;            ///< wave speed 2-57; set by the stepper
  double D = 0;            ///< volumetric strain rate of the latest stress update
  Vector half_size{};      ///< of its domain, length, for ugimp and cpgimp; set by the stepper
  DomainCorners corner{};  ///< of its domain, from x, for cpdi and cpdi2; set by the stepper
};

/// One stress update over dt at velocity gradient L: s, p, q, E, epef, V, c and D, thesis 2.4.
/// `length` is the grid's smallest cell edge, l_e of the viscosity; `new_viscosity` what the new q counts in
/// the mean stress that does the work, twice, and 2 less it what the old one does.
void update_stress(const ReferenceMaterial& material, double length, double dt, const Matrix& L,
                   ReferenceParticle& particle, double new_viscosity = 1);

/// Wave speed 2-57 of the particle's present state.
double wave_speed(const ReferenceMaterial& material, const ReferenceParticle& particle);

}  // namespace mpm::tests
