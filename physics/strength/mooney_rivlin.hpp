// Hyperelastic rubber of Mooney and Rivlin (manual 3.2.1.12). With the invariants I1, I2, I3 of B = F F^T:
//   W = A (I1 - 3) + B (I2 - 3) + C (1/I3^2 - 1) + D (I3 - 1)^2                                      (3.18)
//   C = A/2 + B,   D = (A (5 nu - 2) + B (11 nu - 5))/(2 (1 - 2 nu))                          (3.19, 3.20)
//   sigma = 2/J ((A + B I1) B - B B^2 + I3 W,3 I),   J = det F
// so that at rest G = 2 (A + B), K = 2 G (1 + nu)/(3 (1 - 2 nu)). Limit: below nu = (2 A + 5 B)/(5 A + 11 B),
// 0.40 to 0.45, D is negative and large expansion is not resisted. The law computes its own pressure: no
// EquationOfState. Tested by tests/physics/rubber_test.cpp.
#pragma once

#include <string>
#include <string_view>

#include "physics/strength/hyperelastic.hpp"

namespace mpm::physics {

struct MooneyRivlin {
  static constexpr std::string_view name = "MooneyRivlin";
  static constexpr std::string_view summary = "rubber, nearly incompressible, hyperelastic";
  using has_tangent = MooneyRivlin;
  static constexpr auto state = deformation_gradient_columns;
  static constexpr bool sets_pressure = true;
  static constexpr bool hyperelastic = true;

  double a = 0, b = 0;  ///< Mr_A2, Mr_B2, stress
  double poisson = 0;
  double c = 0, d = 0;         ///< derived, stress
  double shear = 0, bulk = 0;  ///< at rest, derived

  static constexpr auto parameters() {
    using P = MooneyRivlin;
    return std::array<Parameter<P>, 3>{{
        {&P::a, {.name = "Mr_A2", .required = true, .dimension = "stress", .meaning = "A of the energy"}},
        {&P::b,
         {.name = "Mr_B2", .required = true, .dimension = "stress", .meaning = "B of the energy, > -Mr_A2"}},
        {&P::poisson, poisson_row("Poisson's ratio at rest; 0.49 to 0.499 for rubber")},
    }};
  }
  std::string fault() const {
    return a + b > 0 ? "" : "Mr_A2 + Mr_B2, half the shear modulus, must be greater than 0";
  }
  void prepare() {
    c = 0.5 * a + b;
    d = (a * (5 * poisson - 2) + b * (11 * poisson - 5)) / (2 * (1 - 2 * poisson));
    shear = 2 * (a + b);
    bulk = 2 * shear * (1 + poisson) / (3 * (1 - 2 * poisson));
  }

  /// A new particle is stretched equally in all directions to its volume.
  template <class T>
  T place(StrengthPoint<T>& point, const T& relative_volume) const {
    const T stretch = stretch_equally(point, relative_volume), square = stretch * stretch;
    const T i3 = square * square * square;
    return 3 * a * (square - 1.0) + 3 * b * (square * square - 1.0) + c * (1.0 / (i3 * i3) - 1.0) +
           d * (i3 - 1.0) * (i3 - 1.0);
  }

  template <class T>
  void update(StrengthPoint<T>& point) const {
    const core::Mat3<T> f = deformation_gradient(point);
    const core::Sym3<T> left = left_cauchy_green(f);
    const core::Sym3<T> square = squared(left);
    const T j = determinant(f), i1 = trace(left), i3 = j * j, inverse = 1.0 / i3;
    const T i2 = 0.5 * (i1 * i1 - trace(square));
    const T w3 = 2 * d * (i3 - 1.0) - 2 * c * inverse * inverse * inverse;
    const T scale = 2.0 / j, first = a + b * i1;
    point.s = (scale * first) * differences(left) - (scale * b) * differences(square);
    point.pressure = -scale * ((1.0 / 3) * (first * i1 - b * trace(square)) + i3 * w3);
    point.shear_modulus = shear;
    point.bulk_modulus = scale * stiffness(i1, i2, i3, w3) - 4.0 / 3.0 * shear;
  }

 private:
  /// Half J times the largest longitudinal modulus d(sigma_nn)/d(eps_nn). It occurs along a principal
  /// direction, where with b1 the square of its stretch it is A b1 + B (I2 - I3/b1) + I3 W,3 + 2 I3^2 W,33;
  /// b1 is replaced by bounds of the largest and the smallest, which are exact where two stretches are equal.
  template <class T>
  T stiffness(const T& i1, const T& i2, const T& i3, const T& w3) const {
    using core::max;
    const T spread = (2.0 / 3) * sqrt(max(i1 * i1 - 3.0 * i2, 0.0));
    const T largest = (1.0 / 3) * i1 + spread;
    const T smallest = max((1.0 / 3) * i1 - spread, i3 / (largest * largest));
    const T inverse = 1.0 / i3, inverse2 = inverse * inverse;
    const T w33 = 2 * d + 6 * c * inverse2 * inverse2;
    return a * (a > 0 ? largest : smallest) + b * (i2 - i3 / (b > 0 ? largest : smallest)) + i3 * w3 +
           2.0 * i3 * i3 * w33;
  }
};

}  // namespace mpm::physics
