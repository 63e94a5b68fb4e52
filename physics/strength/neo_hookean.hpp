// Compressible neo-Hookean solid (Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis,
// compressible neo-Hookean material). With B = F F^T, J = det F and mu = G:
//   W = mu/2 (tr B - 3) - mu ln J + lambda/2 (ln J)^2
//   sigma = (lambda ln J / J) I + (mu / J)(B - I)
// Hooke's law at small strain. The acoustic tensor of a wave along n, differentiated by hand, is
//   J Q = (lambda (1 - ln J) + mu) n n + mu (n.B n) I
// so that rho c^2 <= (max(lambda (1 - ln J) + mu, 0) + mu b)/J for the largest principal value b of B, itself
// replaced by a bound, exact where the two smaller stretches are equal. The law computes its own pressure: no
// EquationOfState. Not finite for J <= 0. Tested by tests/physics/finite_elasticity_test.cpp.
#pragma once

#include <string_view>

#include "physics/strength/hyperelastic.hpp"

namespace mpm::physics {

struct NeoHookean : FiniteElasticity {
  static constexpr std::string_view name = "NeoHookean";
  static constexpr std::string_view summary = "compressible neo-Hookean, hyperelastic";
  using has_tangent = NeoHookean;

  static constexpr auto parameters() { return elastic_parameters<NeoHookean>(); }

  /// A new particle is stretched equally in all directions to its volume; returns its energy.
  template <class T>
  T place(StrengthPoint<T>& point, const T& relative_volume) const {
    using core::log;
    const T stretch = stretch_equally(point, relative_volume), log_j = log(relative_volume);
    return shear * (1.5 * (stretch * stretch - 1.0) - log_j) + (0.5 * lame) * log_j * log_j;
  }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    using core::log;
    using core::max;
    const core::Mat3<T> f = deformation_gradient(point);
    const core::Sym3<T> left = left_cauchy_green(f), deviator = differences(left);
    const T j = determinant(f), log_j = log(j), per_j = 1.0 / j, mean = (1.0 / 3) * trace(left);
    point.s = (shear * per_j) * deviator;
    point.pressure = -per_j * (lame * log_j + shear * (mean - 1.0));

    // The largest of three numbers is at most their mean plus two thirds of the root of 3/2 d:d.
    const T largest = mean + sqrt((2.0 / 3) * contract(deviator, deviator));
    const T along = max(lame * (1.0 - log_j) + shear, 0.0);
    set_moduli(point, per_j * (along + shear * largest));
  }
};

}  // namespace mpm::physics
