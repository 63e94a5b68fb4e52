// Equation of state of a partly burnt explosive: the burn fraction F of its strength model times the pressure
// of the products (manual 3-9), p = F (a + b E). F is a state variable here: the strength stage has updated
// it for this step. The wave speed is that of the products for any F, and so is the sound speed in the
// artificial viscosity: the time step then allows for a front that arrives within the step. Burning by
// compression adds stiffness: the line includes dF/dmu (a + b E). Tested by tests/physics/burn_test.cpp.
#pragma once

#include "physics/eos/point.hpp"

namespace mpm::physics {

/// A strength model that burns: it stores F in the column burn_fraction and defines -dF/d(V/V0) for burning
/// by compression, one constant for the whole burn; 0: compression burns nothing.
template <class Law>
concept Burns = requires(const Law& law) {
  law.compression_burn;
};

template <class Eos>
struct Burning : Eos {
  static constexpr auto state = [] {
    std::array<core::Column, Eos::state.size() + 1> columns{};
    for (std::size_t i = 0; i < Eos::state.size(); ++i) columns[i] = Eos::state[i];
    columns.back() = core::Column::burn_fraction;
    return columns;
  }();

  double compression_burn = 0;  ///< -dF/d(V/V0)

  Burning(const Eos& eos, double burn) : Eos(eos), compression_burn(burn) {}

  /// Of the products, for the wave speed.
  template <class T>
  LinearisedPressure<T> linearise(EosPoint<T>& point) const {
    LinearisedPressure<T> products = Eos::linearise(point);
    const T burning = compression_burn * (point.relative_volume * point.relative_volume);  // dF/dmu
    const T slope = core::select(point.burn_fraction < 1.0, burning, 0.0);
    products.da += slope * products.a;
    products.db += slope * products.b;
    return products;
  }
  /// The effective pressure.
  template <class T>
  LinearisedPressure<T> acting(const EosPoint<T>& point, const LinearisedPressure<T>& products) const {
    const T f = point.burn_fraction;
    return {f * products.a, f * products.b, products.da, products.db};
  }
};

/// The effective part of the products' line: all of it, except for an explosive.
template <class T, class Eos>
LinearisedPressure<T> acting_line(const Eos& eos, const EosPoint<T>& point,
                                  const LinearisedPressure<T>& line) {
  if constexpr (requires { eos.acting(point, line); }) return eos.acting(point, line);
  return line;
}

}  // namespace mpm::physics
