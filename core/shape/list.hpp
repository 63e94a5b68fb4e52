// The families of shape functions, each with its policy.
#pragma once

#include <stdexcept>
#include <tuple>
#include <type_traits>

#include "core/has_shape.hpp"
#include "core/scene/grid.hpp"
#include "core/shape/bspline.hpp"
#include "core/shape/cpdi.hpp"
#include "core/shape/ddmp.hpp"
#include "core/shape/gimp.hpp"
#include "core/shape/linear.hpp"
#include "core/shape/sgmp.hpp"

namespace mpm::core {

using Shapes =
    std::tuple<Linear, Sgmp, Ddmp, UniformGimp, ContiguousGimp, Cpdi, Cpdi2, QuadraticBSpline, CubicBSpline>;

/// Whether this build has the passes of these shape functions; input checking refuses others.
template <class S>
inline constexpr bool is_built = has_shape(S::name);

/// f(std::type_identity<S>()) with the policy of `shape`, whether this build has its passes or not.
template <class F>
auto with_known_shape(ShapeFunction shape, F f) {
  switch (shape) {
    case ShapeFunction::linear: return f(std::type_identity<Linear>());
    case ShapeFunction::sgmp: return f(std::type_identity<Sgmp>());
    case ShapeFunction::ddmp: return f(std::type_identity<Ddmp>());
    case ShapeFunction::uniform_gimp: return f(std::type_identity<UniformGimp>());
    case ShapeFunction::contiguous_particle_gimp: return f(std::type_identity<ContiguousGimp>());
    case ShapeFunction::cpdi: return f(std::type_identity<Cpdi>());
    case ShapeFunction::cpdi2: return f(std::type_identity<Cpdi2>());
    case ShapeFunction::quadratic_bspline: return f(std::type_identity<QuadraticBSpline>());
    case ShapeFunction::cubic_bspline: return f(std::type_identity<CubicBSpline>());
  }
  throw std::logic_error("a shape function without a policy");
}

/// The same, of those that this build has.
template <class F>
auto with_shape(ShapeFunction shape, F f) {
  using Result = decltype(f(std::type_identity<Linear>()));
  return with_known_shape(shape, [&]<class S>(std::type_identity<S> of) -> Result {
    if constexpr (is_built<S>) return f(of);
    throw std::logic_error("a shape function that this build does not have");
  });
}

}  // namespace mpm::core
