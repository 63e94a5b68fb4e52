// Fixed corotated elasticity (Stomakhin et al., Symp. Computer Animation 2012; stress from the energy as in
// Zhao et al. 2018, eq. 1). With F = V R the polar decomposition, B = V V, J = det F and mu = G:
//   W = mu |F - R|^2 + lambda/2 (J - 1)^2
//   sigma = (2 mu / J)(B - V) + lambda (J - 1) I
// Hooke's law at small strain. V follows from Cayley and Hamilton (Hoger and Carlson 1984), with its
// invariants i1, i2 and i3 = J:  (i1 i2 - J) V = i1 J I + (i1^2 - i2) B - B B.
// In the second derivative of W along a wave with amplitude a and normal n, the rotation's part is not
// positive, and that of J is lambda J^2 (a.n)^2; so rho c^2 <= 2 mu b/J + max(lambda, 0) J for the largest
// principal value b of B, which for lambda >= 0 is the speed of the longitudinal wave along its axis. The law
// computes its own pressure: no EquationOfState. Not finite for J <= 0. Limit: as J decreases the resistance
// to compression remains finite. Tested by tests/physics/finite_elasticity_test.cpp.
#pragma once

#include <limits>
#include <string_view>

#include "core/tensor/principal.hpp"
#include "physics/strength/hyperelastic.hpp"

namespace mpm::physics {

struct Corotated : FiniteElasticity {
  static constexpr std::string_view name = "Corotated";
  static constexpr std::string_view summary = "fixed corotated, hyperelastic";
  using has_tangent = Corotated;

  static constexpr auto parameters() { return elastic_parameters<Corotated>(); }

  /// A new particle is stretched equally in all directions to its volume; returns its energy.
  template <class T>
  T place(StrengthPoint<T>& point, const T& relative_volume) const {
    const T extension = stretch_equally(point, relative_volume) - 1.0, expansion = relative_volume - 1.0;
    return (3 * shear) * extension * extension + (0.5 * lame) * expansion * expansion;
  }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    using core::max;
    using core::select;
    const core::Mat3<T> f = deformation_gradient(point);
    const core::Sym3<T> left = left_cauchy_green(f), deviator = differences(left);
    const T volume = determinant(f);
    const T j = select(volume > 0.0, volume, std::numeric_limits<double>::quiet_NaN());

    // Of the principal stretches the largest, and sum and product of the others: (s2 + s3)^2 = s2^2 + s3^2 +
    // 2 s2 s3, without loss of digits where they are equal or small.
    const T largest = principal_values(left).x, first = sqrt(largest), product = j / first;
    const T sum = sqrt(max(trace(left) - largest, 0.0) + 2.0 * product);
    const T i1 = first + sum, i2 = first * sum + product;
    const core::Sym3<T> stretch =
        (1.0 / (i1 * i2 - j)) * ((i1 * i1 - i2) * deviator - differences(squared(left)));  // deviator of V

    const T scale = 2 * shear / j;
    point.s = scale * (deviator - stretch);
    point.pressure = -((1.0 / 3) * scale * (trace(left) - i1) + lame * (j - 1.0));
    set_moduli(point, scale * largest + max(lame, 0.0) * j);
  }
};

}  // namespace mpm::physics
